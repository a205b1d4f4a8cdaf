/// What must hold of whatever a log reader makes of whatever bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_fuzz {

/// What came of a log: samples, or the complaint of an InputError.
struct Outcome {
  waymark::LogData data;
  std::optional<std::string> refused;
};

/// Reads a log in pieces. Any exception but an InputError ends the program. @param piece  0: at once
[[nodiscard]] Outcome read_log(const waymark::LogReader& reader, std::string_view log,
                               const waymark::LogRequest& request, std::size_t piece);

/// Ends the program where samples are not finite or out of range, a covariance is not positive definite,
/// counts contradict each other, or a message is too long for a terminal.
void check_data(const waymark::LogData& data, const waymark::LogRequest& request);

/// Ends the program where two readings of one log differ.
void check_same(const Outcome& a, const Outcome& b);

/// Ends the program where a reader's certainty is no number of 0 .. 1, or it is certain without evidence.
void check_recognition(std::string_view head);

/// Prints what was broken and ends the program, so that the fuzzer keeps its input.
[[noreturn]] void broken(const std::string& what);

}  // namespace waymark_fuzz
