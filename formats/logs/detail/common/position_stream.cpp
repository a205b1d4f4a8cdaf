#include <waymark/formats/logs/detail/common/position_stream.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/accuracy.hpp>
#include <waymark/formats/logs/fix_quality.hpp>

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
      sigma_by_quality_(request.sigma_by_quality),
      source_(request.source),
      truth_(request.stream == StreamKind::truth) {}

std::optional<Stamp> PositionStream::stamp(Stamp given, TimeScale scale) const {
  Stamp result = convert(given, scale, scale_);
  if (__builtin_add_overflow(result.nanoseconds, offset_, &result.nanoseconds)) return std::nullopt;
  return result;
}

const char* PositionStream::set_covariance(GeodeticFix& fix, const StatedAccuracy& accuracy) {
  if (truth_) return nullptr;
  if (!accuracy.squares_en) return stand_in(fix);
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
const char* PositionStream::stand_in(GeodeticFix& fix) {
  const FixQuality quality = fix.told.quality;
  const auto index = static_cast<std::size_t>(quality);
  if (const auto stated = sigma_by_quality_.find(quality); stated != sigma_by_quality_.end())
    return take_sigma(fix, stated->second, true, stated_quality_[index]);
  const UsualSigma usual = usual_sigma(quality);
  const bool hdop_told = fix.told.hdop > 0;
  // What is stated for the log as a whole is meant for code ranges.
  if (usual.sigma_m > 0 && !usual.by_hdop && !(default_sigma_m_ > 0 && default_sigma_m_ < usual.sigma_m))
    return take_sigma(fix, usual.sigma_m, true, usual_quality_[index]);
  if (hdop_told && range_error_m_ > 0)
    return take_sigma(fix, fix.told.hdop * range_error_m_, true, from_hdop_);
  if (default_sigma_m_ > 0) return take_sigma(fix, default_sigma_m_, false, defaulted_);
  if (usual.sigma_m > 0 && hdop_told)
    return take_sigma(fix, usual.sigma_m * fix.told.hdop, true, usual_hdop_[index]);
  if (usual.sigma_m > 0) return take_sigma(fix, usual.sigma_m, false, usual_quality_[index]);
  return hdop_told ? "the log has no accuracy but HDOP: state 'range_error', which is multiplied by "
                     "HDOP, or 'accuracy: {default_sigma: ...}'"
                   : "the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'";
}

/// @param claimed the receiver told something about this fix that the sigma comes from
const char* PositionStream::take_sigma(GeodeticFix& fix, double sigma_m, bool claimed,
                                       std::size_t& count) const {
  if (!(sigma_m <= kLargestSigma)) return kTooLarge;
  ++count;
  fix.accuracy_claimed = claimed;
  fix.covariance_en = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  return nullptr;
}

void PositionStream::give(LogData& data, const GeodeticFix& fix, std::optional<double> heading_rad) {
  if (truth_) {
    data.truth.push_back({fix.stamp, fix.latitude_deg, fix.longitude_deg, fix.height_m, heading_rad});
    return;
  }
  data.fixes.push_back(fix);
  data.fixes.back().source = source_;
  ++qualities_[static_cast<std::size_t>(fix.told.quality)];
}

const char* PositionStream::add(LogData& data, GeodeticFix fix, const StatedAccuracy& accuracy,
                                std::optional<double> heading_rad) {
  if (const char* complaint = set_covariance(fix, accuracy)) return complaint;
  give(data, fix, heading_rad);
  return nullptr;
}

void PositionStream::finish(LogData& data) const {
  for (const FixQuality quality : kFixQualities)
    if (const std::size_t count = qualities_[static_cast<std::size_t>(quality)]; count > 0)
      data.qualities[quality] += count;
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
  const auto list = [&](const char* way, const std::array<std::size_t, kFixQualities.size()>& counts,
                        const char* factor, const auto& sigma_of) {
    std::string parts;
    for (const FixQuality quality : kFixQualities) {
      const std::size_t count = counts[static_cast<std::size_t>(quality)];
      if (count > 0)
        parts += fmt::format("{}{} {} {} m{}", parts.empty() ? "" : ", ", count, to_string(quality),
                             sigma_of(quality), factor);
    }
    if (!parts.empty())
      note(fmt::format("the sigma of fixes without accuracy is {} for their quality: {}", way, parts));
  };
  const auto usual = [](FixQuality quality) { return usual_sigma(quality).sigma_m; };
  list("that stated", stated_quality_, "", [&](FixQuality quality) { return sigma_by_quality_.at(quality); });
  list("the usual one (not stated)", usual_quality_, "", usual);
  list("the usual one (not stated)", usual_hdop_, " x HDOP", usual);
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
