#include <waymark/tools/live/estimator/guards/receiver_comparison.hpp>

#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr double kKept_s = 600;
constexpr double kPeriod_s = 60;
constexpr double kThinned_s = 0.9;

}  // namespace

void ReceiverComparison::take(const Fix& fix, const Eigen::Vector3d& reckoned, double turn) {
  const auto [newest, is_new] = newest_.try_emplace(fix.source, fix.stamp);
  if (!is_new && seconds_between(newest->second, fix.stamp) < kThinned_s) return;
  newest->second = fix.stamp;
  if (fixes_.empty()) judged_ = fix.stamp;
  const Eigen::Vector2d before =
      poses_.empty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(poses_.back().head<2>());
  const Eigen::Vector2d way =
      poses_.empty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(reckoned.head<2>() - last_);
  const Eigen::Vector2d place = before + rotate(turn, way);
  fixes_.push_back(fix);
  poses_.emplace_back(place[0], place[1], wrap_angle(reckoned[2] + turn));
  last_ = reckoned.head<2>();
}

std::vector<drive::ConstantDifference> ReceiverComparison::news() {
  if (fixes_.empty() || seconds_between(judged_, fixes_.back().stamp) < kPeriod_s) return {};
  judged_ = fixes_.back().stamp;
  std::size_t old = 0;
  while (seconds_between(fixes_[old].stamp, judged_) > kKept_s) ++old;
  fixes_.erase(fixes_.begin(), fixes_.begin() + static_cast<std::ptrdiff_t>(old));
  poses_.erase(poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(old));
  std::vector<drive::ConstantDifference> found;
  for (const drive::ConstantDifference& difference : drive::compare_receivers(fixes_, poses_).differ)
    if (told_.emplace(difference.first, difference.second).second) found.push_back(difference);
  return found;
}

void ReceiverComparison::clear() {
  fixes_.clear();
  poses_.clear();
  newest_.clear();
}

}  // namespace waymark::live
