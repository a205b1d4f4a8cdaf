#include <waymark/tools/drive/clocks/late_quantity.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/clock_sync.hpp>
#include <waymark/tools/drive/clocks/gnss_motion.hpp>
#include <waymark/tools/drive/clocks/motion_lags.hpp>
#include <waymark/tools/drive/logs/clock_offsets.hpp>

namespace waymark::drive {
namespace {

constexpr double kLateDeviations = 4;
constexpr double kLeastDifference_s = 0.15;
constexpr double kAntennaSigma_m = 0.3;  // by which a stated place of an antenna may be wrong

/// Tells whether a lag itself is late: fixes are never early, so it is not their delay.
bool is_late(double lag_s, double variance_s2, double deviations = kLateDeviations) {
  constexpr double kLeast_s = 0.1;
  return lag_s > kLeast_s && lag_s > deviations * std::sqrt(variance_s2);
}

bool is_late_speed(const MotionLags& lags) {
  constexpr double kDeviationsIfLate = 3;
  const bool is_itself_late = is_late(lags.speed_s, lags.covariance_s2(0, 0));
  const double deviations = is_itself_late ? kDeviationsIfLate : kLateDeviations;
  return lags.difference_s() > std::max(kLeastDifference_s, deviations * lags.difference_sigma_s());
}

bool is_late_yaw_rate(const MotionLags& lags) {
  return is_late(lags.yaw_rate_s, lags.covariance_s2(1, 1)) && std::abs(lags.arm_m) < 3 * kAntennaSigma_m &&
         -lags.difference_s() > std::max(kLeastDifference_s, kLateDeviations * lags.difference_sigma_s());
}

/// Returns what lies in the middle of a drive, at most ten minutes: velocities know a lag to hundredths of a second by
/// then.
template <typename Sample>
std::vector<Sample> middle_of(const std::vector<Sample>& samples, Stamp first, Stamp last) {
  constexpr double kHalf_s = 300;
  const double middle_s = 0.5 * seconds_between(first, last);
  std::vector<Sample> within;
  for (const Sample& sample : samples)
    if (std::abs(seconds_between(first, sample.stamp) - middle_s) <= kHalf_s) within.push_back(sample);
  return within;
}

/// Returns the lags against speeds and courses of a receiver that gives both. Receivers and wheels smooth, and not by the
/// same time.
std::optional<MotionLags> lags_by_velocity(const std::vector<OdometrySample>& odometry,
                                           const std::vector<Fix>& fixes) {
  constexpr double kFarthest_s = 1.5;
  constexpr double kFits = 0.8;  // correlation
  const Stamp first = odometry.front().stamp;
  const Stamp last = odometry.back().stamp;
  const std::vector<OdometrySample> readings = middle_of(odometry, first, last);
  const std::vector<Fix> between = middle_of(fixes, first, last);
  if (readings.size() < 2 || between.empty()) return std::nullopt;
  const auto [speed, yaw_rate] = estimate_clock_offsets(readings, between, {});
  if (!speed || speed->against != "receiver's speed") return std::nullopt;
  if (!yaw_rate || yaw_rate->against != "receiver's course") return std::nullopt;
  if (std::min(speed->correlation, yaw_rate->correlation) < kFits) return std::nullopt;
  if (std::max(std::abs(speed->late_s), std::abs(yaw_rate->late_s)) > kFarthest_s) return std::nullopt;
  const Eigen::Vector2d sigma(std::hypot(speed->sigma_s, kSmoothing_s),
                              std::hypot(yaw_rate->sigma_s, kSmoothing_s));
  return MotionLags{speed->late_s, yaw_rate->late_s, sigma.cwiseAbs2().asDiagonal(), 0};
}

/// Tells whether both quantities are so well known to be on the same clock that nothing else can say otherwise.
bool excludes_lateness(const MotionLags& lags) {
  constexpr double kDeviations = 3;
  return std::abs(lags.difference_s()) + kDeviations * lags.difference_sigma_s() < kLeastDifference_s;
}

/// Adds the lags against one receiver, by its positions and by its velocity, if they are known well. The latter take
/// much longer, and only where the former leave a doubt.
void add_lags(const std::vector<OdometrySample>& odometry, const std::vector<Fix>& fixes, double arm_sigma_m,
              std::vector<MotionLags>& told) {
  constexpr double kPoor_s = 0.15;
  const auto add = [&](const std::optional<MotionLags>& lags) {
    if (lags && lags->difference_sigma_s() < kPoor_s) told.push_back(*lags);
  };
  const auto by_position = estimate_motion_lags(odometry, of_one_receiver(fixes), arm_sigma_m);
  add(by_position);
  if (!by_position || !excludes_lateness(*by_position)) add(lags_by_velocity(odometry, fixes));
}

/// Returns what those say that are known best. Empty: nothing is known, or two contradict each other.
std::optional<MotionLags> best_lags(const std::vector<OdometrySample>& odometry,
                                    const std::vector<Fix>& fixes, double arm_sigma_m) {
  std::map<int, std::vector<Fix>> receivers;
  for (const Fix& fix : fixes)
    if (fix.status != FixStatus::withheld) receivers[fix.source].push_back(fix);
  std::vector<MotionLags> told;
  for (const auto& [source, own] : receivers) add_lags(odometry, own, arm_sigma_m, told);
  if (told.empty()) return std::nullopt;
  const MotionLags best = *std::min_element(told.begin(), told.end(), [](const auto& a, const auto& b) {
    return a.difference_sigma_s() < b.difference_sigma_s();
  });
  const bool all_agree = std::all_of(told.begin(), told.end(), [&](const MotionLags& lags) {
    return std::abs(lags.difference_s() - best.difference_s()) <
           kLateDeviations * std::hypot(lags.difference_sigma_s(), best.difference_sigma_s(), kSmoothing_s);
  });
  return all_agree ? std::optional(best) : std::nullopt;
}

/// Returns how late a quantity is, if the other one is on time and the fixes have a delay of the usual size (a Kalman
/// step on the covariance of both lags).
LateQuantity with_other_on_time(LateQuantity::Kind kind, const MotionLags& lags) {
  constexpr double kUsualDelay_s = 0.15;
  const int late = kind == LateQuantity::Kind::speed ? 0 : 1;
  const int other = 1 - late;
  const Eigen::Vector2d found(lags.speed_s, lags.yaw_rate_s);
  const Eigen::Vector2d gain =
      lags.covariance_s2.col(other) / (lags.covariance_s2(other, other) + kUsualDelay_s * kUsualDelay_s);
  const Eigen::Vector2d expected = found - gain * found[other];
  const Eigen::Matrix2d covariance = lags.covariance_s2 - gain * lags.covariance_s2.row(other);
  const Eigen::RowVector2d difference = Eigen::RowVector2d::Unit(late) - Eigen::RowVector2d::Unit(other);
  return {kind, difference * expected, std::sqrt(difference * covariance * difference.transpose())};
}

}  // namespace

std::string LateQuantity::name() const {
  return kind == Kind::speed ? "speed" : "yaw rate";
}

std::string LateQuantity::key() const {
  return kind == Kind::speed ? "speed_delay" : "yaw_rate_delay";
}

std::string LateQuantity::increase() const {
  return fmt::format("increase '{}' by {:.2f}", key(), late_s);
}

double& LateQuantity::delay_in(OdometryConfig& odometry) const {
  return kind == Kind::speed ? odometry.speed_delay_s : odometry.yaw_rate_delay_s;
}

std::optional<LateQuantity> late_quantity_shown(const std::vector<OdometrySample>& odometry,
                                                const std::vector<Fix>& fixes, const YawRateAtRest& rest) {
  constexpr double kUnstatedSigma_m = 1.5;
  if (rest.stated_derived) return std::nullopt;
  const std::optional<MotionLags> lags = best_lags(odometry, fixes, kAntennaSigma_m);
  if (!lags) return std::nullopt;
  if (is_late_speed(*lags)) return with_other_on_time(LateQuantity::Kind::speed, *lags);
  if (!is_late_yaw_rate(*lags) || rest.is_derived()) return std::nullopt;
  // Nearly all antennas are ahead of the rear axle, and few are stated.
  const bool is_stated = std::any_of(fixes.begin(), fixes.end(),
                                     [](const Fix& fix) { return fix.antenna_m != Eigen::Vector2d::Zero(); });
  const auto anywhere = is_stated ? lags : best_lags(odometry, fixes, kUnstatedSigma_m);
  if (!anywhere || !is_late_yaw_rate(*anywhere)) return std::nullopt;
  return LateQuantity{LateQuantity::Kind::yaw_rate, -anywhere->difference_s(),
                      anywhere->difference_sigma_s()};
}

bool yaw_rate_is_late(const std::vector<OdometrySample>& odometry, const std::vector<Fix>& fixes) {
  constexpr double kDeviations = 2;
  const std::optional<MotionLags> lags = best_lags(odometry, fixes, kAntennaSigma_m);
  return lags && is_late(lags->yaw_rate_s, lags->covariance_s2(1, 1), kDeviations);
}

std::vector<OdometrySample> without_lateness(const std::vector<OdometrySample>& odometry,
                                             const LateQuantity& late) {
  OdometryConfig delays;
  late.delay_in(delays) = late.late_s;
  return without_delays(odometry, delays.speed_delay_s, delays.yaw_rate_delay_s);
}

bool states_delays(const OdometryConfig& odometry) {
  constexpr double kZone_s = 900;  // zones differ by quarters of an hour, which says nothing of a delay
  constexpr double kRounding_s = 1e-6;
  const auto differs = [&](const LogConfig& log) {
    const double apart_s = log.request.time_offset_s - odometry.logs.front().request.time_offset_s;
    return std::abs(std::remainder(apart_s, kZone_s)) > kRounding_s;
  };
  return !odometry.delay_place.empty() || odometry.speed_delay_s != 0 || odometry.yaw_rate_delay_s != 0 ||
         std::any_of(odometry.logs.begin(), odometry.logs.end(), differs);
}

std::string late_quantity_warning(const std::string& odometry, const LateQuantity& late,
                                  const std::string& cure) {
  const bool is_speed = late.kind == LateQuantity::Kind::speed;
  return fmt::format("{}'s {} seems {:.2f} +- {:.2f} s late, its {} not: {}", odometry, late.name(),
                     late.late_s, std::hypot(late.sigma_s, kSmoothing_s), is_speed ? "yaw rate" : "speed",
                     cure);
}

}  // namespace waymark::drive
