#include <waymark/formats/logs/detail/kitti/kitti_oxts.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::formats {
namespace {

/// A number of a record that is read: its place and its range.
struct Column {
  std::size_t place;
  const char* name;
  double smallest;
  double largest;
};
constexpr std::size_t kColumns = 30;
constexpr double kAny = std::numeric_limits<double>::max();
constexpr Column kLatitudeColumn{0, "lat", -90, 90};
constexpr Column kLongitudeColumn{1, "lon", -180, 180};
constexpr Column kAltitude{2, "alt", -kAny, kAny};
constexpr Column kYaw{5, "yaw", -7, 7};
constexpr Column kNorthVelocity{6, "vn", -150, 150};
constexpr Column kEastVelocity{7, "ve", -150, 150};
constexpr Column kForwardVelocity{8, "vf", -150, 150};
constexpr Column kUpwardRate{22, "wu", -20, 20};
constexpr Column kPositionAccuracy{23, "pos_accuracy", -kAny, kAny};
constexpr Column kVelocityAccuracy{24, "vel_accuracy", -kAny, kAny};
constexpr Column kStatus{25, "navstat", 0, 255};
constexpr double kFirstSolution = 3;  // navstat: locking; 4: locked

/// @throws InputError for a line that is no time stamp
std::vector<Stamp> read_stamps(const CompanionFile& file) {
  std::vector<Stamp> stamps;
  std::string_view rest = file.text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty()) continue;
    const std::optional<Stamp> stamp = stamp_from_iso8601(line);
    if (!stamp)
      throw InputError(
          fmt::format("{}:{}:1: expected a time stamp like 2011-09-26 13:02:25.964389445, got {}", file.path,
                      number, quote_word(line)));
    stamps.push_back(*stamp);
  }
  return stamps;
}

const CompanionFile& stamps_file(const std::string& path, const LogRequest& request) {
  constexpr const char* kOxtsFormat = "a KITTI oxts log";
  require_streams(path, request, kOxtsFormat, {StreamKind::odometry, StreamKind::gnss, StreamKind::truth});
  require_no_columns(path, request, kOxtsFormat);
  require_companions(path, request, kOxtsFormat, "timestamps");
  const auto file = request.companions.find("timestamps");
  if (file == request.companions.end() || file->second.empty())
    throw InputError(fmt::format(
        "{}: a KITTI oxts log holds no time: give its oxts/timestamps.txt as 'timestamps'", path));
  if (file->second.size() > 1)
    throw InputError(fmt::format("{}: one file has the stamps; state one as 'timestamps'", path));
  return file->second.front();
}

class OxtsDecoder final : public LineDecoder {
 public:
  OxtsDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request),
        stamps_path_(stamps_file(path, request).path),
        stamps_(read_stamps(stamps_file(path, request))),
        positions_(path, request, "pos_accuracy") {}

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;

  void take_record(Stamp at, std::size_t number);
  void take_position(GeodeticFix fix);
  [[nodiscard]] double number(const Column& column);
  void complain(std::size_t field, const std::string& what);
  [[nodiscard]] bool is_sound() const { return what_.empty(); }

  std::string stamps_path_;
  std::vector<Stamp> stamps_;
  PositionStream positions_;
  RecordFields fields_;
  std::array<std::size_t, 256> statuses_{};
  std::size_t column_ = 0;  ///< of the first error of the current record
  std::string what_;        ///< empty: none
};

void OxtsDecoder::take_line(std::string_view line, std::size_t line_number) {
  fields_.split_words(line);
  if (fields_.count() == 0) return;
  const std::size_t record = data_.records++;
  if (record >= stamps_.size()) return;  // end() reports the error with both counts
  what_.clear();
  const std::optional<Stamp> at = positions_.stamp(stamps_[record], TimeScale::unix_time);
  if (fields_.count() != kColumns) {
    complain(fields_.count(), fmt::format("expected {} numbers, got {}", kColumns, fields_.count()));
  } else if (!at) {
    complain(0, "its time is too large for a stamp");
  } else {
    take_record(*at, line_number);
  }
  if (!is_sound()) corrupt(line_number, column_, what_);
}

void OxtsDecoder::take_record(Stamp at, std::size_t line_number) {
  const double status = number(kStatus);
  if (!is_sound()) return;
  ++statuses_[static_cast<std::size_t>(status)];
  if (status < kFirstSolution) {
    ++data_.without_fix;
    return;
  }
  if (request().stream == StreamKind::odometry) {
    const OdometrySample sample{at, number(kForwardVelocity), number(kUpwardRate)};
    if (is_sound()) data_.odometry.push_back(sample);
    return;
  }
  GeodeticFix fix;
  fix.stamp = at;
  fix.latitude_deg = number(kLatitudeColumn);
  fix.longitude_deg = number(kLongitudeColumn);
  fix.height_m = number(kAltitude);
  fix.line = line_number;
  take_position(fix);
}

void OxtsDecoder::take_position(GeodeticFix fix) {
  StatedAccuracy accuracy;
  std::optional<double> yaw;
  if (positions_.wants_truth()) {
    yaw = number(kYaw);
  } else {
    const double sigma = number(kPositionAccuracy);
    if (sigma > 0) accuracy.squares_en = sigma * sigma * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d velocity(number(kEastVelocity), number(kNorthVelocity));
    const double velocity_sigma = number(kVelocityAccuracy);
    const Eigen::Matrix2d covariance = velocity_sigma * velocity_sigma * Eigen::Matrix2d::Identity();
    if (is_sound()) set_velocity(fix, velocity, velocity_sigma > 0 ? &covariance : nullptr);
  }
  if (!is_sound()) return;
  const char* complaint = positions_.add(data_, fix, accuracy, yaw);
  if (complaint != nullptr) complain(kPositionAccuracy.place, complaint);
}

double OxtsDecoder::number(const Column& column) {
  const std::string_view field = fields_[column.place];
  const std::optional<double> value = field_number(field);
  if (!value) {
    complain(column.place, fmt::format("{}: expected a number, got {}", column.name, quote_word(field)));
  } else if (*value < column.smallest || *value > column.largest) {
    complain(column.place,
             fmt::format("{}: {} is outside {} .. {}", column.name, *value, column.smallest, column.largest));
  } else {
    return *value;
  }
  return 0;
}

void OxtsDecoder::complain(std::size_t field, const std::string& what) {
  if (!is_sound()) return;
  column_ = fields_.column(field);
  what_ = what;
}

void OxtsDecoder::end() {
  if (data_.records != stamps_.size())
    throw InputError(fmt::format("{}: {} records, but {} has {} time stamps; each record needs one", path(),
                                 data_.records, stamps_path_, stamps_.size()));
  for (std::size_t status = 0; status < statuses_.size(); ++status) {
    if (statuses_[status] > 0) data_.kinds[fmt::format("navstat {}", status)] = statuses_[status];
  }
  note("the zone of the time stamps is not stated: they are taken as UTC");
  if (request().stream == StreamKind::odometry)
    note("speed is vf and yaw rate is wu of an inertial unit that uses GNSS, no independent odometry");
  if (request().stream == StreamKind::gnss && request().accuracy == AccuracyMeaning::automatic)
    note("pos_accuracy is taken as 1sigma of each axis (not stated)");
  positions_.finish(data_);
}

}  // namespace

std::unique_ptr<LogDecoder> KittiOxtsReader::open(const std::string& path, const LogRequest& request) const {
  return std::make_unique<OxtsDecoder>(path, request);
}

Recognition KittiOxtsReader::recognise(std::string_view head) const {
  HeadLines lines(head);
  RecordFields fields;
  while (lines.next()) {
    fields.split_words(lines.line());
    if (fields.count() != kColumns) return {};
    for (std::size_t i = 0; i < kColumns; ++i) {
      const bool state = i >= kStatus.place;  // the last five are whole numbers
      if (state ? !field_count(fields[i]) : !field_number(fields[i])) return {};
    }
  }
  if (lines.count() == 0) return {};
  return {0.9, fmt::format("each of its first {} lines is 30 numbers, the last 5 whole", lines.count())};
}

}  // namespace waymark::formats
