/// Bookkeeping of records that could not be used, the same for every log reader.
#pragma once

#include <cstddef>
#include <string>

#include <waymark/core/log_reader.hpp>

namespace waymark {

/// So many corrupt records are described; all are counted.
inline constexpr std::size_t kCorruptExamples = 5;

/// Counts a corrupt record; the first few are kept as "path:line:column: what".
void add_corrupt(LogData& data, const std::string& path, std::size_t line, std::size_t column,
                 const std::string& what);

/// @throws InputError where no sample came out: "gnss.csv: the log is empty", or the first complaint
/// repeated.
/// @param without_fix  records that a receiver marked as without a fix
void require_samples(const LogData& data, const std::string& path, std::size_t without_fix);

/// sigma = factor * figure for an accuracy figure of this meaning; `automatic` must have been resolved.
[[nodiscard]] double sigma_factor(AccuracyMeaning meaning);
/// "95", "1sigma", "drms", "cep50", "auto".
[[nodiscard]] std::string_view to_string(AccuracyMeaning meaning);

}  // namespace waymark
