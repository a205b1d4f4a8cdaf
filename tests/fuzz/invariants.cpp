#include "invariants.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <Eigen/LU>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>

namespace waymark_fuzz {
namespace {

using waymark::GeodeticFix;
using waymark::LogData;

/// Longest message: a place, the expectation, and a quoted word of the log.
constexpr std::size_t kLongestMessage = 4000;

void hold(bool condition, const char* what) {
  if (!condition) broken(what);
}

void check_position(double latitude, double longitude, double height) {
  hold(latitude >= -90 && latitude <= 90, "latitude");
  hold(longitude >= -180 && longitude <= 360, "longitude");
  hold(!std::isinf(height), "height");
}

void check_optional(const std::optional<double>& value, bool positive, const char* what) {
  if (!value) return;
  hold(std::isfinite(*value), what);
  hold(!positive || *value > 0, what);
}

void check_fix(const GeodeticFix& fix) {
  check_position(fix.latitude_deg, fix.longitude_deg, fix.height_m);
  const Eigen::Matrix2d& c = fix.covariance_en;
  hold(c.allFinite(), "covariance: finite");
  hold(c(0, 1) == c(1, 0), "covariance: symmetric");
  hold(c(0, 0) > 0 && c(1, 1) > 0 && c.determinant() > 0, "covariance: positive definite");
  check_optional(fix.course_rad, false, "course");
  check_optional(fix.course_sigma_rad, true, "course sigma");
  check_optional(fix.speed_mps, false, "speed");
  check_optional(fix.speed_sigma_mps, true, "speed sigma");
  hold(fix.line > 0, "line");
}

void check_text(const std::string& text) {
  if (text.size() > kLongestMessage) broken("a message of " + std::to_string(text.size()) + " bytes");
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) broken("a control character in: " + text);
  }
}

}  // namespace

void broken(const std::string& what) {
  std::fprintf(stderr, "BROKEN: %s\n", what.c_str());
  std::abort();
}

Outcome read_log(const waymark::LogReader& reader, std::string_view log, const waymark::LogRequest& request,
                 std::size_t piece) {
  Outcome outcome;
  try {
    const auto decoder = reader.open("fuzz.log", request);
    if (piece == 0) piece = log.size() + 1;
    for (; !log.empty(); log.remove_prefix(std::min(piece, log.size()))) decoder->take(log.substr(0, piece));
    decoder->finish();
    outcome.data = std::move(decoder->data());
  } catch (const waymark::InputError& error) {
    outcome.refused = error.what();
  }
  return outcome;
}

void check_data(const LogData& data, const waymark::LogRequest& request) {
  for (const waymark::OdometrySample& sample : data.odometry)
    hold(std::isfinite(sample.speed_mps) && std::isfinite(sample.yaw_rate_radps), "odometry");
  for (const GeodeticFix& fix : data.fixes) check_fix(fix);
  for (const waymark::GeodeticTruth& truth : data.truth) {
    check_position(truth.latitude_deg, truth.longitude_deg, truth.height_m);
    check_optional(truth.heading_rad, false, "heading");
  }
  hold(data.readings.values.size() == data.readings.stamps.size() * data.readings.columns, "readings: shape");
  for (const double value : data.readings.values) hold(!std::isinf(value), "readings: finite or none");
  hold(request.readings.empty() || data.readings.columns == request.readings.size(), "readings: columns");

  // One more than the first few may describe an error of the whole log.
  hold(data.corrupt_examples.empty() == (data.corrupt == 0) &&
           data.corrupt_examples.size() <= std::min(data.corrupt, waymark::kCorruptExamples + 1),
       "corrupt examples");
  hold(data.corrupt + data.without_fix <= data.records, "more corrupt records than records");
  for (const std::string& text : data.corrupt_examples) check_text(text);
  for (const std::string& text : data.notes) check_text(text);
  for (const auto& [kind, count] : data.kinds) {
    check_text(kind);
    hold(count > 0, "kinds");
  }
  try {
    waymark::require_samples(data, "fuzz.log");
  } catch (const waymark::InputError& error) {
    check_text(error.what());
  }
}

void check_same(const Outcome& a, const Outcome& b) {
  hold(a.refused == b.refused, "pieces: refused");
  if (a.refused) return check_text(*a.refused);
  const LogData& x = a.data;
  const LogData& y = b.data;
  hold(x.records == y.records, "pieces: records");
  hold(x.without_fix == y.without_fix, "pieces: without_fix");
  hold(x.corrupt == y.corrupt, "pieces: corrupt");
  hold(x.corrupt_examples == y.corrupt_examples, "pieces: corrupt_examples");
  hold(x.kinds == y.kinds, "pieces: kinds");
  hold(x.notes == y.notes, "pieces: notes");
  hold(x.odometry.size() == y.odometry.size(), "pieces: odometry");
  hold(x.fixes.size() == y.fixes.size(), "pieces: fixes");
  hold(x.truth.size() == y.truth.size(), "pieces: truth");
  hold(x.clocks.size() == y.clocks.size(), "pieces: clocks");
  hold(x.readings.stamps == y.readings.stamps, "pieces: readings");
  for (std::size_t i = 0; i < x.fixes.size(); ++i) {
    hold(x.fixes[i].stamp == y.fixes[i].stamp, "pieces: stamps");
    hold(x.fixes[i].latitude_deg == y.fixes[i].latitude_deg, "pieces: latitude");
    hold(x.fixes[i].covariance_en == y.fixes[i].covariance_en, "pieces: covariance");
    hold(x.fixes[i].line == y.fixes[i].line, "pieces: line");
  }
}

void check_recognition(std::string_view head) {
  for (const waymark::LogReaderType& entry : waymark::formats::builtin_log_readers()) {
    const waymark::Recognition recognition = entry.reader->recognise(head);
    hold(recognition.certainty >= 0 && recognition.certainty <= 1, "certainty");
    hold(recognition.certainty == 0 || !recognition.evidence.empty(), "evidence");
    check_text(recognition.evidence);
  }
}

}  // namespace waymark_fuzz
