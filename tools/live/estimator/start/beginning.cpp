// How a window begins: from a former run, or along the first fixes.
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/live/estimator/estimator.hpp>
#include <waymark/tools/live/estimator/window/window_setup.hpp>
#include <waymark/tools/live/learning/claims_ahead.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>

namespace waymark::live {
namespace {

constexpr double kRoughStart_s = 30;  // positions of single epochs are wrong alike for many seconds

}  // namespace

// Rough places are a start, and no measurements.
void Estimator::begin_window(PlacedStretch stretch, std::optional<drive::FirstPose> first_pose) {
  if (!rough_.any()) stretch.fixes.assign(fixes_.begin(), fixes_.end());
  FusionSetup setup = noise_.parameters.empty()
                          ? with_first_claims(setup_, stated_, description_,
                                              std::vector<Fix>(fixes_.begin(), fixes_.end()), registry_)
                          : setup_;
  setup.settings =
      with_noise_of_readings(std::move(setup.settings), stated_, description_, so_far_, registry_);
  std::unique_ptr<Window> window =
      make_window(description_, setup, *frame_, std::move(first_pose), registry_);
  for (const SensorReading& reading : readings_)
    if (reading.stamp >= stretch.stamps.front())
      window->add_reading(reading.sensor, reading.stamp, reading.values);
  if (!window->begin(stretch)) {
    says_.fail(now_, "the first fixes and the odometry have no common minimum");
    return;
  }
  if (warm_ && !warm_->states.empty()) {
    window->add_known(warm_->states);
    if (!window->solve()) return;
  }
  warm_.reset();
  window_ = std::move(window);
  fixes_.clear();
  readings_.clear();
  smooth_ = window_->newest_pose();
  last_cycle_ = now_;
  ++says_.counts.solutions;
  publish(true);
  drop();
}

// A pose of a former run holds if the vehicle has not been moved since: the first fix decides.
void Estimator::align_warm() {
  if (const std::optional<double> away_m = moved_since(*warm_, fixes_.front(), live_)) {
    say("moved", "",
        fmt::format("the vehicle is {:.1f} m from where the former run ended: its pose is not used",
                    *away_m));
    warm_->pose.reset();
    return;
  }
  begin_window(placed_at(*warm_->pose, reckoning_), first_pose_of(*warm_));
}

void Estimator::align() {
  if (reckoning_.nodes().size() < 2 || fixes_.empty()) return;
  if (warm_ && warm_->pose) {
    align_warm();
    if (window_ || (warm_ && warm_->pose)) return;
  }
  if (rough_.any() && seconds_between(fixes_.front().stamp, now_) < kRoughStart_s) return;
  if (heading_is_known(fixes_, reckoning_, live_))
    begin_window(laid_along(fixes_, reckoning_, setup_.settings), std::nullopt);
}

}  // namespace waymark::live
