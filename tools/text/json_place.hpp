/// Reads JSON files by key. Errors name the place: "metrics.json: evaluations[0].truth.gnss: ...".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace waymark::text {

/// @throws InputError "metrics.json:3:7: is no JSON: ...", also for a number that no double holds and
/// for lists and objects nested more than 100 deep
/// @param name name of the file, for errors
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

/// A value of a document and its place. The document must outlive it. Every function throws
/// InputError if the value is not of the requested kind.
class JsonPlace {
 public:
  JsonPlace(const nlohmann::ordered_json& document, std::string file)
      : value_(&document), file_(std::move(file)) {}

  [[nodiscard]] JsonPlace at(const std::string& key) const;
  /// Tells whether the object has the key with a value other than null.
  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> keys() const;  ///< of an object
  [[nodiscard]] std::vector<JsonPlace> items() const;   ///< of a list

  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool flag() const;
  [[nodiscard]] double number() const;      ///< NaN for null
  [[nodiscard]] std::size_t count() const;  ///< a whole number, at least 0

  [[nodiscard]] double number(const std::string& key) const { return at(key).number(); }
  [[nodiscard]] std::size_t count(const std::string& key) const { return at(key).count(); }
  [[nodiscard]] std::string text(const std::string& key) const { return at(key).text(); }

  /// @throws InputError "FILE: PLACE: expected WHAT, got ..."
  [[noreturn]] void expected(const std::string& what) const;

 private:
  JsonPlace(const nlohmann::ordered_json& value, std::string file, std::string path)
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  const nlohmann::ordered_json* value_;
  std::string file_;
  std::string path_;
};

}  // namespace waymark::text
