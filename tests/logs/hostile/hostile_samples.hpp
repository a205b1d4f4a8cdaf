/// One log of each reader, to be damaged: a real one if the data are available, or else one
/// made by hand.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark_test {

struct HostileSample {
  std::string reader;
  std::string text;
  waymark::LogRequest request;
  /// The first characters of lines that hold one sample each (for frames: the first bytes, with
  /// their headers).
  std::string record;
  /// The first of these characters after the beginning of a record. The record is corrupt if it
  /// becomes an 'x'.
  std::string fragile;
  bool lines = true;

  [[nodiscard]] const waymark::LogReader& log_reader() const;
  /// Reads a text. The result is empty if the reader refuses it. @param piece 0: at once
  [[nodiscard]] waymark::LogData read(std::string_view text, std::size_t piece = 0) const;
};

[[nodiscard]] const std::vector<HostileSample>& hostile_samples();

}  // namespace waymark_test
