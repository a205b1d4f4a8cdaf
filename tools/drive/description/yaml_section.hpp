/// A mapping of a YAML file in which every key must be known. Values are read with their place in
/// the file, for messages.
#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

namespace waymark::drive {

/// The bounds of a number, and their description for the message.
struct NumberRule {
  double smallest = -std::numeric_limits<double>::infinity();
  double largest = std::numeric_limits<double>::infinity();
  std::string_view words;  ///< "a number above 0"
};

inline constexpr NumberRule kAnyNumber{.words = "a number"};
inline constexpr NumberRule kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
                                      "a number above 0"};
inline constexpr NumberRule kNotNegative{0, std::numeric_limits<double>::max(), "a number not below 0"};
/// Stamps count nanoseconds in 64 bits, and a measurement has an information of 1 / sigma^2.
inline constexpr NumberRule kSeconds{-1e9, 1e9, "seconds from -1e9 to 1e9"};
inline constexpr NumberRule kSigma{1e-6, 1e6, "a standard deviation from 1e-6 to 1e6"};

class YamlSection {
 public:
  /// @param name name of the section, for messages; empty at the top
  /// @throws InputError if the node is no mapping, or a key appears twice or is not among `keys`
  YamlSection(YAML::Node node, std::string name, std::string file, std::span<const std::string_view> keys);
  YamlSection(YAML::Node node, std::string name, std::string file,
              std::initializer_list<std::string_view> keys)
      : YamlSection(std::move(node), std::move(name), std::move(file), std::span(keys.begin(), keys.size())) {
  }
  /// A section whose keys are free.
  YamlSection(YAML::Node node, std::string name, std::string file);

  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] YAML::Node node(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::string place() const { return place_of(node_); }
  [[nodiscard]] std::string place(std::string_view key) const { return place_of(node(key)); }

  /// Each sets `value` if the key exists, and otherwise leaves it unchanged.
  void read(std::string_view key, std::string& value) const;
  void read(std::string_view key, bool& value) const;
  void read(std::string_view key, double& value, const NumberRule& rule) const;
  void read(std::string_view key, int& value, const NumberRule& rule) const;
  void read(std::string_view key, std::optional<double>& value, const NumberRule& rule) const;
  /// Reads one text, or a list of texts. Adds them to the values.
  void read(std::string_view key, std::vector<std::string>& values) const;
  /// Reads two numbers: [x, y].
  void read(std::string_view key, Eigen::Vector2d& value) const;
  /// Reads the value of an option of a registered type: a word, or a list or mapping as text in flow style
  /// (core/registry/flow_text.hpp).
  void read_option(std::string_view key, std::string& value) const;
  /// Reads one of some words. @return its index; empty if the key does not exist
  [[nodiscard]] std::optional<std::size_t> read_word(std::string_view key,
                                                     std::span<const std::string_view> words) const;

  /// Returns a section below this one and checks its keys. Empty if it does not exist.
  [[nodiscard]] std::optional<YamlSection> section(std::string_view key,
                                                   std::initializer_list<std::string_view> keys) const;
  [[nodiscard]] std::optional<YamlSection> free_section(std::string_view key) const;

  /// @throws InputError with the place of the key: "drive.yaml:3:9: gnss.period: expected
  /// ..., got '...'"
  [[noreturn]] void fail_value(std::string_view key, std::string_view expected) const;
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

 private:
  [[nodiscard]] std::string place_of(const YAML::Node& node) const;
  [[nodiscard]] std::string full_name(std::string_view key) const;

  YAML::Node node_;
  std::string name_;
  std::string file_;
};

}  // namespace waymark::drive
