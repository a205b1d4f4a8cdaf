#include <waymark/formats/logs/position_stream.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/logs/accuracy.hpp>

namespace waymark {
namespace {

constexpr double kLargestSigma = 1e6;  // m; larger figures are garbled, and their squares overflow

}  // namespace

PositionStream::PositionStream(const std::string& path, const LogRequest& request)
    : path_(path),
      scale_(request.time_scale),
      offset_(std::llround(request.time_offset_s * 1e9)),
      meaning_(request.accuracy),
      variance_factor_(sigma_factor(request.accuracy) * sigma_factor(request.accuracy)),
      default_sigma_m_(request.default_sigma_m),
      range_error_m_(request.range_error_m),
      source_(request.source),
      truth_(request.stream == StreamKind::truth) {}

std::optional<Stamp> PositionStream::stamp(Stamp given, TimeScale scale) const {
  Stamp result = convert(given, scale, scale_);
  if (__builtin_add_overflow(result.nanoseconds, offset_, &result.nanoseconds)) return std::nullopt;
  return result;
}

const char* PositionStream::add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad) {
  if (truth_) {
    data.truth.push_back({fix.stamp, fix.latitude_deg, fix.longitude_deg, fix.height_m, heading_rad});
    return nullptr;
  }
  if (const char* complaint = set_covariance(fix, accuracy)) return complaint;
  fix.source = source_;
  data.fixes.push_back(fix);
  return nullptr;
}

const char* PositionStream::set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy) {
  if (accuracy.covariance_en) {
    const Eigen::Matrix2d& given = *accuracy.covariance_en;
    const double largest = std::max(given(0, 0), given(1, 1));
    if (!(largest < kLargestSigma * kLargestSigma)) return "a sigma of more than 1000 km";
    if (!(given(0, 0) > 0 && given(0, 0) * given(1, 1) > given(0, 1) * given(0, 1)))
      return "the covariance is not positive definite";
    fix.covariance_en = variance_factor_ * given;
    ++from_covariance_;
    return nullptr;
  }
  double sigma = default_sigma_m_;
  if (accuracy.hdop > 0 && range_error_m_ > 0) {
    sigma = accuracy.hdop * range_error_m_;
    if (!(sigma < kLargestSigma)) return "a sigma of more than 1000 km";
    ++from_hdop_;
  } else if (sigma > 0) {
    ++defaulted_;
  } else if (accuracy.hdop > 0) {
    return "only HDOP tells the accuracy: state range_error_m or default_sigma_m";
  } else {
    return "no accuracy, and no default sigma is stated (default_sigma_m)";
  }
  fix.covariance_en = sigma * sigma * Eigen::Matrix2d::Identity();
  return nullptr;
}

void PositionStream::finish(LogData& data) const {
  const auto note = [&](const std::string& text) { data.notes.push_back(path_ + ": " + text); };
  if (from_covariance_ > 0 && meaning_ != AccuracyMeaning::automatic &&
      meaning_ != AccuracyMeaning::one_sigma)
    note(
        fmt::format("the sigmas of {} fixes are read as {} (stated)", from_covariance_, to_string(meaning_)));
  if (from_hdop_ > 0)
    note(fmt::format("the sigma of {} fixes is HDOP times the stated {} m", from_hdop_, range_error_m_));
  if (defaulted_ > 0)
    note(fmt::format("{} fixes give no accuracy, the stated default sigma of {} m is used", defaulted_,
                     default_sigma_m_));
  if (data.without_fix > 0)
    note(fmt::format("{} of {} records are marked as without a fix", data.without_fix, data.records));
}

void require_positions(const std::string& path, const LogRequest& request, const char* format) {
  if (request.stream == StreamKind::odometry)
    throw InputError(
        fmt::format("{}: {} holds no odometry; it gives the streams gnss and truth", path, format));
  if (request.stream == StreamKind::sensor)
    throw InputError(
        fmt::format("{}: {} holds no sensor readings; it gives the streams gnss and truth", path, format));
  if (!request.columns.empty())
    throw InputError(fmt::format("{}: {} has no columns to map; leave out 'columns'", path, format));
  if (!request.companions.empty())
    throw InputError(fmt::format("{}: {} takes no '{}' file; leave it out", path, format,
                                 request.companions.begin()->first));
}

void set_velocity(GeodeticFix& fix, const Eigen::Vector2d& velocity_en, const Eigen::Matrix2d* covariance) {
  const double speed = velocity_en.norm();
  fix.speed_mps = speed;
  if (!(speed > 0)) return;
  const double course = std::atan2(velocity_en.x(), velocity_en.y());
  const double course_rad = course < 0 ? course + 2 * std::numbers::pi : course;
  if (covariance == nullptr) {
    fix.course_rad = course_rad;
    return;
  }
  const Eigen::Vector2d along = velocity_en / speed;
  const Eigen::Vector2d across(-along.y(), along.x());
  const double speed_sigma = std::sqrt(along.dot(*covariance * along));
  const double course_sigma = std::sqrt(across.dot(*covariance * across)) / speed;
  if (speed_sigma > 0) fix.speed_sigma_mps = speed_sigma;
  if (!(course_sigma > 0 && course_sigma <= 1)) return;
  fix.course_rad = course_rad;
  fix.course_sigma_rad = course_sigma;
}

}  // namespace waymark
