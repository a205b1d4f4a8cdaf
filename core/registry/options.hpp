/// Options of registered types: the values that an option may have, and the values that a user
/// gave. CheckedOptions is the only place that checks names and values.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

/// Prior knowledge about a noise parameter: a normal distribution of the parameter, or of its
/// natural logarithm.
struct NoisePrior {
  double mean = 0;       ///< of the parameter itself, in the option's unit
  double deviation = 1;  ///< of its logarithm; of the parameter itself if `linear` is set
  bool linear = false;
  /// The mean holds for receivers that claim an accuracy of half a metre or more. Below it shrinks
  /// in proportion: a receiver that claims centimetres has not the errors of a phone.
  bool shrinks_with_claim = false;
};

/// An option of a registered type.
struct OptionInfo {
  std::string name;
  std::string value;  ///< the default, as a user would write it
  std::string unit;   ///< empty: none
  std::variant<OptionRange, OptionWords> allowed;
  std::string text;  ///< meaning of the option; for words it explains each of them
  /// If given, the option is a noise parameter that can be estimated from a drive
  /// (core/covariance/evidence.hpp).
  std::optional<NoisePrior> prior = {};

  /// Returns the text with the range: "sigma of the readings; in [1e-6, 10]". `waymark
  /// info` shows it.
  [[nodiscard]] std::string description() const;
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
  /// Returns the value of an option with words. @throws std::logic_error if no such
  /// option is declared
  [[nodiscard]] const std::string& word(std::string_view name) const;

 private:
  void add(const OptionInfo& option, const std::string& value);

  std::string owner_;
  std::map<std::string, double, std::less<>> numbers_;
  std::map<std::string, std::string, std::less<>> words_;
};

/// Returns a number as the value of an option: the shortest text that reads back exactly.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] bool has_option(std::span<const OptionInfo> known, std::string_view name);

}  // namespace waymark
