// Fixed-lag fusion of live samples: what users of such estimators complain of does not happen here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <catch2/catch.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace estimator_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

double largest(const std::vector<double>& errors) {
  return *std::max_element(errors.begin(), errors.end());
}

GeodeticFix& fix_of(Sample& sample) {
  return std::get<GeodeticFix>(sample);
}

bool is_fix(const Sample& sample) {
  return std::holds_alternative<GeodeticFix>(sample);
}

/// The place of the n-th fix among the arrivals.
std::size_t nth_fix(const Arrivals& arrivals, int n) {
  for (std::size_t i = 0; i < arrivals.size(); ++i)
    if (is_fix(arrivals[i]) && n-- == 0) return i;
  throw std::out_of_range("there are fewer fixes");
}

double seconds_of(const LiveDrive& drive, Stamp stamp) {
  return seconds_between(stamp_of(drive.arrivals.front()), stamp);
}

Arrivals without_fixes(const LiveDrive& drive, double from_s, double to_s) {
  Arrivals arrivals;
  for (const Sample& sample : drive.arrivals) {
    const double at_s = seconds_of(drive, stamp_of(sample));
    if (!is_fix(sample) || at_s < from_s || at_s > to_s) arrivals.push_back(sample);
  }
  return arrivals;
}

}  // namespace

TEST_CASE("a live estimate is near the truth, and its regions hold it", "[live]") {
  std::vector<double> raw;
  std::vector<double> live;
  std::vector<double> settled;
  double coverage = 0;
  constexpr int kDrives = 4;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const LiveDrive drive = live_drive("mixed", 300, seed);
    for (const simulation::SimulatedFix& fix : drive.simulated.fixes)
      raw.push_back(
          (drive.simulated.gnss_bias_m + fix.parts.fast + fix.parts.jitter + fix.parts.burst).norm());
    const Said said = listen(drive.arrivals);
    CHECK(said.counts.failures == 0);
    CHECK(said.counts.resets == 0);
    // One pose for each sample of the odometry from the alignment on; each leaves the window once.
    CHECK(10 * said.poses.size() > 9 * drive.simulated.odometry.size());
    CHECK(std::is_sorted(said.settled.begin(), said.settled.end(),
                         [](const SettledPose& a, const SettledPose& b) { return a.stamp < b.stamp; }));
    for (const double error : errors_m(said, drive)) live.push_back(error);
    for (const double error : settled_errors_m(said, drive)) settled.push_back(error);
    coverage += coverage95(said, drive) / kDrives;
  }
  // What is known at the moment, at 25 Hz, is about as good as the fixes; a minute later it is better.
  CHECK(rms(live) < 1.1 * rms(raw));
  CHECK(rms(settled) < 0.9 * rms(raw));
  CHECK(coverage > 0.9);
}

TEST_CASE("a receiver whose filter is stated is no longer beside the vehicle", "[live]") {
  // An alpha-beta filter stays behind by (1 - alpha) dt^2 / beta times the acceleration, a ReceiverFilter by T^2.
  constexpr double kBeta = 0.1;
  const double alpha = std::sqrt(2 * kBeta);
  LiveDrive drive = live_drive("urban", 300);
  Eigen::Vector2d place(0, 0);
  Eigen::Vector2d velocity(0, 0);
  for (Sample& sample : drive.arrivals) {
    if (!is_fix(sample)) continue;
    GeodeticFix& fix = fix_of(sample);
    const Eigen::Vector2d measured(fix.latitude_deg, fix.longitude_deg);
    const Eigen::Vector2d expected = place.isZero() ? measured : Eigen::Vector2d(place + velocity);
    place = expected + alpha * (measured - expected);
    velocity += kBeta * (measured - expected);
    fix.latitude_deg = place.x();
    fix.longitude_deg = place.y();
  }
  drive::DriveDescription description = live_description();
  const double without_m = rms(settled_errors_m(listen(description, drive.arrivals), drive));
  description.gnss.front().smoothing_s = std::sqrt((1 - alpha) / kBeta);
  CHECK(rms(settled_errors_m(listen(description, drive.arrivals), drive)) < 0.7 * without_m);
}

TEST_CASE("every modeling of a batch run is live too", "[live]") {
  const std::string modeling = GENERATE("correlated", "g1", "g2", "g3");
  CAPTURE(modeling);
  const LiveDrive drive = live_drive("rural", 120);
  const Said said = listen(drive.arrivals, {}, modeling);
  CHECK(said.counts.failures == 0);
  CHECK(said.counts.solutions > 60);
  CHECK(rms(errors_m(said, drive)) < 8);
}

TEST_CASE("three receivers that are silent at times: a pose all the time, better than two of them alone",
          "[live]") {
  const LiveDrive drive = live_drive("three-absolute", 600);
  REQUIRE(drive.simulated.further_gnss.size() == 2);
  Said said = listen(drive.arrivals, {}, "correlated", {"one", "two", "three"});
  CHECK(said.counts.failures == 0);
  CHECK(said.counts.resets == 0);

  for (const char* receiver : {"one", "two", "three"}) CHECK(said.counts.taken[receiver] > 100);
  std::size_t with_heading = 0;
  for (const LivePose& pose : said.poses) with_heading += pose.heading_known;
  CHECK(100 * with_heading > 95 * drive.simulated.odometry.size());
  // Their errors are 1.06, 1.23 and 0.28 m. Without an estimate of the noise nothing tells which is the best.
  CHECK(rms(errors_m(said, drive)) < 1.06);
}

TEST_CASE("the same arrivals give the same words, to the last bit", "[live]") {
  const LiveDrive drive = live_drive("urban", 90);
  CHECK(listen(drive.arrivals).text() == listen(drive.arrivals).text());
}

TEST_CASE("arrivals that are shuffled within the bound give the same words", "[live]") {
  const LiveDrive drive = live_drive("urban", 90);
  const LiveSettings settings{.reorder_s = 0.5};
  const Said sorted = listen(drive.arrivals, settings);
  // Each sample arrives up to 0.4 s after its stamp.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> late_s(0, 0.4);
  std::vector<std::pair<Stamp, std::size_t>> order;
  for (std::size_t i = 0; i < drive.arrivals.size(); ++i)
    order.emplace_back(stamp_of(drive.arrivals[i]).later(late_s(random)), i);
  std::sort(order.begin(), order.end());
  Arrivals shuffled;
  for (const auto& [arrival, i] : order) shuffled.push_back(drive.arrivals[i]);
  CHECK(listen(shuffled, settings).text() == sorted.text());
}

TEST_CASE("a late fix gives the states that it would have given in time", "[live]") {
  const double late_s = GENERATE(0.1, 1.5, 10.0, 30.0);
  CAPTURE(late_s);
  const LiveDrive drive = live_drive("rural", 100);
  Arrivals late = drive.arrivals;
  const std::size_t place = nth_fix(late, 50);
  const Sample fix = late[place];
  late.erase(late.begin() + static_cast<std::ptrdiff_t>(place));
  const auto arrival = std::find_if(late.begin(), late.end(), [&](const Sample& sample) {
    return stamp_of(sample) > stamp_of(fix).later(late_s);
  });
  late.insert(arrival, fix);
  const Said in_time = listen(drive.arrivals);
  const Said after = listen(late);
  CHECK(after.counts.refused.empty());
  CHECK(after.counts.late_fixes == (late_s > 1 ? 1 : 0));
  const LivePose& one = in_time.poses.back();
  const LivePose& other = after.poses.back();
  CHECK((one.pose - other.pose).norm() < 5e-3);
  CHECK((one.covariance - other.covariance).norm() < 1e-3 * one.covariance.norm());
}

TEST_CASE("a fix that is older than the window is counted and told", "[live]") {
  const LiveDrive drive = live_drive("rural", 120);
  Arrivals late = drive.arrivals;
  const std::size_t place = nth_fix(late, 10);
  const Sample fix = late[place];
  late.erase(late.begin() + static_cast<std::ptrdiff_t>(place));
  late.push_back(fix);
  const Said said = listen(late, {.window_s = 30});
  CHECK(said.counts.refused.at("gnss: late") == 1);
  CHECK(said.count("late") == 1);
  CHECK(said.counts.resets == 0);
}

TEST_CASE("one bad sample does not end the tracking, and its reason is told", "[live]") {
  const LiveDrive drive = live_drive("rural", 100);
  Arrivals arrivals = drive.arrivals;
  const std::string kind = GENERATE("far", "nan", "future", "past", "twice", "odometry");
  CAPTURE(kind);
  const std::size_t place = nth_fix(arrivals, 60);
  const auto at = arrivals.begin() + static_cast<std::ptrdiff_t>(place);
  std::string reason;
  if (kind == "far") {
    fix_of(arrivals[place]).latitude_deg += 0.009;  // 1 km
    reason = "gnss: absurd";
  } else if (kind == "nan") {
    fix_of(arrivals[place]).latitude_deg = std::numeric_limits<double>::quiet_NaN();
    reason = "gnss: not_finite";
  } else if (kind == "future") {
    fix_of(arrivals[place]).stamp = fix_of(arrivals[place]).stamp.later(3600);
    reason = "gnss: future";
  } else if (kind == "past") {
    fix_of(arrivals[place]).stamp = fix_of(arrivals[place]).stamp.later(-3600);
    reason = "gnss: late";
  } else if (kind == "twice") {
    const Sample copy = arrivals[place];
    arrivals.insert(at, copy);
    reason = "gnss: duplicate";
  } else {
    OdometrySample wrong;
    wrong.stamp = stamp_of(arrivals[place]);
    wrong.speed_mps = std::numeric_limits<double>::infinity();
    arrivals.insert(at, wrong);
    reason = "odometry: not_finite";
  }
  const Said said = listen(arrivals);
  CHECK(said.counts.refused.at(reason) == 1);
  CHECK(said.count(reason.substr(reason.find(' ') + 1)) >= 1);
  CHECK(said.counts.resets == 0);
  CHECK(said.counts.failures == 0);
  CHECK(said.state == State::tracking);
  CHECK(largest(errors_m(said, drive)) < 25);
}

TEST_CASE("one odometry stamp in the future moves nothing", "[live]") {
  const LiveDrive drive = live_drive("rural", 60);
  Arrivals arrivals = drive.arrivals;
  OdometrySample wrong;
  wrong.stamp = stamp_of(arrivals[900]).later(3600);
  arrivals.insert(arrivals.begin() + 900, wrong);
  const Said said = listen(arrivals);
  CHECK(said.counts.resets == 0);
  CHECK(said.text() == listen(drive.arrivals).text());
}

TEST_CASE("a clock that jumps, back or forth, begins anew once", "[live]") {
  const double jump_s = GENERATE(-3000.0, 3000.0);
  const LiveDrive drive = live_drive("rural", 80);
  Arrivals arrivals = drive.arrivals;
  for (std::size_t i = arrivals.size() / 2; i < arrivals.size(); ++i)
    std::visit([&](auto& sample) { sample.stamp = sample.stamp.later(jump_s); }, arrivals[i]);
  const Said said = listen(arrivals);
  CHECK(said.counts.resets == 1);
  CHECK(said.count("jump") == 1);
  CHECK(said.state == State::tracking);
}

TEST_CASE("no heading is claimed before the vehicle has moved", "[live]") {
  LiveDrive drive = live_drive("rural", 60);
  // A minute at rest before the drive.
  const Stamp begin = stamp_of(drive.arrivals.front());
  const GeodeticFix first = drive.simulated.fixes.front().fix;
  Arrivals arrivals;
  for (int i = 0; i < 1500; ++i) {
    OdometrySample rest;
    rest.stamp = begin.later(-60 + 0.04 * i);
    arrivals.emplace_back(rest);
    if (i % 25 == 0) {
      GeodeticFix fix = first;
      fix.stamp = rest.stamp.later(0.01);
      fix.latitude_deg += 1e-5 * std::sin(i);
      arrivals.emplace_back(fix);
    }
  }
  arrivals.insert(arrivals.end(), drive.arrivals.begin(), drive.arrivals.end());
  const Said said = listen(arrivals);
  std::size_t places = 0;
  for (const LivePose& pose : said.poses) {
    if (pose.stamp >= begin) continue;
    CHECK_FALSE(pose.heading_known);
    CHECK((pose.state == State::aligning || pose.state == State::waiting));
    CHECK(pose.covariance(2, 2) > 3);  // rad^2: any heading
    ++places;
  }
  CHECK(places > 50);  // but the place is told
  CHECK(said.poses.back().heading_known);
  CHECK(said.state == State::tracking);
}

TEST_CASE("without fixes the region grows as the error, and the return needs few fixes", "[live]") {
  const double outage_s = GENERATE(30.0, 120.0, 400.0);
  CAPTURE(outage_s);
  const LiveDrive drive = live_drive("rural", 120 + outage_s + 60, 5);
  const Said said = listen(without_fixes(drive, 120, 120 + outage_s));
  CHECK(said.counts.resets == 0);
  std::vector<double> before;
  std::vector<double> back;
  const std::vector<double> errors = errors_m(said, drive);
  std::vector<const LivePose*> poses;
  for (const LivePose& pose : said.poses)
    if (pose.heading_known) poses.push_back(&pose);
  const LivePose* last_blind = nullptr;
  for (const LivePose* pose : poses) {
    const double at_s = seconds_of(drive, pose->stamp);
    if (at_s > 123 && at_s < 119 + outage_s) {
      CHECK((pose->state == State::dead_reckoning || pose->state == State::degraded));
      last_blind = pose;
    }
  }
  REQUIRE(last_blind != nullptr);
  for (std::size_t i = 0; i < std::min(errors.size(), poses.size()); ++i) {
    const double at_s = seconds_of(drive, poses[i]->stamp);
    if (at_s > 60 && at_s < 120) before.push_back(errors[i]);
    if (at_s > 120 + outage_s + 5) back.push_back(errors[i]);
  }
  REQUIRE(!before.empty());
  REQUIRE(!back.empty());
  // Five seconds after the return it is where it would be.
  CHECK(rms(back) < 12);
  CHECK(last_blind->radius95_m > 1.05 * poses[poses.size() / 8]->radius95_m);
}

TEST_CASE("nothing, one sample, one stream alone: no crash, and a state", "[live]") {
  const LiveDrive drive = live_drive("rural", 40);
  CHECK(listen({}).state == State::waiting);
  CHECK(listen({drive.arrivals.front()}).state == State::waiting);
  Arrivals odometry;
  Arrivals fixes;
  for (const Sample& sample : drive.arrivals) (is_fix(sample) ? fixes : odometry).push_back(sample);
  const Said blind = listen(odometry);
  CHECK(blind.state == State::waiting);
  CHECK(blind.poses.empty());
  const Said still = listen(fixes);
  CHECK(still.state == State::waiting);
  // Places without odometry are still places.
  CHECK(still.poses.size() == fixes.size());
}

TEST_CASE("odometry that dies is told, and comes back", "[live]") {
  const LiveDrive drive = live_drive("rural", 100);
  const double silence_s = GENERATE(5.0, 20.0);
  CAPTURE(silence_s);
  Arrivals arrivals;
  for (const Sample& sample : drive.arrivals) {
    const double at_s = seconds_of(drive, stamp_of(sample));
    if (is_fix(sample) || at_s < 50 || at_s > 50 + silence_s) arrivals.push_back(sample);
  }
  const Said said = listen(arrivals);
  CHECK(std::any_of(said.events.begin(), said.events.end(), [](const Event& event) {
    return event.kind == "state" && event.text.find("lost") != std::string::npos;
  }));
  CHECK(said.counts.resets == (silence_s > 10 ? 1 : 0));
  CHECK(said.state == State::tracking);
}

TEST_CASE("a receiver that comes back elsewhere is believed after half the time that it agreed", "[live]") {
  // The vehicle was carried by a ferry whose hold the odometry did not see: 2 km.
  LiveDrive drive = live_drive("rural", 120);
  const Stamp moved = stamp_of(drive.arrivals.front()).later(60);
  for (Sample& sample : drive.arrivals)
    if (is_fix(sample) && stamp_of(sample) > moved) fix_of(sample).latitude_deg += 0.018;
  const Said said = listen(drive.arrivals);
  CHECK(said.counts.resets == 1);
  const auto tracks = std::find_if(said.events.begin(), said.events.end(), [](const Event& event) {
    return event.kind == "state" && event.text == "aligning -> tracking";
  });
  REQUIRE(tracks != said.events.end());
  const double agreed_s = seconds_between(tracks->stamp, moved);
  // a fix a second
  CHECK(static_cast<double>(said.counts.refused.at("gnss: absurd")) == Approx(0.5 * agreed_s).margin(3));
  CHECK(said.state == State::tracking);
}

TEST_CASE("two receivers that come back elsewhere at the same stamps are believed too", "[live]") {
  LiveDrive drive = live_drive("rural", 120);
  const Stamp moved = stamp_of(drive.arrivals.front()).later(60);
  Arrivals both;
  for (Sample& sample : drive.arrivals) {
    if (is_fix(sample) && stamp_of(sample) > moved) fix_of(sample).latitude_deg += 0.018;
    both.push_back(sample);
    if (!is_fix(sample)) continue;
    both.push_back(sample);
    fix_of(both.back()).source = 1;
  }
  const Said said = listen(both, {}, "correlated", {"front", "rear"});
  CHECK(said.counts.resets == 1);
  CHECK(said.state == State::tracking);
  CHECK(largest(errors_m(said, drive)) > 1900);  // the truth was not carried
}

TEST_CASE("fixes that jump and come back are left out, whatever the size of the jump", "[live]") {
  const double jump_m = GENERATE(25.0, 60.0, 500.0);
  LiveDrive drive = live_drive("rural", 300);
  const Said without = listen(drive.arrivals);
  const double begin_s = 200;
  for (Sample& sample : drive.arrivals) {
    const double at_s = seconds_of(drive, stamp_of(sample));
    if (is_fix(sample) && at_s > begin_s && at_s < begin_s + 30)
      fix_of(sample).latitude_deg += jump_m / 111'200;
  }
  const Said said = listen(drive.arrivals);
  CHECK(said.counts.resets == 0);
  CHECK(said.count("jump") + said.count("absurd") >= 1);
  CHECK(rms(errors_m(said, drive)) < 1.1 * rms(errors_m(without, drive)) + 0.2);
}

TEST_CASE("fixes that jump and stay are believed within a minute", "[live]") {
  LiveDrive drive = live_drive("rural", 300);
  const double begin_s = 200;
  for (Sample& sample : drive.arrivals)
    if (is_fix(sample) && seconds_of(drive, stamp_of(sample)) > begin_s) fix_of(sample).latitude_deg += 2e-3;
  const Said said = listen(drive.arrivals);
  CHECK(said.counts.resets == 1);
  const auto reset = std::find_if(said.events.begin(), said.events.end(),
                                  [](const Event& event) { return event.kind == "reset"; });
  REQUIRE(reset != said.events.end());
  CHECK(seconds_of(drive, reset->stamp) == Approx(begin_s + 60).margin(3));
  CHECK(said.state == State::tracking);
}

TEST_CASE("a warm start knows heading and calibration before the vehicle moves", "[live]") {
  const LiveDrive drive = live_drive("rural", 120);
  Estimator first(live_description(), live_fusion(), {}, registry());
  const std::size_t half = drive.arrivals.size() / 2;
  for (std::size_t i = 0; i < half; ++i) first.take(drive.arrivals[i]);
  const std::optional<WarmStart> saved = first.warm_start();
  REQUIRE(saved);
  CHECK(!saved->states.empty());

  Estimator second(live_description(), live_fusion(), {}, registry());
  second.begin_with(*saved);
  std::size_t i = half;
  while (!is_fix(drive.arrivals[i])) second.take(drive.arrivals[i++]);
  for (std::size_t k = 0; k < 5; ++k) second.take(drive.arrivals[i++]);
  bool known = false;
  for (const Report& report : second.reports())
    if (const auto* pose = std::get_if<LivePose>(&report)) known = known || pose->heading_known;
  CHECK(known);
  CHECK(second.counts().resets == 0);
}

}  // namespace estimator_test
