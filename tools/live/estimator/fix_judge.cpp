#include <waymark/tools/live/estimator/fix_judge.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr std::size_t kJudged = 20;
constexpr double kAgreed_s = 12;   // that fixes are compared with
constexpr double kSettled_s = 8;   // of them, at least
constexpr double kQuarter = 0.25;  // of a jump, by which fixes beside it may differ
constexpr double kNextFix_s = 5;   // after the last one: the estimate has not left it

/// Returns a step from the middle of the residuals so far, and how many of them are within a quarter of it.
template <typename Residuals, typename Of>
std::pair<double, std::size_t> step_from(const Residuals& agreed, const Eigen::Vector2d& to, Of of) {
  std::vector<double> x;
  std::vector<double> y;
  for (const auto& residual : agreed) {
    x.push_back(of(residual).x());
    y.push_back(of(residual).y());
  }
  const Eigen::Vector2d middle(upper_median(std::move(x)), upper_median(std::move(y)));
  const double step_m = (to - middle).norm();
  const auto near = std::count_if(agreed.begin(), agreed.end(), [&](const auto& residual) {
    return (of(residual) - middle).norm() <= kQuarter * step_m;
  });
  return {step_m, static_cast<std::size_t>(near)};
}

}  // namespace

bool FixJudge::is_thinned(const GeodeticFix& fix) {
  const double period_s = description_.gnss[static_cast<std::size_t>(fix.source)].period_s;
  if (!(period_s > 0)) return false;
  const auto multiple = static_cast<std::int64_t>(std::llround(fix.stamp.seconds() / period_s));
  std::optional<std::int64_t>& last = receivers_[fix.source].period;
  if (last && multiple <= *last) return true;
  last = multiple;
  return false;
}

/// Tells whether the receiver repeats a position while the vehicle moves away from it.
bool FixJudge::repeats(const Fix& fix, const Reckoning& reckoning) {
  constexpr double kMoves = 5;
  Receiver& receiver = receivers_[fix.source];
  const double way_m = reckoning.at(fix.stamp).way_m;
  if (receiver.still && *receiver.still == fix.position) return way_m - receiver.still_way_m > kMoves;
  receiver.still = fix.position;
  receiver.still_way_m = way_m;
  return false;
}

std::string FixJudge::judged_by_gate(const Fix& fix, const Reckoning& reckoning) {
  const std::string& name = description_.gnss[static_cast<std::size_t>(fix.source)].name;
  const drive::GateOptions gate = drive::for_absolute(settings_, name, registry_).gate;
  if (!gate.enabled.value_or(true)) return "";
  Receiver& receiver = receivers_[fix.source];
  Eigen::Vector3d antenna = reckoning.at(fix.stamp).pose;
  antenna.head<2>() += rotate(antenna[2], fix.antenna_seen_m());
  if (!receiver.judged.empty() && fix.stamp <= receiver.judged.back().stamp) return "";  // a late one
  receiver.judged.push_back(fix);
  receiver.reckoned.push_back(antenna);
  if (receiver.judged.size() > kJudged) {
    receiver.judged.pop_front();
    receiver.reckoned.pop_front();
  }
  std::vector<Fix> fixes(receiver.judged.begin(), receiver.judged.end());
  for (Fix& one : fixes) one.source = 0;
  const std::vector<Eigen::Vector3d> reckoned(receiver.reckoned.begin(), receiver.reckoned.end());
  (void)drive::apply_gate(fixes, reckoned, gate);
  return fixes.back().status == FixStatus::rejected ? fixes.back().reason : "";
}

bool FixJudge::is_absurd(const Eigen::Vector2d& off, const Fix& fix, const Window& window) const {
  constexpr double kUnmodelled = 5;  // m: slow errors of a receiver
  const Eigen::Matrix2d spread = window.covariance().topLeftCorner<2, 2>() + 4 * fix.covariance +
                                 kUnmodelled * kUnmodelled * Eigen::Matrix2d::Identity();
  return off.dot(spread.inverse() * off) > live_.absurd;
}

/// Tells whether the fixes of a receiver have left a place that they agreed on with the estimate, by more than
/// dead reckoning from there explains, and not come back. Before and after, slow errors are the same in the frame,
/// and delays in the axes of the vehicle.
bool FixJudge::has_jumped(const Residual& residual, int source, const Window& window) const {
  constexpr double kSmallest_m = 15;
  constexpr double kSigmas = 5;
  constexpr double kMost = 0.75;
  constexpr double kBack = 0.5;
  constexpr double kKnown = 3;  // deviations of the estimate
  const auto known = receivers_.find(source);
  if (known == receivers_.end()) return false;
  const Receiver& receiver = known->second;
  const std::deque<Residual>& agreed = receiver.agreed;
  if (agreed.size() < 3 || residual.stamp <= agreed.back().stamp) return false;
  const auto [step_m, near] =
      std::min(step_from(agreed, residual.off, [](const Residual& of) { return of.off; }),
               step_from(agreed, residual.body, [](const Residual& of) { return of.body; }));
  const double least_m =
      std::max(kSmallest_m, kSigmas * std::max(residual.accuracy_m, agreed.back().accuracy_m));
  const double open_m = std::sqrt(window.covariance().topLeftCorner<2, 2>().trace());
  if (step_m < (receiver.left ? kBack * least_m : least_m)) return false;
  // The same step as at first is no drift of the dead reckoning.
  const bool is_same = receiver.left && (residual.off - receiver.left->off).norm() <= kQuarter * step_m;
  if (step_m < kKnown * open_m && !is_same) return false;
  return receiver.left || (seconds_between(agreed.back().stamp, residual.stamp) <= kNextFix_s &&
                           seconds_between(agreed.front().stamp, agreed.back().stamp) >= kSettled_s &&
                           static_cast<double>(near) >= kMost * static_cast<double>(agreed.size()));
}

/// Fixes that leave an estimate at once, with which they agreed for long, are wrong more often than it is. Fixes
/// that leave it more and more are those of another motion: the odometry is wrong.
void FixJudge::doubt(const Fix& fix, bool at_once) {
  constexpr double kHalf = 0.5;
  constexpr double kLongest_s = 60;
  constexpr double kDrift_mps = 1;  // of dead reckoning
  Receiver& receiver = receivers_[fix.source];
  if (receiver.left) {
    const double moved_m = (residual_->off - receiver.left->off).norm();
    const double since_s = seconds_between(receiver.left->stamp, fix.stamp);
    if (moved_m > kQuarter * receiver.left->off.norm() + kDrift_mps * since_s) receiver.doubted_s = 0;
    return;
  }
  receiver.left = residual_;
  receiver.doubted_s =
      at_once ? std::min(kLongest_s, kHalf * seconds_between(*receiver.agrees_since, fix.stamp)) : 0;
}

std::string FixJudge::reason_against(const Fix& fix, const Reckoning& reckoning, const Window* window) {
  residual_.reset();
  if (window != nullptr) {
    const Eigen::Vector2d off = fix.position - window->antenna_at(fix);
    residual_ = Residual{fix.stamp, off, rotate(-window->newest_pose()[2], off), fix.accuracy_m()};
  }
  if (repeats(fix, reckoning)) return "frozen";
  if (std::string reason = judged_by_gate(fix, reckoning); !reason.empty()) return reason;
  if (window == nullptr) return "";
  const bool jumped = has_jumped(*residual_, fix.source, *window);
  const std::string reason = is_absurd(residual_->off, fix, *window) ? "absurd" : jumped ? "jump" : "";
  if (!reason.empty()) doubt(fix, jumped);
  return reason;
}

ClaimedAccuracies FixJudge::accept(const Fix& fix) {
  for (auto& [source, other] : receivers_) other.elsewhere.clear();
  Receiver& receiver = receivers_[fix.source];
  receiver.left.reset();
  if (!receiver.agrees_since) receiver.agrees_since = fix.stamp;
  if (residual_ && (receiver.agreed.empty() || receiver.agreed.back().stamp < fix.stamp)) {
    receiver.agreed.push_back(*residual_);
    while (seconds_between(receiver.agreed.front().stamp, fix.stamp) > kAgreed_s) receiver.agreed.pop_front();
  }
  return receiver.claims.with(fix);
}

bool FixJudge::convinces(const Fix& fix, const Reckoning& reckoning) {
  Receiver& receiver = receivers_[fix.source];
  std::vector<Fix>& row = receiver.elsewhere;
  if (!row.empty()) {
    const Fix& before = row.back();
    const double way_m = (reckoning.at(fix.stamp).pose - reckoning.at(before.stamp).pose).head<2>().norm();
    const double step_m = (fix.position - before.position).norm();
    const double allowed_m = 10 + 3 * (fix.accuracy_m() + before.accuracy_m());
    if (std::abs(step_m - way_m) > allowed_m || fix.stamp <= before.stamp) row.clear();
  }
  row.push_back(fix);
  return row.size() >= static_cast<std::size_t>(live_.fixes_that_convince) &&
         seconds_between(row.front().stamp, fix.stamp) >= receiver.doubted_s;
}

void FixJudge::clear() {
  for (auto& [source, receiver] : receivers_) receiver = {.claims = std::move(receiver.claims)};
}

void FixJudge::forget_elsewhere() {
  for (auto& [source, receiver] : receivers_) {
    receiver.elsewhere.clear();
    receiver.agreed.clear();
    receiver.agrees_since.reset();
    receiver.left.reset();
  }
}

std::vector<Fix> FixJudge::take_believed(int source) {
  return std::exchange(receivers_[source].elsewhere, {});
}

}  // namespace waymark::live
