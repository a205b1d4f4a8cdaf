/// One log of each reader, to be damaged: real ones where the data are at hand, else made by hand.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

struct HostileSample {
  std::string reader;
  std::string text;
  waymark::LogRequest request;
  /// Records that hold one sample each begin lines with this (frames: in bytes, with their headers).
  std::string record;
  /// The first of these characters after the record's beginning, changed to an 'x', makes it corrupt.
  std::string fragile;
  bool lines = true;

  [[nodiscard]] const waymark::LogReader& log_reader() const;
  /// What the reader makes of a text; nothing where it refuses it. @param piece  0: at once
  [[nodiscard]] waymark::LogData read(std::string_view text, std::size_t piece = 0) const;
};

[[nodiscard]] const std::vector<HostileSample>& hostile_samples();

}  // namespace waymark_test
