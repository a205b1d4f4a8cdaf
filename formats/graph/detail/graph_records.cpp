#include <charconv>
#include <cmath>
#include <limits>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/formats/graph/detail/graph_records.hpp>

namespace waymark::formats {
namespace {

int read_int(LineScanner& line, const Expected& expected) {
  const std::int64_t value = line.integer(expected);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    line.fail(std::string(expected.tag) + ": " + std::string(expected.field) + " does not fit 32 bits");
  }
  return static_cast<int>(value);
}

/// The words that may be left out: [quality] [smoothed x y].
void read_told_and_smoothed(LineScanner& line, Fix& fix) {
  std::string_view word = line.word();
  if (const auto quality = fix_quality_from_string(word); quality && !word.empty()) {
    fix.told.quality = *quality;
    word = line.word();
  }
  if (word == "smoothed") {
    fix.smoothed_m[0] = line.number({"GNSS", "smoothed", 0});
    fix.smoothed_m[1] = line.number({"GNSS", "smoothed", 1});
    word = line.word();
  }
  if (!word.empty())
    line.fail(
        "GNSS: expected the quality of a fix, such as single or fixed, or smoothed and its x and y, got " +
        quote_word(word));
}

}  // namespace

VertexIndex read_vertex_id(LineScanner& line, const Graph& graph, std::string_view tag) {
  const VertexId id{line.integer({tag, "vertex"})};
  const auto found = graph.find(id);
  if (!found) line.fail(std::string(tag) + ": vertex " + to_string(id) + " is not defined");
  return *found;
}

Frame read_frame(LineScanner& line) {
  Frame frame;
  const std::string_view kind = line.word();
  if (kind == "utm") {
    const std::string_view zone = line.word();
    const char* end = zone.data() + zone.size();
    const auto [stop, error] = std::from_chars(zone.data(), end, frame.zone);
    frame.north = end - stop == 1 && *stop == 'N';
    const bool south = end - stop == 1 && *stop == 'S';
    if (error != std::errc() || frame.zone < 1 || frame.zone > 60 || (!frame.north && !south)) {
      line.fail("FRAME: expected a UTM zone such as 32N, got " + quote_word(zone));
    }
  } else if (kind != "local") {
    line.fail("FRAME: expected utm or local, got " + quote_word(kind));
  }
  if (const auto word = line.word(); word != "origin") {
    line.fail("FRAME: expected the word origin, got " + quote_word(word));
  }
  frame.origin_easting_m = line.number({"FRAME", "easting"});
  frame.origin_northing_m = line.number({"FRAME", "northing"});
  line.end("FRAME");
  return frame;
}

Fix read_fix(LineScanner& line) {
  constexpr std::string_view kTag = "GNSS";
  Fix fix;
  fix.vertex = VertexId{line.integer({kTag, "vertex"})};
  fix.stamp.nanoseconds = line.integer({kTag, "nanoseconds"});
  fix.position[0] = line.number({kTag, "x"});
  fix.position[1] = line.number({kTag, "y"});
  fix.covariance(0, 0) = line.number({kTag, "covariance", 0});
  fix.covariance(0, 1) = fix.covariance(1, 0) = line.number({kTag, "covariance", 1});
  fix.covariance(1, 1) = line.number({kTag, "covariance", 2});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  fix.height_m = line.optional_number({kTag, "height"}).value_or(nan);
  fix.heading_rad = line.optional_number({kTag, "heading"});
  fix.heading_sigma_rad = line.optional_number({kTag, "heading_sigma"});
  fix.speed_mps = line.optional_number({kTag, "speed"});
  fix.speed_sigma_mps = line.optional_number({kTag, "speed_sigma"});
  fix.grid_scale = line.number({kTag, "grid_scale"});
  fix.epoch = read_int(line, {kTag, "epoch"});
  fix.source = read_int(line, {kTag, "source"});
  const std::string_view status = line.word();
  const auto known = fix_status_from_string(status);
  if (!known) line.fail("GNSS: expected accepted, rejected or withheld, got " + quote_word(status));
  fix.status = *known;
  fix.reason = std::string(line.word());
  if (fix.reason.empty()) line.fail("GNSS: expected a reason, got the end of the line");
  fix.chord_angle_rad = line.optional_number({kTag, "chord_angle"}).value_or(nan);
  fix.displacement_m = line.optional_number({kTag, "displacement"}).value_or(nan);
  read_told_and_smoothed(line, fix);
  if (!is_positive_semidefinite(fix.covariance)) line.fail("GNSS: the covariance matrix is indefinite");
  return fix;
}

}  // namespace waymark::formats
