/// Invariants of the log readers that hold for any bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_fuzz {

/// The result of reading a log: samples, or the message of an InputError.
struct Outcome {
  waymark::LogData data;
  std::optional<std::string> refused;
};

/// Reads a log in pieces. Any exception but an InputError ends the program. @param piece 0: at once
[[nodiscard]] Outcome read_log(const waymark::LogReader& reader, std::string_view log,
                               const waymark::LogRequest& request, std::size_t piece);

/// Ends the program if samples are not finite or out of range, a covariance is not positive
/// definite, counts contradict each other, or a message is too long for a terminal.
void check_data(const waymark::LogData& data, const waymark::LogRequest& request);

/// Ends the program if two readings of one log differ.
void check_same(const Outcome& a, const Outcome& b);

/// Ends the program if the confidence of a reader is outside 0 .. 1, or has no evidence.
void check_recognition(std::string_view head);

/// Prints the broken invariant and ends the program, so that the fuzzer keeps its input.
[[noreturn]] void broken(const std::string& what);

}  // namespace waymark_fuzz
