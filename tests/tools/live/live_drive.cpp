#include "live_drive.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

#include <Eigen/LU>

#include <waymark/core/drive/frame.hpp>

#include "support/registry.hpp"

namespace waymark_test {

using namespace waymark;
using namespace waymark::live;

LiveDrive live_drive(const std::string& preset, double duration_s, std::uint64_t seed) {
  simulation::SimulationRecipe recipe = simulation::simulation_preset(preset).recipe;
  recipe.duration_s = duration_s;
  LiveDrive drive{simulation::simulate(recipe, seed), {}};
  for (const OdometrySample& sample : drive.simulated.odometry) drive.arrivals.emplace_back(sample);
  for (const simulation::SimulatedFix& fix : drive.simulated.fixes) drive.arrivals.emplace_back(fix.fix);
  for (std::size_t i = 0; i < drive.simulated.further_gnss.size(); ++i) {
    for (const simulation::SimulatedFix& fix : drive.simulated.further_gnss[i].fixes) {
      drive.arrivals.emplace_back(fix.fix);
      std::get<GeodeticFix>(drive.arrivals.back()).source = static_cast<int>(i) + 1;
    }
  }
  std::stable_sort(drive.arrivals.begin(), drive.arrivals.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return drive;
}

drive::DriveDescription live_description(const std::vector<std::string>& receivers) {
  drive::DriveDescription description;
  description.odometry.resize(1);
  for (const std::string& name : receivers) {
    description.gnss.emplace_back();
    description.gnss.back().name = name;
  }
  return description;
}

drive::FusionSettings live_fusion(const std::string& modeling) {
  drive::FusionSettings settings;
  settings.modeling = modeling;
  return settings;
}

std::size_t Said::count(const std::string& kind) const {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [&](const Event& event) { return event.kind == kind; }));
}

std::string Said::text() const {
  std::ostringstream out;
  out << std::hexfloat;
  for (const LivePose& pose : poses)
    out << pose.stamp.nanoseconds << ' ' << pose.pose.transpose() << ' ' << pose.covariance << ' '
        << pose.smooth.transpose() << ' ' << to_string(pose.state) << ' ' << pose.resets << '\n';
  for (const SettledPose& pose : settled)
    out << pose.stamp.nanoseconds << ' ' << pose.pose.transpose() << '\n';
  for (const Event& event : events)
    out << event.stamp.nanoseconds << ' ' << event.kind << ' ' << event.source << ' ' << event.text << '\n';
  return out.str();
}

Said listen(const Arrivals& arrivals, const LiveSettings& settings, const std::string& modeling,
            const std::vector<std::string>& receivers) {
  return listen(live_description(receivers), arrivals, settings, modeling);
}

Said listen(const drive::DriveDescription& description, const Arrivals& arrivals,
            const LiveSettings& settings, const std::string& modeling) {
  return listen(description, arrivals, settings, live_fusion(modeling));
}

Said listen(const drive::DriveDescription& description, const Arrivals& arrivals,
            const LiveSettings& settings, const drive::FusionSettings& fusion) {
  Estimator estimator(description, fusion, settings, registry());
  return heard(estimator, arrivals);
}

Said heard(Estimator& estimator, const Arrivals& arrivals) {
  Said said;
  const auto hear = [&] {
    for (const Report& report : estimator.reports()) {
      if (const auto* pose = std::get_if<LivePose>(&report)) said.poses.push_back(*pose);
      if (const auto* settled = std::get_if<SettledPose>(&report)) said.settled.push_back(*settled);
      if (const auto* event = std::get_if<Event>(&report)) said.events.push_back(*event);
    }
  };
  for (const Sample& sample : arrivals) {
    estimator.take(sample);
    hear();
  }
  estimator.finish();
  hear();
  said.counts = estimator.counts();
  said.state = estimator.state();
  return said;
}

namespace {

/// Returns a pose minus the truth, m. The estimator chooses its frame as a drive does: the origin is the first
/// fix, rounded to 100 m. Empty outside of the truth.
std::optional<Eigen::Vector2d> off_truth(Stamp stamp, const Eigen::Vector3d& pose, const LiveDrive& drive) {
  const GeodeticFix& first = drive.simulated.fixes.front().fix;
  const Frame own =
      drive::choose_frame({first.latitude_deg, first.longitude_deg}, std::nullopt, std::nullopt);
  const Frame& frame = drive.simulated.frame;
  const std::vector<StampedPose>& truth = drive.simulated.poses;
  const auto after = std::lower_bound(truth.begin(), truth.end(), stamp,
                                      [](const StampedPose& of, Stamp moment) { return of.stamp < moment; });
  if (after == truth.begin() || after == truth.end()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const double share = seconds_between(before.stamp, stamp) / seconds_between(before.stamp, after->stamp);
  const Eigen::Vector3d then = (1 - share) * before.pose + share * after->pose;
  return Eigen::Vector2d(pose[0] + own.origin_easting_m - then[0] - frame.origin_easting_m,
                         pose[1] + own.origin_northing_m - then[1] - frame.origin_northing_m);
}

}  // namespace

double rms(std::span<const double> errors) {
  double squares = 0;
  for (const double error : errors) squares += error * error;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

std::vector<double> errors_m(const Said& said, const LiveDrive& drive) {
  std::vector<double> errors;
  for (const LivePose& pose : said.poses) {
    if (!pose.heading_known) continue;
    if (const auto off = off_truth(pose.stamp, pose.pose, drive)) errors.push_back(off->norm());
  }
  return errors;
}

std::vector<double> settled_errors_m(const Said& said, const LiveDrive& drive) {
  std::vector<double> errors;
  for (const SettledPose& pose : said.settled)
    if (const auto off = off_truth(pose.stamp, pose.pose, drive)) errors.push_back(off->norm());
  return errors;
}

double coverage95(const Said& said, const LiveDrive& drive) {
  std::size_t inside = 0;
  std::size_t all = 0;
  for (const LivePose& pose : said.poses) {
    const auto off = off_truth(pose.stamp, pose.pose, drive);
    if (!pose.heading_known || !off) continue;
    const Eigen::Matrix2d spread = pose.covariance.topLeftCorner<2, 2>();
    inside += off->dot(spread.inverse() * *off) < 5.991464547107979;
    ++all;
  }
  return all == 0 ? 0 : static_cast<double>(inside) / static_cast<double>(all);
}

}  // namespace waymark_test
