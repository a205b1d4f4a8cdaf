#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/text/json_place.hpp>

namespace waymark::text {

using Json = nlohmann::ordered_json;

namespace {

[[noreturn]] void fail_at(std::string_view text, std::size_t byte, const std::string& name,
                          const std::string& why) {
  const std::string_view before = text.substr(0, byte);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t begin = before.find_last_of('\n') + 1;  // npos + 1 is 0
  throw InputError(fmt::format("{}:{}:{}: {}", name, line, before.size() - begin + 1, why));
}

/// Most functions that walk over a document call themselves for each level.
void check_depth(std::string_view text, const std::string& name) {
  constexpr int kDeepest = 100;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest)
      fail_at(text, i, name, fmt::format("lists and objects are nested more than {} deep", kDeepest));
  }
}

/// Returns a message of the library without its number.
std::string reason_of(const Json::exception& error) {
  constexpr std::size_t kLongest = 200;  // it repeats the text that it has read
  std::string why = error.what();
  const std::size_t prefix =
      why.find(dynamic_cast<const Json::parse_error*>(&error) != nullptr ? ": " : "] ");
  if (prefix != std::string::npos) why.erase(0, prefix + 2);
  if (why.size() > kLongest) why = why.substr(0, kLongest) + "...";
  return why;
}

}  // namespace

Json parse_json(std::string_view text, const std::string& name) {
  check_depth(text, name);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    fail_at(text, error.byte > 0 ? error.byte - 1 : 0, name, "is no JSON: " + reason_of(error));
  } catch (const Json::exception& error) {  // a number beyond a double
    throw InputError(fmt::format("{}: is no JSON: {}", name, reason_of(error)));
  }
}

void JsonPlace::expected(const std::string& what) const {
  std::string found = value_->dump(-1, ' ', false, Json::error_handler_t::replace);
  if (found.size() > 40) found = found.substr(0, 37) + "...";
  throw InputError(
      fmt::format("{}: {}expected {}, got {}", file_, path_.empty() ? "" : path_ + ": ", what, found));
}

JsonPlace JsonPlace::at(const std::string& key) const {
  if (!value_->is_object()) expected("an object with '" + key + "'");
  const auto found = value_->find(key);
  if (found == value_->end())
    throw InputError(fmt::format("{}: {}'{}' is missing", file_, path_.empty() ? "" : path_ + ": ", key));
  return {*found, file_, path_.empty() ? key : path_ + "." + key};
}

bool JsonPlace::has(const std::string& key) const {
  if (!value_->is_object()) expected("an object");
  const auto found = value_->find(key);
  return found != value_->end() && !found->is_null();
}

std::vector<std::string> JsonPlace::keys() const {
  if (!value_->is_object()) expected("an object");
  std::vector<std::string> names;
  for (const auto& entry : value_->items()) names.push_back(entry.key());
  return names;
}

std::vector<JsonPlace> JsonPlace::items() const {
  if (!value_->is_array()) expected("a list");
  std::vector<JsonPlace> places;
  for (std::size_t i = 0; i < value_->size(); ++i)
    places.push_back({(*value_)[i], file_, fmt::format("{}[{}]", path_, i)});
  return places;
}

std::string JsonPlace::text() const {
  if (!value_->is_string()) expected("a text");
  return value_->get<std::string>();
}

bool JsonPlace::flag() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

double JsonPlace::number() const {
  if (value_->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value_->is_number()) expected("a number or null");
  return value_->get<double>();
}

std::size_t JsonPlace::count() const {
  if (!value_->is_number_unsigned()) expected("a whole number, at least 0");
  return value_->get<std::size_t>();
}

}  // namespace waymark::text
