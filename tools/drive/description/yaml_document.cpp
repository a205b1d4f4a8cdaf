#include <waymark/tools/drive/description/yaml_document.hpp>

#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <waymark/core/base/error.hpp>

namespace waymark::drive {
namespace {

std::string place_of(const std::string& path, const YAML::Mark& mark) {
  return fmt::format("{}:{}:{}: ", path, mark.line + 1, mark.column + 1);
}

std::string_view line_of(std::string_view text, int line) {
  for (; line > 0 && text.find('\n') != std::string_view::npos; --line)
    text.remove_prefix(text.find('\n') + 1);
  return text.substr(0, text.find('\n'));
}

/// Refuses a second document. The loaders of yaml-cpp cannot be asked for it: they do not move past a token that begins
/// nothing (a comma, for example), and return one empty document after another until the memory is full.
class OneDocument : public YAML::EventHandler {
 public:
  OneDocument(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    throw InputError(place_of(path_, mark) +
                     (line_of(text_, mark.line).starts_with("---")
                          ? "a second YAML document begins; a drive is one, without '---' inside"
                          : "no valid YAML: the document has ended before this"));
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}

 private:
  const std::string& text_;
  const std::string& path_;
  int documents_ = 0;
};

/// An anchor may stand within what it names, or ten times within each of ten levels.
/// @throws InputError for a value without end, or of more values than a drive can need
void check_extent(const YAML::Node& node, const std::string& path, int depth, std::size_t& count) {
  constexpr int kDeepest = 50;
  constexpr std::size_t kMost = 100'000;
  if (depth > kDeepest || ++count > kMost)
    throw InputError(place_of(path, node.Mark()) +
                     (depth > kDeepest ? "the values are nested more than 50 deep"
                                       : "the file has more than 100,000 values with its aliases"));
  for (const auto& entry : node) {
    if (node.IsMap()) {
      check_extent(entry.first, path, depth + 1, count);
      check_extent(entry.second, path, depth + 1, count);
    } else {
      check_extent(entry, path, depth + 1, count);
    }
  }
}

}  // namespace

YAML::Node load_yaml_document(const std::string& text, const std::string& path) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    OneDocument one(text, path);
    while (parser.HandleNextDocument(one)) {
    }
    YAML::Node document = YAML::Load(text);
    std::size_t count = 0;
    check_extent(document, path, 0, count);
    return document;
  } catch (const YAML::Exception& error) {
    throw InputError(place_of(path, error.mark) + "no valid YAML: " + error.msg);
  }
}

}  // namespace waymark::drive
