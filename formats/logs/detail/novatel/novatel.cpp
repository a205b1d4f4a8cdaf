#include <waymark/formats/logs/detail/novatel/novatel.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/formats/logs/detail/common/kind_tally.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/novatel/novatel_layout.hpp>
#include <waymark/formats/logs/detail/novatel/novatel_message.hpp>

namespace waymark::formats {
namespace {

constexpr const char* kNovatelFormat = "a NovAtel log";
constexpr double kFar = 1e6;  // m: beyond any height

/// A velocity without sigma that waits for the position of the same time.
struct Velocity {
  Stamp at;
  double speed_mps = 0;
  double course_rad = 0;
};

/// A position that waits for the velocity of the same time.
struct HeldFix {
  GeodeticFix fix;
  StatedAccuracy accuracy;
  std::size_t column = 0;  ///< of its accuracy
  std::string_view kind;   ///< of its message
};

class NovatelDecoder final : public LineDecoder {
 public:
  NovatelDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request), positions_(path, request, "sigmas") {}

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;

  void take_message(std::size_t line_number);
  void take_velocity(Stamp at);
  void take_position(Stamp at, std::size_t line_number);
  void read_details(GeodeticFix& fix);
  [[nodiscard]] StatedAccuracy accuracy();
  void set_inertial_velocity(GeodeticFix& fix);
  void hold(const GeodeticFix& fix, const StatedAccuracy& accuracy);
  void release();
  [[nodiscard]] std::optional<Stamp> stamp();
  [[nodiscard]] double number(std::size_t field, const char* name, double smallest, double largest);
  void complain(std::size_t field, const std::string& what);
  [[nodiscard]] bool is_sound() const { return what_.empty(); }

  PositionStream positions_;
  NovatelMessage message_;
  const NovatelLayout* layout_ = nullptr;  ///< of the current message
  int best_rank_ = 1;
  std::optional<HeldFix> held_;
  std::optional<Velocity> velocity_;
  KindTally kinds_;
  KindTally types_;
  std::string datum_;  ///< the first datum that is not WGS84
  double largest_latency_s_ = 0;
  std::size_t without_time_ = 0;
  std::size_t abbreviated_ = 0;
  std::size_t other_lines_ = 0;
  std::size_t column_ = 0;  ///< of the first error of the current message
  std::string what_;        ///< empty: none
};

void NovatelDecoder::take_line(std::string_view line, std::size_t line_number) {
  const std::string_view name = novatel_name(line);
  if (name.empty()) {
    if (line.starts_with('<') && line.size() > 1 && line[1] >= 'A' && line[1] <= 'Z') {
      ++abbreviated_;
    } else if (!line.empty()) {
      ++other_lines_;
    }
    return;
  }
  kinds_.add(name);
  layout_ = novatel_layout(name);
  if (layout_ == nullptr) return;
  const bool is_position = layout_->gnss_rank > 0;
  const int rank = positions_.wants_truth() ? layout_->truth_rank : layout_->gnss_rank;
  if (is_position && rank < best_rank_) return;
  if (!is_position && positions_.wants_truth()) return;
  what_ = read_novatel(line, message_);
  column_ = 1;
  if (is_sound()) {
    if (is_position) best_rank_ = rank;
    take_message(line_number);
  }
  data_.records += is_position || !is_sound() ? 1 : 0;
  if (!is_sound()) corrupt(line_number, column_, fmt::format("{}: {}", name, what_));
}

void NovatelDecoder::take_message(std::size_t line_number) {
  const RecordFields& body = message_.body;
  if (body.count() < layout_->fields)
    return complain(body.count(), fmt::format("expected {} fields, got {}", layout_->fields, body.count()));
  const bool is_position = layout_->gnss_rank > 0;
  const bool time_known = message_.time_status != "UNKNOWN" && message_.time_status != "APPROXIMATE";
  if (!time_known || !novatel_has_solution(body[layout_->status]) || body[layout_->type] == "NONE") {
    data_.without_fix += is_position ? 1 : 0;
    without_time_ += is_position && !time_known ? 1 : 0;
    return;
  }
  const std::optional<Stamp> at = stamp();
  if (!at) return;
  if (is_position) {
    take_position(*at, line_number);
  } else {
    take_velocity(*at);
  }
}

std::optional<Stamp> NovatelDecoder::stamp() {
  // INSPVA has its own time, which is finer than the time in its header.
  const bool in_body = layout_->status == 11;
  const std::string_view week = in_body ? message_.body[0] : message_.week;
  const std::string_view seconds = in_body ? message_.body[1] : message_.seconds;
  const std::optional<Stamp> given = stamp_from_gps_week(week, seconds);
  const std::optional<Stamp> result = given ? positions_.stamp(*given, TimeScale::gps) : std::nullopt;
  if (!result) {
    complain(0, given ? "its time is too large for a stamp"
                      : fmt::format("expected a GPS week and its seconds, got {} {}", quote_field(week),
                                    quote_field(seconds)));
    if (!in_body) column_ = 1;
  }
  return result;
}

void NovatelDecoder::take_velocity(Stamp at) {
  const double latency = number(2, "latency", 0, 3600);
  const double speed = number(4, "horizontal speed", 0, 1000);
  const double course = number(5, "track over ground", -360, 360);
  if (!is_sound()) return;
  largest_latency_s_ = std::max(largest_latency_s_, latency);
  velocity_ = Velocity{at, speed, kDegree * course};
  if (held_ && held_->fix.stamp == at) release();
}

void NovatelDecoder::take_position(Stamp at, std::size_t line_number) {
  const std::size_t place = layout_->latitude;
  GeodeticFix fix;
  fix.stamp = at;
  fix.latitude_deg = number(place, "latitude", -90, 90);
  fix.longitude_deg = number(place + 1, "longitude", -180, 360);
  fix.height_m = number(place + 2, "height", -kFar, kFar);
  if (layout_->undulation != kNoField) fix.height_m += number(layout_->undulation, "undulation", -kFar, kFar);
  fix.line = line_number;
  if (!is_sound()) return;
  if (layout_->type != kNoField) {
    types_.add(message_.body[layout_->type]);
    fix.told.quality = novatel_quality(message_.body[layout_->type]);
  }
  read_details(fix);
  const std::string_view datum = message_.body[layout_->datum];
  if (!datum.empty() && datum != "WGS84" && datum_.empty()) datum_ = quote_field(datum);
  if (positions_.wants_truth()) {
    std::optional<double> heading;
    if (layout_->azimuth != kNoField)
      heading = std::remainder(kDegree * (90 - number(layout_->azimuth, "azimuth", -360, 360)),
                               2 * std::numbers::pi);
    if (!is_sound()) return;
    const char* complaint = positions_.add(data_, fix, {}, heading);
    if (complaint != nullptr) complain(0, complaint);
    return;
  }
  const StatedAccuracy stated = accuracy();
  if (layout_->velocity != kNoField) set_inertial_velocity(fix);
  if (is_sound()) hold(fix, stated);
}

/// Reads the age of the corrections and the number of satellites of BESTPOS and its relatives.
void NovatelDecoder::read_details(GeodeticFix& fix) {
  constexpr std::size_t kAge = 11;
  constexpr std::size_t kSatellitesUsed = 14;
  if (layout_->fields != 10 || message_.body.count() <= kSatellitesUsed) return;
  const std::optional<double> age_s = field_number(message_.body[kAge]);
  if (age_s && *age_s > 0) fix.told.correction_age_s = *age_s;
  fix.told.satellites = field_count(message_.body[kSatellitesUsed]).value_or(-1);
}

StatedAccuracy NovatelDecoder::accuracy() {
  if (layout_->sigma == kNoField) return {};
  const double north = number(layout_->sigma, "latitude sigma", 0, 1e9);
  const double east = number(layout_->sigma + 1, "longitude sigma", 0, 1e9);
  if (north == 0 || east == 0) return {};
  return {.squares_en = Eigen::Vector2d(east * east, north * north).asDiagonal().toDenseMatrix()};
}

void NovatelDecoder::set_inertial_velocity(GeodeticFix& fix) {
  const double north = number(layout_->velocity, "north velocity", -1000, 1000);
  const double east = number(layout_->velocity + 1, "east velocity", -1000, 1000);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  if (layout_->velocity_sigma != kNoField) {
    const double sigma_north = number(layout_->velocity_sigma, "north velocity sigma", 0, 1e4);
    const double sigma_east = number(layout_->velocity_sigma + 1, "east velocity sigma", 0, 1e4);
    covariance.diagonal() << sigma_east * sigma_east, sigma_north * sigma_north;
  }
  if (is_sound())
    set_velocity(fix, {east, north}, covariance.diagonal().minCoeff() > 0 ? &covariance : nullptr);
}

/// Holds a fix until the velocity of its time can no longer come.
void NovatelDecoder::hold(const GeodeticFix& fix, const StatedAccuracy& accuracy) {
  release();
  const std::size_t field = layout_->sigma == kNoField ? 0 : layout_->sigma;
  held_ = {fix, accuracy, message_.body_column + message_.body.column(field) - 1, layout_->name};
  if (layout_->velocity != kNoField || (velocity_ && velocity_->at == fix.stamp)) release();
}

void NovatelDecoder::release() {
  if (!held_) return;
  GeodeticFix& fix = held_->fix;
  if (velocity_ && velocity_->at == fix.stamp && !fix.speed_mps) {
    fix.speed_mps = velocity_->speed_mps;
    fix.course_rad = velocity_->course_rad;
  }
  const char* complaint = positions_.add(data_, fix, held_->accuracy);
  if (complaint != nullptr) corrupt(fix.line, held_->column, fmt::format("{}: {}", held_->kind, complaint));
  held_.reset();
}

double NovatelDecoder::number(std::size_t field, const char* name, double smallest, double largest) {
  const std::string_view text = message_.body[field];
  const std::optional<double> value = field_number(text);
  if (!value) {
    complain(field, fmt::format("{}: expected a number, got {}", name, quote_field(text)));
  } else if (*value < smallest || *value > largest) {
    complain(field, fmt::format("{}: {} is outside {} .. {}", name, *value, smallest, largest));
  } else {
    return *value;
  }
  return 0;
}

void NovatelDecoder::complain(std::size_t field, const std::string& what) {
  if (!is_sound()) return;
  column_ = message_.body_column + message_.body.column(field) - 1;
  what_ = what;
}

void NovatelDecoder::end() {
  release();
  data_.kinds = kinds_.counts();
  if (abbreviated_ > 0) {
    const std::string what = fmt::format(
        "{} lines are abbreviated ASCII (`<BESTPOS`), which has no checksum and is not read; let the "
        "receiver log BESTPOSA",
        abbreviated_);
    if (data_.records == 0) throw InputError(fmt::format("{}: {}", path(), what));
    note(what);
  }
  if (other_lines_ > 0) note(fmt::format("{} lines that are no NovAtel messages were skipped", other_lines_));
  std::string types;
  for (const auto& [name, count] : types_.counts())
    types += fmt::format("{}{} {}", types.empty() ? "" : ", ", count, name);
  if (!types.empty()) note("positions by type: " + types);
  if (largest_latency_s_ > 0)
    note(
        fmt::format("BESTVEL states latencies up to {} s: its speeds and courses are up to that "
                    "much older than their fixes",
                    largest_latency_s_));
  if (!datum_.empty()) note(fmt::format("positions of datum {} are taken as WGS84", datum_));
  if (without_time_ > 0)
    note(fmt::format("{} positions of a receiver that does not know the time yet were skipped",
                     without_time_));
  positions_.finish(data_);
}

}  // namespace

std::unique_ptr<LogDecoder> NovatelReader::open(const std::string& path, const LogRequest& request) const {
  require_positions(path, request, kNovatelFormat);
  return std::make_unique<NovatelDecoder>(path, request);
}

Recognition NovatelReader::recognise(std::string_view head) const {
  HeadLines lines(head);
  std::size_t right = 0;
  NovatelMessage message;
  while (lines.next()) {
    if (!novatel_name(lines.line()).empty() && read_novatel(lines.line(), message).empty()) ++right;
  }
  return lines.share(right, "are NovAtel messages with a right checksum");
}

}  // namespace waymark::formats
