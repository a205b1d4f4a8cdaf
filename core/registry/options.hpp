/// Options of registered types: the values that an option may have, and the values that a user
/// gave. CheckedOptions is the only place that checks names and values.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Maps option names to values as the user gave them.
using Options = std::map<std::string, std::string>;

/// The numbers that an option may have.
struct OptionRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;   ///< whether `low` itself is excluded
  bool high_open = false;  ///< whether `high` itself is excluded

  [[nodiscard]] bool contains(double value) const;
  /// Returns "[1e-6, 10]", or "(0, 1]" if `low` is excluded.
  [[nodiscard]] std::string text() const;
};

/// The words that an option may have.
using OptionWords = std::vector<std::string>;

struct OptionInfo;

/// Any text. Empty is the usual default: nothing.
struct OptionText {
  /// The text names a file. In a drive.yaml it is relative to the folder of the logs.
  bool is_file = false;
};

/// A list. list_of() makes it.
struct OptionList {
  std::vector<OptionInfo> each;  ///< one: what every element is; its name is not used
  std::size_t fewest = 0;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

/// A mapping whose keys the user chooses: names of anchors, of satellites. mapping_of() makes it.
struct OptionMapping {
  std::vector<OptionInfo> each;  ///< one: what every value is; its name is not used
};

/// A mapping with these keys. Those that are not given have their defaults.
struct OptionRecord {
  std::vector<OptionInfo> fields;
};

/// Prior knowledge about a noise parameter: a normal distribution of the parameter, or of its
/// natural logarithm.
struct NoisePrior {
  double mean = 0;       ///< of the parameter itself, in the option's unit
  double deviation = 1;  ///< of its logarithm; of the parameter itself if `linear` is set
  bool linear = false;
  /// The mean holds for receivers that claim an accuracy of half a metre or more. Below it shrinks
  /// in proportion: a receiver that claims centimetres has not the errors of a phone.
  bool shrinks_with_claim = false;
  /// It is estimated only where the fixes are of several kinds (SolutionKind); else it has no effect.
  bool between_kinds = false;
  /// It is estimated only where another option, one of words, has this one; else it has no effect.
  std::string where_option = {};
  std::string where_word = {};
};

/// An option of a registered type.
struct OptionInfo {
  std::string name{};
  /// The default, as a user would write it; of lists and mappings in flow style: "[]", "{x: 1}"
  /// (core/registry/flow_text.hpp).
  std::string value{};
  std::string unit{};  ///< empty: none
  std::variant<OptionRange, OptionWords, OptionText, OptionList, OptionMapping, OptionRecord> allowed;
  std::string text{};  ///< meaning of the option; for words it explains each of them
  /// If given, the option is a noise parameter that can be estimated from a drive
  /// (core/covariance/evidence.hpp).
  std::optional<NoisePrior> prior = {};
  bool required = false;  ///< there is no default; it must be given

  /// Returns the text with what is allowed: "sigma of the readings; in [1e-6, 10]". `waymark
  /// info` shows it.
  [[nodiscard]] std::string description() const;
};

/// Returns a list of such elements: `list_of({.unit = "m", .allowed = OptionRange{}}, 3, 3)`.
[[nodiscard]] OptionList list_of(OptionInfo each, std::size_t fewest = 0,
                                 std::size_t most = std::numeric_limits<std::size_t>::max());
/// Returns a mapping from names to such values.
[[nodiscard]] OptionMapping mapping_of(OptionInfo each);

/// The value of an option, checked against its OptionInfo. Each accessor throws std::logic_error for
/// a value of another kind.
class OptionValue {
 public:
  using List = std::vector<OptionValue>;
  using Entries = std::map<std::string, OptionValue, std::less<>>;

  explicit OptionValue(double number) : content_(number) {}
  explicit OptionValue(std::string text) : content_(std::move(text)) {}
  explicit OptionValue(List list) : content_(std::move(list)) {}
  explicit OptionValue(Entries entries) : content_(std::move(entries)) {}

  /// Returns a value with an OptionRange.
  [[nodiscard]] double number() const { return get<double>("a number"); }
  /// Returns a value with OptionWords or OptionText.
  [[nodiscard]] const std::string& text() const { return get<std::string>("a text"); }
  [[nodiscard]] const List& list() const { return get<List>("a list"); }
  /// Returns the values of an OptionMapping or OptionRecord by key.
  [[nodiscard]] const Entries& entries() const { return get<Entries>("a mapping"); }
  /// Returns one of the entries. @throws std::logic_error if there is none
  [[nodiscard]] const OptionValue& at(std::string_view key) const;
  /// Returns a list of numbers.
  [[nodiscard]] std::vector<double> numbers() const;

 private:
  template <typename T>
  const T& get(const char* kind) const {
    if (const T* value = std::get_if<T>(&content_)) return *value;
    wrong_kind(kind);
  }
  [[noreturn]] static void wrong_kind(const char* kind);

  std::variant<double, std::string, List, Entries> content_;
};

/// An option that does not exist, or a value that it cannot have.
class OptionError : public UsageError {
 public:
  OptionError(const std::string& message, std::string owner, std::string option, std::string value);
  ~OptionError() override;  // key function, as in error.hpp

  /// Returns the registered name of the type that has (or lacks) the option.
  [[nodiscard]] const std::string& owner() const { return owner_; }
  [[nodiscard]] const std::string& option() const { return option_; }
  /// Returns the value as it was given.
  [[nodiscard]] const std::string& value() const { return value_; }

 private:
  std::string owner_;
  std::string option_;
  std::string value_;
};

/// The options of one type: the given values, and the defaults of all others. The registry makes it
/// (TypeRegistry::make_...), so a type never sees a value that its OptionInfo forbids.
class CheckedOptions {
 public:
  /// @throws OptionError "owner: option 'name' must lie in [0, 1], got 2". For an unknown name it
  /// proposes the nearest one, or lists all.
  CheckedOptions(std::string_view owner, const Options& given, std::span<const OptionInfo> known);

  [[nodiscard]] const std::string& owner() const { return owner_; }
  /// Returns the value of an option with a range. @throws std::logic_error if no such
  /// option is declared
  [[nodiscard]] double number(std::string_view name) const;
  /// Returns the value of an option with words or any text. @throws std::logic_error if no such
  /// option is declared
  [[nodiscard]] const std::string& word(std::string_view name) const;
  /// Returns the value of any option, such as a list. @throws std::logic_error if no such option is
  /// declared
  [[nodiscard]] const OptionValue& value(std::string_view name) const;

 private:
  std::string owner_;
  OptionValue::Entries values_;
};

/// Returns the options with the files among them (OptionText::is_file) below a folder, unless they are
/// absolute. Names and values are not checked.
[[nodiscard]] Options with_files_below(const std::string& folder, Options options,
                                       std::span<const OptionInfo> known);

/// Returns a number as the value of an option: the shortest text that reads back exactly.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] bool has_option(std::span<const OptionInfo> known, std::string_view name);

}  // namespace waymark
