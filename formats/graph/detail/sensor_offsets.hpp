/// The poses of sensors in the body frame. g2o files keep them in separate lines (`PARAMS_SE2OFFSET
/// id x y heading`), and edges name them by id. Here they are fields of the edges. So a reader
/// turns ids into numbers, and a writer makes one line for each set of numbers.
#pragma once

#include <array>
#include <map>
#include <string_view>
#include <vector>

#include <waymark/core/graph/edge.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>

namespace waymark::formats {

inline constexpr std::string_view kOffsetTag = "PARAMS_SE2OFFSET";

/// Tells whether edges of this type have fields that g2o keeps in parameter lines. These are all
/// fields after the first.
[[nodiscard]] bool has_offsets(std::string_view tag);

class SensorOffsets {
 public:
  using Offset = std::array<double, 3>;  ///< x, y, heading in the body frame

  // ---- Reading

  /// Reads the rest of a parameter line. @throws InputError, also if the id is defined already
  void read(LineScanner& line);
  /// Reads the ids and the measurement of an edge with offsets, and appends them to `values` as the
  /// fields of the edge.
  /// @throws InputError, also if an id is not defined
  void read_fields(LineScanner& line, const EdgeType& type, std::vector<double>& values) const;

  // ---- Writing

  /// Gives every new offset in the fields of an edge the next id.
  void collect(std::string_view tag, const std::vector<double>& fields);
  /// Writes all parameter lines, in the order of their ids.
  void write(TextBuilder& out) const;
  /// Writes the ids and then the measurement of an edge that was given to collect().
  void write_fields(std::string_view tag, const std::vector<double>& fields, TextBuilder& out) const;

 private:
  std::map<std::int64_t, Offset> by_id_;
  std::map<Offset, std::int64_t> ids_;  // ids of the offsets that are written
};

}  // namespace waymark::formats
