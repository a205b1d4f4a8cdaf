#include <waymark/tools/live/estimator/fix_judge.hpp>

#include <cmath>
#include <utility>

#include <Eigen/LU>

#include <waymark/tools/drive/nodes/gate.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr std::size_t kClaims = 300;
constexpr std::size_t kJudged = 20;

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
  antenna.head<2>() += rotate(antenna[2], fix.antenna_m);
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

bool FixJudge::is_absurd(const Fix& fix, const Window& window) const {
  constexpr double kUnmodelled = 5;  // m: slow errors of a receiver
  const Eigen::Vector2d off = fix.position - window.antenna_at(fix);
  const Eigen::Matrix2d spread = window.covariance().topLeftCorner<2, 2>() + 4 * fix.covariance +
                                 kUnmodelled * kUnmodelled * Eigen::Matrix2d::Identity();
  return off.dot(spread.inverse() * off) > live_.absurd;
}

std::string FixJudge::reason_against(const Fix& fix, const Reckoning& reckoning, const Window* window) {
  if (repeats(fix, reckoning)) return "frozen";
  if (std::string reason = judged_by_gate(fix, reckoning); !reason.empty()) return reason;
  return window != nullptr && is_absurd(fix, *window) ? "absurd" : "";
}

ClaimedAccuracies FixJudge::accept(const Fix& fix) {
  absurd_.clear();
  std::vector<Fix>& used = receivers_[fix.source].used;
  used.push_back(fix);
  if (used.size() > 2 * kClaims) used.erase(used.begin(), used.end() - kClaims);
  return claimed_accuracies(used);
}

bool FixJudge::convinces(const Fix& fix, const Reckoning& reckoning) {
  if (!absurd_.empty()) {
    const Fix& before = absurd_.back();
    const double way_m = (reckoning.at(fix.stamp).pose - reckoning.at(before.stamp).pose).head<2>().norm();
    const double step_m = (fix.position - before.position).norm();
    const double allowed_m = 10 + 3 * (fix.accuracy_m() + before.accuracy_m());
    if (std::abs(step_m - way_m) > allowed_m || fix.stamp <= before.stamp) absurd_.clear();
  }
  absurd_.push_back(fix);
  return absurd_.size() >= static_cast<std::size_t>(live_.fixes_that_convince);
}

std::vector<Fix> FixJudge::take_believed() {
  return std::exchange(absurd_, {});
}

}  // namespace waymark::live
