// What each of several odometries measured, between the nodes of the drive.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <set>

#include <waymark/tools/drive/logs/prepare_steps.hpp>
#include <waymark/tools/drive/model/motion_runs.hpp>

namespace motion_runs_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

double speed_at(double t) {
  return 5 + 0.1 * t;
}
double yaw_rate_at(double t) {
  return 0.02 - 0.001 * t;
}

/// Samples at a rate, without those that are silent.
PreparedOdometry source_of(
    const std::string& name, double rate_hz, double first_s, double last_s, double gap_s,
    const std::function<bool(double)>& silent = [](double) { return false; }) {
  PreparedOdometry source{.name = name, .samples = {}, .gap_s = gap_s};
  for (int i = 0;; ++i) {
    const double t = first_s + i / rate_hz;
    if (t > last_s + 1e-9) return source;
    if (!silent(t)) source.samples.push_back({Stamp::from_seconds(t), speed_at(t), yaw_rate_at(t)});
  }
}

Timeline nodes_of(const std::vector<PreparedOdometry>& relative, double gap_s) {
  std::size_t added = 0;
  return build_timeline(covered_by_all(relative, added), {}, {.gap_s = gap_s});
}

struct Sum {
  double distance_m = 0;
  double turn_rad = 0;
};

Sum sum_of(const MotionRun& run) {
  Sum sum;
  for (const Interval& interval : run.intervals) {
    sum.distance_m += interval.dt_s * interval.speed_mps;
    sum.turn_rad += interval.dt_s * interval.yaw_rate_radps;
  }
  return sum;
}

/// The samples lie on straight lines, which the means keep.
void check_integral(const MotionRun& run, const Timeline& timeline) {
  REQUIRE(run.intervals.size() + 1 == run.nodes.size());
  const double from = timeline.stamps[run.nodes.front()].seconds();
  const double to = timeline.stamps[run.nodes.back()].seconds();
  CHECK(sum_of(run).distance_m == Approx((to - from) * speed_at(0.5 * (from + to))));
  CHECK(sum_of(run).turn_rad == Approx((to - from) * yaw_rate_at(0.5 * (from + to))));
}

void check_every_pair_is_joined(const std::vector<MotionRun>& runs, const Timeline& timeline) {
  std::set<std::size_t> joined;
  for (const MotionRun& run : runs)
    for (std::size_t i = 1; i < run.nodes.size(); ++i)
      if (run.nodes[i] == run.nodes[i - 1] + 1) joined.insert(run.nodes[i - 1]);
  CHECK(joined.size() == timeline.intervals.size());
}

}  // namespace

TEST_CASE("motion runs: the first source joins all nodes, a sparse one those nearest to its samples") {
  const std::vector<PreparedOdometry> relative = {source_of("wheels", 10, 0, 60, 0.5),
                                                  source_of("visual", 1, 3.03, 50.03, 4)};
  const Timeline timeline = nodes_of(relative, 4);
  REQUIRE(timeline.stamps.size() == 601);
  const std::vector<MotionRun> runs = motion_runs(timeline, relative, {});
  REQUIRE(runs.size() == 2);
  CHECK(runs[0].source == 0);
  CHECK(runs[0].nodes.size() == 601);
  check_integral(runs[0], timeline);
  CHECK(runs[1].source == 1);
  // The nodes are those at 3.1, 4, 5, ... 50 s: 3 s is before its first sample.
  REQUIRE(runs[1].nodes.size() == relative[1].samples.size());
  CHECK(runs[1].nodes[0] == 31);
  for (std::size_t i = 1; i < runs[1].nodes.size(); ++i) CHECK(runs[1].nodes[i] == 30 + 10 * i);
  check_integral(runs[1], timeline);
  check_every_pair_is_joined(runs, timeline);
}

TEST_CASE("motion runs: a source that is as dense as the first one joins as many nodes, each once") {
  const std::vector<PreparedOdometry> relative = {source_of("wheels", 10, 0, 30, 0.5),
                                                  source_of("visual", 10, 0.04, 29.94, 0.5)};
  const Timeline timeline = nodes_of(relative, 0.5);
  const std::vector<MotionRun> runs = motion_runs(timeline, relative, {});
  REQUIRE(runs.size() == 2);
  CHECK(runs[1].nodes.size() == 299);  // at 0.1, 0.2, ... 29.9 s
  check_integral(runs[1], timeline);
}

TEST_CASE("motion runs: where the first source is silent, another one joins all nodes") {
  const auto silent = [](double t) { return t > 20.05 && t < 39.95; };
  const std::vector<PreparedOdometry> relative = {source_of("wheels", 10, 0, 60, 0.5, silent),
                                                  source_of("visual", 5, 0.03, 59.83, 0.8)};
  const Timeline timeline = nodes_of(relative, 0.8);
  const std::vector<MotionRun> runs = motion_runs(timeline, relative, {});
  check_every_pair_is_joined(runs, timeline);
  std::size_t runs_of_visual = 0;
  for (const MotionRun& run : runs) {
    check_integral(run, timeline);
    runs_of_visual += run.source;
    if (run.source == 0) {
      CHECK((timeline.stamps[run.nodes.back()].seconds() < 20.05 ||
             timeline.stamps[run.nodes.front()].seconds() > 39.95));
    }
  }
  CHECK(runs_of_visual == 1);
  for (const Interval& interval : timeline.intervals) CHECK_FALSE(interval.bridged);
}

TEST_CASE("motion runs: if every source is silent, the first one has the bridged interval") {
  const auto silent = [](double t) { return t > 20.05 && t < 29.95; };
  const std::vector<PreparedOdometry> relative = {source_of("wheels", 10, 0, 60, 0.5, silent),
                                                  source_of("visual", 5, 0.2, 59.8, 0.8, silent)};
  const Timeline timeline = nodes_of(relative, 0.8);
  const std::vector<MotionRun> runs = motion_runs(timeline, relative, {});
  check_every_pair_is_joined(runs, timeline);
  std::vector<Interval> bridged;
  for (const MotionRun& run : runs)
    for (const Interval& interval : run.intervals)
      if (interval.bridged) {
        CHECK(run.source == 0);
        bridged.push_back(interval);
      }
  REQUIRE(bridged.size() == 1);
  CHECK(bridged[0].dt_s == Approx(10));
  CHECK(bridged[0].gap_s == Approx(10));
}

TEST_CASE("motion runs: a silence of all that is usual for a slow source is bridged like any other") {
  // The visual source reads once in a second, so it is silent only after 4 s. It measures nothing from 10 s on.
  const auto silent = [](double t) { return t > 20.05 && t < 22.95; };
  const std::vector<PreparedOdometry> relative = {source_of("wheels", 10, 0, 60, 0.5, silent),
                                                  source_of("visual", 1, 0, 10, 4)};
  const Timeline timeline = nodes_of(relative, 4);
  const std::vector<MotionRun> runs = motion_runs(timeline, relative, {});
  check_every_pair_is_joined(runs, timeline);
  double bridged_s = 0;
  for (const MotionRun& run : runs)
    for (const Interval& interval : run.intervals)
      if (interval.bridged) {
        bridged_s += interval.dt_s;
        CHECK(interval.gap_s == Approx(3));
      }
  CHECK(bridged_s == Approx(3));
}

}  // namespace motion_runs_test
