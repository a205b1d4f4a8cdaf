#include <waymark/formats/logs/gpsd_json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/error.hpp>
#include <waymark/formats/iso8601.hpp>
#include <waymark/formats/logs/accuracy.hpp>

namespace waymark {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;

/// A member of an object that does not hold what the protocol says.
struct BadMember {
  std::string what;
};

std::optional<double> number(const json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end() || member->is_null()) return std::nullopt;
  if (!member->is_number())
    throw BadMember{fmt::format("TPV: expected a number for '{}', got {}", key, member->dump())};
  const double value = member->get<double>();
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::string word(const json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

double required(const json& object, const char* key, double limit) {
  const std::optional<double> value = number(object, key);
  if (!value) throw BadMember{fmt::format("TPV: a fix without '{}'", key)};
  if (std::abs(*value) > limit)
    throw BadMember{fmt::format("TPV: '{}' {} is outside {} .. {}", key, *value, -limit, limit)};
  return *value;
}

std::optional<double> scaled(std::optional<double> value, double factor) {
  if (value) *value *= factor;
  return value;
}

std::optional<double> scaled_if_positive(std::optional<double> value, double factor) {
  return value && *value > 0 ? scaled(value, factor) : std::nullopt;
}

/// Counts of what was passed over.
struct Passed {
  std::size_t not_json = 0;
  std::size_t without_time = 0;
  std::size_t other_devices = 0;
};

/// How often each source of accuracy was used.
struct AccuracyUse {
  std::size_t per_axis = 0;
  std::size_t per_axis_equal = 0;
  std::size_t radial = 0;
  std::size_t defaulted = 0;
};

class GpsdLog {
 public:
  GpsdLog(const std::string& path, const LogRequest& request) : path_(path), request_(request) {}

  void read_line(std::string_view line, std::size_t line_number);
  [[nodiscard]] LogData finish();

 private:
  void read_report(const json& report, std::size_t line_number);
  void end_epoch();
  void add_sample(const json& report, Stamp stamp);
  [[nodiscard]] Eigen::Matrix2d covariance(const json& report);
  void note(const std::string& text) { data_.notes.push_back(path_ + ": " + text); }
  void note_accuracy();

  const std::string& path_;
  const LogRequest& request_;
  LogData data_;
  Passed passed_;
  AccuracyUse use_;
  std::string release_;  ///< of gpsd, from VERSION
  std::string device_;   ///< the one that is read
  bool geoid_height_ = false;

  json epoch_;  ///< the merged TPV of the epoch at hand; null: none
  std::size_t epoch_line_ = 0;
};

void GpsdLog::read_line(std::string_view line, std::size_t line_number) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string_view::npos) return;
  if (line[start] != '{') {
    ++passed_.not_json;
    return;
  }
  json object;
  try {
    object = json::parse(line);
  } catch (const json::parse_error& error) {
    ++data_.records;
    add_corrupt(data_, path_, line_number, std::max<std::size_t>(1, error.byte), "malformed JSON");
    return;
  } catch (const json::exception&) {  // a number that no double holds
    ++data_.records;
    add_corrupt(data_, path_, line_number, 1, "a number is out of range");
    return;
  }
  const std::string kind = word(object, "class");
  if (kind == "VERSION") release_ = word(object, "release");
  if (kind == "TPV") read_report(object, line_number);
}

void GpsdLog::read_report(const json& report, std::size_t line_number) {
  const std::string time = word(report, "time");
  const std::string device = word(report, "device");
  if (device_.empty() && !time.empty()) device_ = device;
  if (!device.empty() && !device_.empty() && device != device_) {
    ++passed_.other_devices;
    return;
  }
  if (!epoch_.is_null() && !time.empty() && word(epoch_, "time") == time) {
    epoch_.update(report);
    epoch_line_ = line_number;
    return;
  }
  end_epoch();
  epoch_ = report;
  epoch_line_ = line_number;
}

void GpsdLog::end_epoch() {
  if (epoch_.is_null()) return;
  const json report = std::move(epoch_);
  epoch_ = nullptr;
  ++data_.records;
  try {
    if (number(report, "mode").value_or(0) < 2) {
      ++data_.without_fix;
      return;
    }
    const std::string time = word(report, "time");
    if (time.empty()) {
      ++passed_.without_time;
      return;
    }
    const std::optional<Stamp> stamp = stamp_from_iso8601(time);
    if (!stamp) throw BadMember{fmt::format("TPV: expected an ISO 8601 date for 'time', got '{}'", time)};
    add_sample(report, *stamp);
  } catch (const BadMember& bad) {
    add_corrupt(data_, path_, epoch_line_, 1, bad.what);
  }
}

void GpsdLog::add_sample(const json& report, Stamp utc) {
  Stamp stamp = convert(utc, TimeScale::utc, request_.time_scale);
  stamp.nanoseconds += std::llround(request_.time_offset_s * 1e9);
  const double latitude = required(report, "lat", 90);
  const double longitude = required(report, "lon", 180);
  std::optional<double> height = number(report, "altHAE");
  if (!height) {
    height = number(report, "alt");
    geoid_height_ = geoid_height_ || height.has_value();
  }
  const double height_m = height.value_or(std::numeric_limits<double>::quiet_NaN());
  if (request_.stream == StreamKind::truth) {
    data_.truth.push_back({stamp, latitude, longitude, height_m, std::nullopt});
    return;
  }
  GeodeticFix fix;
  fix.stamp = stamp;
  fix.latitude_deg = latitude;
  fix.longitude_deg = longitude;
  fix.height_m = height_m;
  fix.course_rad = scaled(number(report, "track"), kDegree);
  fix.course_sigma_rad = scaled_if_positive(number(report, "epd"), kDegree / 2);
  fix.speed_mps = number(report, "speed");
  fix.speed_sigma_mps = scaled_if_positive(number(report, "eps"), 0.5);
  fix.source = request_.source;
  fix.line = epoch_line_;
  fix.covariance_en = covariance(report);
  data_.fixes.push_back(fix);
}

Eigen::Matrix2d GpsdLog::covariance(const json& report) {
  const AccuracyMeaning stated = request_.accuracy;
  const bool automatic = stated == AccuracyMeaning::automatic;
  const bool radial_first = stated == AccuracyMeaning::drms || stated == AccuracyMeaning::cep50;
  const double east = number(report, "epx").value_or(0);
  const double north = number(report, "epy").value_or(0);
  const double radial = number(report, "eph").value_or(0);
  const bool per_axis = east > 0 && north > 0;

  Eigen::Vector2d sigma;
  if (per_axis && !(radial_first && radial > 0)) {
    ++use_.per_axis;
    if (east == north) ++use_.per_axis_equal;
    sigma = sigma_factor(automatic ? AccuracyMeaning::percent95 : stated) * Eigen::Vector2d(east, north);
  } else if (radial > 0) {
    ++use_.radial;
    sigma.setConstant(sigma_factor(automatic ? AccuracyMeaning::drms : stated) * radial);
  } else if (request_.default_sigma_m > 0) {
    ++use_.defaulted;
    sigma.setConstant(request_.default_sigma_m);
  } else {
    throw BadMember{"TPV: neither epx and epy nor eph, and no default sigma is stated"};
  }
  return sigma.cwiseAbs2().asDiagonal();
}

void GpsdLog::note_accuracy() {
  const bool automatic = request_.accuracy == AccuracyMeaning::automatic;
  const std::string stated(to_string(request_.accuracy));
  const std::string version = release_.empty() ? "of unknown version" : release_;
  if (use_.per_axis > 0)
    note(fmt::format("gpsd {}: {} fixes with epx and epy read as {}", version, use_.per_axis,
                     automatic ? "95 (not stated)" : stated));
  if (use_.per_axis > 0 && use_.per_axis_equal == use_.per_axis)
    note(
        "epx equals epy throughout: gpsd 3.11 to 3.18 passes u-blox' raw hAcc on so, which drms reads "
        "better");
  if (use_.radial > 0)
    note(fmt::format("{} fixes with eph read as {}", use_.radial, automatic ? "drms (not stated)" : stated));
  if (use_.defaulted > 0)
    note(fmt::format("{} fixes give no accuracy, the stated default sigma of {} m is used", use_.defaulted,
                     request_.default_sigma_m));
}

LogData GpsdLog::finish() {
  end_epoch();
  note_accuracy();
  if (geoid_height_) note("heights are partly above the geoid (no altHAE)");
  if (passed_.not_json > 0)
    note(fmt::format("{} lines that are no JSON objects were skipped", passed_.not_json));
  if (data_.without_fix > 0)
    note(fmt::format("{} of {} records are marked as without a fix", data_.without_fix, data_.records));
  if (passed_.without_time > 0)
    note(fmt::format("{} fixes without a time were skipped", passed_.without_time));
  if (passed_.other_devices > 0)
    note(fmt::format("{} reports of other devices than '{}' were skipped", passed_.other_devices, device_));
  return std::move(data_);
}

}  // namespace

LogData GpsdJsonReader::read_whole(std::string_view text, const std::string& path,
                                   const LogRequest& request) const {
  if (request.stream == StreamKind::odometry)
    throw InputError(fmt::format("{}: a gpsd log holds no odometry", path));
  if (!request.columns.empty()) throw InputError(fmt::format("{}: a gpsd log has no columns to map", path));
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError(fmt::format("{}: the log is empty", path));
  GpsdLog log(path, request);
  for (std::size_t line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = text.find('\n');
    log.read_line(text.substr(0, end), line_number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return log.finish();
}

}  // namespace waymark
