#include <filesystem>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {

bool is_stdout(const std::string& path) {
  return path == "-" || path == "/dev/stdout";
}

void require_output_place(const std::string& path) {
  if (is_stdout(path)) return;
  std::error_code unknown;  // if it cannot be examined, writing will report the error
  if (std::filesystem::is_directory(path, unknown))
    throw OutputError(path + ": cannot write: it is a folder");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty() && !std::filesystem::exists(folder, unknown)) {
    throw OutputError(path + ": cannot write: its folder does not exist");
  }
}

void require_not_read(const std::string& output, const std::vector<std::string>& read) {
  for (const std::string& input : read) {
    std::error_code absent;  // a missing file is not overwritten
    if (std::filesystem::equivalent(output, input, absent))
      throw UsageError(output +
                       ": is read as an input and would be overwritten; choose another name or folder");
  }
}

std::string json_document(const std::string& kind, const nlohmann::ordered_json& json) {
  nlohmann::ordered_json document = {{"schema", "waymark-" + kind}, {"version", 1}};
  document.update(json);
  return json_text(document);
}

std::string json_text(const nlohmann::ordered_json& json) {
  const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  // JSON lets DEL and U+0080 to U+009F stand as they are, and terminals obey them.
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte == 0x7f) {
      out += "\\u007f";
    } else if (byte == 0xc2 && next < 0xa0) {
      out += fmt::format("\\u{:04x}", next);
      ++i;
    } else {
      out += text[i];
    }
  }
  return out;
}

}  // namespace waymark::program
