#include <waymark/formats/logs/detail/common/position_stream.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/accuracy.hpp>

namespace waymark::formats {
namespace {

// m: the distance from equator to pole; larger figures are garbled
constexpr double kLargestSigma = 1e7;
constexpr const char* kTooLarge = "an accuracy of more than 10,000 km";

}  // namespace

PositionStream::PositionStream(const std::string& path, const LogRequest& request, const char* figures)
    : path_(path),
      figures_(figures),
      scale_(request.time_scale),
      offset_(std::llround(request.time_offset_s * 1e9)),
      stated_(request.accuracy),
      default_sigma_m_(request.default_sigma_m),
      range_error_m_(request.range_error_m),
      source_(request.source),
      truth_(request.stream == StreamKind::truth) {}

std::optional<Stamp> PositionStream::stamp(Stamp given, TimeScale scale) const {
  Stamp result = convert(given, scale, scale_);
  if (__builtin_add_overflow(result.nanoseconds, offset_, &result.nanoseconds)) return std::nullopt;
  return result;
}

const char* PositionStream::set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy) {
  if (truth_) return nullptr;
  if (!accuracy.squares_en) return stand_in(fix, accuracy.hdop);
  const Eigen::Matrix2d& squares = *accuracy.squares_en;
  // The comparisons fail for NaN.
  if (!(squares(0, 0) > 0 && squares(0, 0) * squares(1, 1) > squares(0, 1) * squares(0, 1)))
    return "the covariance is not positive definite";
  if (!(std::max(squares(0, 0), squares(1, 1)) <= kLargestSigma * kLargestSigma)) return kTooLarge;
  if (!accuracy.usual_meaning) {
    fix.covariance_en = squares;
    return nullptr;
  }
  usual_ = stated_ == AccuracyMeaning::automatic;
  meaning_ = usual_ ? *accuracy.usual_meaning : stated_;
  fix.covariance_en = variance_factor(meaning_) * squares;
  ++with_figures_;
  return nullptr;
}

/// Sets the covariance of a fix without figures.
const char* PositionStream::stand_in(GeodeticFix& fix, double hdop) {
  double sigma = default_sigma_m_;
  if (hdop > 0 && range_error_m_ > 0) {
    sigma = hdop * range_error_m_;
    if (!(sigma <= kLargestSigma)) return kTooLarge;
    ++from_hdop_;
  } else if (sigma > 0) {
    ++defaulted_;
    fix.accuracy_claimed = false;
  } else if (hdop > 0) {
    return "the log has no accuracy but HDOP: state 'range_error', which is multiplied by "
           "HDOP, or 'default_sigma'";
  } else {
    return "the log has no accuracy: state 'default_sigma'";
  }
  fix.covariance_en = sigma * sigma * Eigen::Matrix2d::Identity();
  return nullptr;
}

void PositionStream::give(LogData& data, const GeodeticFix& fix, std::optional<double> heading_rad) const {
  if (truth_) {
    data.truth.push_back({fix.stamp, fix.latitude_deg, fix.longitude_deg, fix.height_m, heading_rad});
    return;
  }
  data.fixes.push_back(fix);
  data.fixes.back().source = source_;
}

const char* PositionStream::add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad) {
  if (const char* complaint = set_covariance(fix, accuracy)) return complaint;
  give(data, fix, heading_rad);
  return nullptr;
}

void PositionStream::finish(LogData& data) const {
  const auto note = [&](const std::string& text) { data.notes.push_back(path_ + ": " + text); };
  // There is no note if the figures are plain standard deviations.
  const bool plain = usual_ && meaning_ == AccuracyMeaning::one_sigma;
  if (figures_ != nullptr && with_figures_ > 0 && !plain)
    note(fmt::format("{} fixes with {} read as {}{}", with_figures_, figures_, to_string(meaning_),
                     usual_ ? " (not stated)" : ""));
  if (from_hdop_ > 0)
    note(fmt::format("{} fixes have only HDOP, which is multiplied by the stated range error of {} m",
                     from_hdop_, range_error_m_));
  if (defaulted_ > 0)
    note(fmt::format("{} fixes have no accuracy; the stated default sigma of {} m is used", defaulted_,
                     default_sigma_m_));
  if (data.without_fix > 0)
    note(fmt::format("{} of {} records are marked as without a fix", data.without_fix, data.records));
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

}  // namespace waymark::formats
