#include <waymark/tools/drive/nodes/start.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/nodes/start_alignment.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

using namespace start_detail;

constexpr double kMinChord = 10;       // m, of the first chord for dead reckoning
constexpr double kMinCourseSpeed = 1;  // m/s: at lower speeds a course is noise
// m, like that of a window: a single alignment is trusted above it
constexpr double kMinWholeSpread = 15;
constexpr double kAnySpread = 1;  // m, below it fixes contain no information about the heading
// s between windows, as long as the bias may be degrees per second
constexpr double kCoarsePairs = 30;
constexpr double kFinePairs = 120;         // s
constexpr double kTranslationHalf = 15.5;  // s of moving time on either side of the median
constexpr double kTranslationStep = 1;     // s between evaluations

std::string text(const char* format, double value) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

Eigen::Vector2d antenna_at(const Eigen::Vector3d& pose, const Eigen::Vector2d& antenna_m) {
  return pose.head<2>() + rotate(pose[2], antenna_m);
}

void wrap_headings(std::vector<Eigen::Vector3d>& poses) {
  for (Eigen::Vector3d& pose : poses) pose[2] = wrap_angle(pose[2]);
}

void require_fix(const Timeline& timeline, std::span<const Fix> fixes) {
  if (timeline.fix_node.size() != fixes.size())
    throw UsageError("start: the timeline was built for other fixes");
  for (const Fix& fix : fixes)
    if (fix.status == FixStatus::accepted) return;
  throw InputError("no fix is accepted, so the drive has no position");
}

/// Returns the heading of the body for the course of a fix, if the vehicle moves fast enough for a
/// meaningful course.
std::optional<double> heading_from_course(const Timeline& timeline, const Fix& fix, std::size_t node) {
  if (!fix.heading_rad || timeline.intervals.empty()) return std::nullopt;
  const double speed = timeline.intervals[std::min(node, timeline.intervals.size() - 1)].speed_mps;
  if (std::abs(speed) < kMinCourseSpeed) return std::nullopt;
  return *fix.heading_rad + (speed < 0 ? std::numbers::pi : 0);
}

/// Returns the rotation of the dead reckoning that aligns the first chord of at least kMinChord
/// with its fixes; the longest chord if none is that long.
double rotation_from_chord(const Timeline& timeline, std::span<const Fix> fixes, std::size_t first,
                           std::span<const Eigen::Vector3d> poses, std::string& note) {
  Eigen::Vector2d odometry = Eigen::Vector2d::Zero();
  Eigen::Vector2d gnss = Eigen::Vector2d::Zero();
  const Eigen::Vector2d origin = antenna_at(poses[timeline.fix_node[first]], fixes[first].antenna_m);
  for (std::size_t i = first + 1; i < fixes.size() && odometry.norm() < kMinChord; ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    const Eigen::Vector2d chord = antenna_at(poses[timeline.fix_node[i]], fixes[i].antenna_m) - origin;
    if (chord.norm() <= odometry.norm()) continue;
    odometry = chord;
    gnss = fixes[i].position - fixes[first].position;
  }
  if (odometry.norm() < kMinChord)
    note =
        text("the longest chord from the first fix is %.1f m: the first heading is a guess", odometry.norm());
  return std::atan2(gnss[1], gnss[0]) - std::atan2(odometry[1], odometry[0]);
}

/// Returns headings of the odometry, with a bias subtracted while moving.
std::vector<double> odometry_headings(const Timeline& timeline, double bias, double standstill_mps) {
  std::vector<double> headings{0};
  headings.reserve(timeline.stamps.size());
  for (const Interval& interval : timeline.intervals) {
    const bool moves = !interval.stands(standstill_mps);
    headings.push_back(headings.back() + (moves ? (interval.yaw_rate_radps - bias) * interval.dt_s : 0));
  }
  return headings;
}

/// The data that all steps of the anchored start share.
struct Drive {
  const Timeline& timeline;
  std::span<const Fix> fixes;
  double standstill_mps;
  std::vector<double> moving_s;
  std::vector<Anchor> anchors;
};

std::vector<HeadingWindow> windows_along(const Drive& drive, std::span<const double> headings,
                                         const Windows& how = {}) {
  const auto poses = integrate_along(drive.timeline, headings, drive.standstill_mps);
  return align_windows(drive.anchors, poses, how);
}

/// Estimates the gyro bias: first the reading at standstill, then twice the remaining slope of the
/// heading offset.
double estimate_bias(const Drive& drive) {
  double bias = standstill_bias(drive.timeline, drive.standstill_mps).value_or(0);
  for (const double apart : {kCoarsePairs, kFinePairs}) {
    const auto windows = windows_along(drive, odometry_headings(drive.timeline, bias, drive.standstill_mps));
    bias -= median_slope(windows, apart);
  }
  return bias;
}

void add(std::vector<double>& values, std::span<const double> more) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += more[i];
}

/// Bends the headings by the smoothed offsets of the windows. Returns the number of windows.
std::size_t bend(const Drive& drive, const Windows& how, std::vector<double>& headings) {
  std::size_t count = 0;
  for (int pass = 0; pass < how.bends; ++pass) {
    auto windows = windows_along(drive, headings, how);
    if (windows.empty()) break;
    unwrap_offsets(windows, how);
    add(headings, evaluate(smooth_offsets(windows, how), drive.moving_s));
    count = windows.size();
  }
  return count;
}

std::optional<double> offset_from_courses(const Drive& drive, std::span<const double> headings) {
  std::vector<std::pair<double, double>> offsets;
  std::optional<double> first;
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    if (drive.fixes[i].status != FixStatus::accepted) continue;
    const std::size_t node = drive.timeline.fix_node[i];
    const auto heading = heading_from_course(drive.timeline, drive.fixes[i], node);
    if (!heading) continue;
    const double offset = *heading - headings[node];
    if (!first) first = offset;
    offsets.emplace_back(*first + wrap_angle(offset - *first), 1.0);
  }
  if (!first) return std::nullopt;
  return weighted_median(offsets);
}

/// Applies one offset to the whole drive, if no window could be aligned. Returns the note about it.
std::string turn_as_a_whole(const Drive& drive, std::vector<double>& headings) {
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  const auto poses = integrate_along(drive.timeline, headings, drive.standstill_mps);
  for (const Anchor& anchor : drive.anchors) {
    from.push_back(antenna_at(poses[anchor.node], anchor.antenna_m));
    to.push_back(anchor.gnss);
  }
  const auto whole = align_robustly(from, to);
  const auto courses = offset_from_courses(drive, headings);
  double offset = 0;
  std::string note;
  if (whole && whole->spread_m >= kMinWholeSpread) {
    offset = whole->rotation_rad;
    note = "too few fixes for windows: the first heading comes from one alignment of the whole drive";
  } else if (courses) {
    offset = *courses;
    note =
        "too little motion between fixes for an alignment: the first heading comes from the receiver's "
        "course";
  } else if (whole && whole->spread_m >= kAnySpread) {
    offset = whole->rotation_rad;
    note =
        text("the fixes spread over only %.1f m of the way: the first heading is a guess", whole->spread_m);
  } else {
    note =
        "the fixes do not determine the heading (no motion between them): its initial guess is 0, grid east";
  }
  for (double& heading : headings) heading += offset;
  return note;
}

/// Returns knots of one coordinate of the median distance from the bent dead reckoning to the
/// anchors around.
Knots translation(const Drive& drive, std::span<const Eigen::Vector3d> poses, int axis) {
  Knots knots;
  const auto& anchors = drive.anchors;
  std::size_t first = 0;
  std::size_t last = 0;
  for (const Anchor& anchor : anchors) {
    const bool ends = &anchor == &anchors.back();
    if (!ends && !knots.at.empty() && anchor.moving_s - knots.at.back() < kTranslationStep) continue;
    while (anchors[first].moving_s < anchor.moving_s - kTranslationHalf) ++first;
    while (last < anchors.size() && anchors[last].moving_s <= anchor.moving_s + kTranslationHalf) ++last;
    std::vector<double> near;
    for (std::size_t i = first; i < last; ++i)
      near.push_back(anchors[i].gnss[axis] - antenna_at(poses[anchors[i].node], anchors[i].antenna_m)[axis]);
    knots.at.push_back(anchor.moving_s);
    knots.value.push_back(upper_median(near));
  }
  return knots;
}

/// Returns poses along the odometry, bent onto the anchors.
Start bent_start(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps,
                 const Windows& how) {
  require_fix(timeline, fixes);
  Drive drive{timeline, fixes, standstill_mps, moving_time(timeline, standstill_mps), {}};
  drive.anchors = collect_anchors(timeline, fixes, drive.moving_s);

  Start start;
  start.gyro_bias_radps = estimate_bias(drive);
  std::vector<double> headings = odometry_headings(timeline, start.gyro_bias_radps, standstill_mps);
  start.windows = bend(drive, how, headings);
  if (start.windows == 0) start.note = turn_as_a_whole(drive, headings);

  start.poses = integrate_along(timeline, headings, standstill_mps);
  const auto dx = evaluate(translation(drive, start.poses, 0), drive.moving_s);
  const auto dy = evaluate(translation(drive, start.poses, 1), drive.moving_s);
  for (std::size_t i = 0; i < start.poses.size(); ++i) {
    start.poses[i][0] += dx[i];
    start.poses[i][1] += dy[i];
  }
  wrap_headings(start.poses);
  return start;
}

void turn_about_first(double first_heading_rad, std::vector<Eigen::Vector3d>& poses) {
  const Eigen::Vector3d first = poses.front();
  const double turn = first_heading_rad - first[2];
  for (Eigen::Vector3d& pose : poses) {
    const Eigen::Vector2d place = first.head<2>() + rotate(turn, Eigen::Vector2d((pose - first).head<2>()));
    pose = {place[0], place[1], wrap_angle(pose[2] + turn)};
  }
}

}  // namespace

Start dead_reckoning_start(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps) {
  require_fix(timeline, fixes);
  std::size_t first = 0;
  while (fixes[first].status != FixStatus::accepted) ++first;
  Start start;
  start.poses = dead_reckon(timeline, Eigen::Vector3d::Zero(), standstill_mps);
  const std::size_t node = timeline.fix_node[first];
  const Eigen::Vector3d anchor = start.poses[node];
  const auto course = heading_from_course(timeline, fixes[first], node);
  const double rotation =
      course ? *course - anchor[2] : rotation_from_chord(timeline, fixes, first, start.poses, start.note);
  const Eigen::Vector2d shift =
      fixes[first].position - rotate(rotation, antenna_at(anchor, fixes[first].antenna_m));
  for (Eigen::Vector3d& pose : start.poses) {
    const Eigen::Vector2d turned = rotate(rotation, Eigen::Vector2d(pose.head<2>()));
    pose << turned + shift, pose[2] + rotation;
  }
  wrap_headings(start.poses);
  return start;
}

Start anchored_start(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps) {
  return bent_start(timeline, fixes, standstill_mps, {});
}

Start start_along_fixes(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps) {
  constexpr Windows kClose = {
      .length_s = 8, .step_s = 2, .least_spread_m = 2, .before = 1, .beside = 0, .bends = 3};
  Start start = bent_start(timeline, fixes, standstill_mps, kClose);
  start.follows_fixes = true;
  return start;
}

Start make_start(const Timeline& timeline, std::span<const Fix> fixes, double standstill_mps,
                 const StartOptions& options) {
  Start start = options.method == StartMethod::anchored
                    ? anchored_start(timeline, fixes, standstill_mps)
                    : dead_reckoning_start(timeline, fixes, standstill_mps);
  if (options.first_heading_rad) turn_about_first(*options.first_heading_rad, start.poses);
  return start;
}

}  // namespace waymark::drive
