/// Reading the options of registered types: every name is known, every value is checked.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <waymark/core/optimize/algorithm.hpp>

namespace waymark {

/// A number as the value of an option: the shortest text that reads back exactly.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] bool has_option(std::span<const OptionInfo> known, std::string_view name);

/// @throws UsageError naming the unknown option, its owner and the options that exist.
void check_option_names(std::string_view owner, const Options& given, std::span<const OptionInfo> known);

/// The value given, else the default. @throws UsageError "owner: option 'name' must be a number, got '...'"
[[nodiscard]] double number_option(std::string_view owner, const Options& given,
                                   std::span<const OptionInfo> known, const std::string& name);
/// The same, which must lie in [low, high].
[[nodiscard]] double number_option(std::string_view owner, const Options& given,
                                   std::span<const OptionInfo> known, const std::string& name, double low,
                                   double high);
/// One of the allowed words.
[[nodiscard]] std::string word_option(std::string_view owner, const Options& given,
                                      std::span<const OptionInfo> known, const std::string& name,
                                      std::span<const std::string_view> allowed);

}  // namespace waymark
