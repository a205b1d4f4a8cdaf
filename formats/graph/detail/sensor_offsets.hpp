/// The poses of sensors in the body, which g2o files keep in lines of their own (`PARAMS_SE2OFFSET id x y
/// heading`) that edges name by id. Here they are fields of the edges; so a reader resolves ids into numbers,
/// and a writer makes a line of each set of numbers.
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

/// Whether edges of this type have fields that g2o keeps in parameter lines: those behind the first field.
[[nodiscard]] bool has_offsets(std::string_view tag);

class SensorOffsets {
 public:
  using Offset = std::array<double, 3>;  ///< x, y, heading in the body frame

  // ---- Reading

  /// The rest of a parameter line. @throws InputError, also for an id that is defined already
  void read(LineScanner& line);
  /// The ids and the measurement of an edge with offsets as its fields, appended to `values`.
  /// @throws InputError, also for an id that is not defined
  void read_fields(LineScanner& line, const EdgeType& type, std::vector<double>& values) const;

  // ---- Writing

  /// Gives every new offset among an edge's fields the next id.
  void collect(std::string_view tag, const std::vector<double>& fields);
  /// All parameter lines, in the order of their ids.
  void write(TextBuilder& out) const;
  /// The ids, then the measurement, of an edge that collect() has seen.
  void write_fields(std::string_view tag, const std::vector<double>& fields, TextBuilder& out) const;

 private:
  std::map<std::int64_t, Offset> by_id_;
  std::map<Offset, std::int64_t> ids_;  // of those written
};

}  // namespace waymark::formats
