// The noise of the drive so far: what a live estimate learns, when, and what that changes.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/tools/live/estimator/window/window_setup.hpp>
#include <waymark/tools/live/learning/drive_so_far.hpp>
#include <waymark/tools/live/learning/lesson.hpp>
#include <waymark/tools/live/learning/noise_ahead.hpp>
#include <waymark/tools/live/learning/unlearned.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace learning_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

double late_rms(const std::vector<double>& errors) {
  return rms(std::span(errors).last(errors.size() - errors.size() / 2));
}

const Eigen::Vector3d& truth_at(Stamp stamp, const LiveDrive& drive) {
  const std::vector<StampedPose>& truth = drive.simulated.poses;
  const auto at = std::lower_bound(truth.begin(), std::prev(truth.end()), stamp,
                                   [](const StampedPose& of, Stamp moment) { return of.stamp < moment; });
  return at->pose;
}

/// A drive whose fixes have white noise alone, and claim 1 m.
LiveDrive white_drive(double sigma_m, double duration_s) {
  LiveDrive drive = live_drive("rural", duration_s);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, sigma_m);
  const drive::Projection projection(drive.simulated.frame);
  for (Sample& sample : drive.arrivals) {
    auto* fix = std::get_if<GeodeticFix>(&sample);
    if (fix == nullptr) continue;
    const Eigen::Vector2d place =
        truth_at(fix->stamp, drive).head<2>() + Eigen::Vector2d(noise(random), noise(random));
    const GeodeticPoint point = projection.to_geodetic(place);
    fix->latitude_deg = point.latitude_deg;
    fix->longitude_deg = point.longitude_deg;
    fix->covariance_en = Eigen::Matrix2d::Identity();
  }
  return drive;
}

drive::FusionSettings settings_of(bool estimates) {
  drive::FusionSettings settings = live_fusion();
  settings.estimates_noise = estimates;
  return settings;
}

/// A parameter of which the prior is a logarithm, m.
drive::NoiseParameter parameter_of(double value, bool linear = false) {
  drive::NoiseParameter parameter;
  parameter.option = "white_sigma";
  parameter.range = OptionRange{1e-3, 1e3};
  parameter.prior = NoisePrior{1, 0.7, linear};
  parameter.value = value;
  return parameter;
}

Lesson lesson_of(const LiveDrive& drive, const std::function<void()>& between) {
  const drive::DriveDescription description = live_description();
  DriveSoFar so_far(description, 1800);
  for (const Sample& sample : drive.arrivals) so_far.take(sample);
  const GeodeticFix& first = drive.simulated.fixes.front().fix;
  const Frame frame =
      drive::choose_frame({first.latitude_deg, first.longitude_deg}, std::nullopt, std::nullopt);
  return learn(so_far,
               {described_so_far(description, frame),
                with_open_calibration(live_fusion(), description, so_far, registry()),
                {},
                true},
               registry(), between);
}

double ahead(double value, double told, double length_s) {
  drive::NoiseEstimate noise;
  noise.parameters = {parameter_of(value)};
  noise.curvature = Eigen::MatrixXd::Constant(1, 1, 1 + told);
  return noise_ahead(noise, length_s).parameters.front().value;
}

}  // namespace

TEST_CASE("noise ahead: few minutes tell little of the next ones, many tell all", "[live]") {
  constexpr double kTold = 1e6;  // the search knows the value exactly
  CHECK(ahead(0.1, kTold, 0) == Approx(1).epsilon(1e-6));
  // A mean over ten minutes has 10 / 1.5 of the information of the prior.
  CHECK(ahead(0.1, kTold, 600) == Approx(std::pow(0.1, 10 / 11.5)).epsilon(1e-3));
  CHECK(ahead(0.1, kTold, 1e7) == Approx(0.1).epsilon(1e-3));
  SECTION("what a search has pulled to its prior is not pulled twice") {
    // information 1 beside the prior's 1: the drive alone says 0.01, the search 0.1
    CHECK(ahead(0.1, 1, 1e7) == Approx(0.1).epsilon(1e-3));
  }
  SECTION("larger noise than the prior expects is taken as it is") {
    CHECK(ahead(10, kTold, 60) == Approx(10));
  }
}

TEST_CASE("a gyro whose bias walks is learned from the fixes, without a stop", "[live]") {
  const auto learned_walk = [](double walk) {  // rad/s/sqrt(s)
    LiveDrive drive = live_drive("rural", 300);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    double bias = 0;
    for (Sample& sample : drive.arrivals) {
      auto* odometry = std::get_if<OdometrySample>(&sample);
      if (odometry == nullptr) continue;
      bias += walk * std::sqrt(0.04) * normal(random);
      odometry->yaw_rate_radps += bias;
    }
    return std::stod(lesson_of(drive, {}).setup.settings.odometry_options.at("gyro_bias_walk"));
  };
  const double none = learned_walk(0);
  CHECK(none < 4e-5);  // the usual one is 2e-5
  CHECK(learned_walk(1.5e-3) > 3 * none);
}

TEST_CASE("a search takes no more steps than a lesson may, whatever the drive", "[live]") {
  LiveDrive drive = live_drive("urban", 120);
  for (std::size_t i = drive.arrivals.size() / 2; i < drive.arrivals.size();
       ++i)  // the engine is off for ten minutes
    std::visit([](auto& sample) { sample.stamp = sample.stamp.later(600); }, drive.arrivals[i]);
  std::size_t steps = 0;
  const Lesson lesson = lesson_of(drive, [&] { ++steps; });
  CHECK(lesson.failure.empty());
  CHECK(steps > 0);
  // A million and 2000 for each second, over the length: 720 s, then 360 s, then 180 s.
  CHECK(static_cast<double>(steps) <= 3 * (1e6 / 180 + 2000));
}

TEST_CASE("a live estimate learns the noise of its drive, and is better for it", "[live]") {
  // Claims of 1 m say nothing in the default modeling: 1.5 m white, 3 m that last, are assumed.
  const LiveDrive drive = white_drive(0.05, 400);
  const Said stated = listen(live_description(), drive.arrivals, {}, settings_of(false));
  const Said learned = listen(live_description(), drive.arrivals, {}, settings_of(true));
  CHECK(stated.count("noise") == 0);
  CHECK(learned.count("noise") == 5);  // after 60, 90, 135, 203, 304 s
  CHECK(learned.counts.resets == 0);
  CHECK(late_rms(errors_m(learned, drive)) < 0.7 * late_rms(errors_m(stated, drive)));
  CHECK(coverage95(learned, drive) > 0.9);
  const auto radius = [](const Said& said) { return said.poses.back().radius95_m; };
  CHECK(radius(learned) < 0.5 * radius(stated));
}

TEST_CASE("a pause forgets nothing of what was learned", "[live]") {
  const LiveDrive drive = white_drive(0.05, 300);
  const auto last_radius = [&](double pause_s) {
    Arrivals arrivals = drive.arrivals;
    for (Sample& sample : arrivals)
      if (stamp_of(sample) > drive.simulated.poses.front().stamp.later(220))
        std::visit([&](auto& of) { of.stamp = of.stamp.later(pause_s); }, sample);
    const Said said = listen(live_description(), arrivals, {}, settings_of(true));
    CHECK(said.counts.resets == (pause_s > 0 ? 1 : 0));
    return said.poses.back().radius95_m;
  };
  CHECK(last_radius(650) < 1.3 * last_radius(0));
}

TEST_CASE("what is learned beside the estimate, in a thread or at once, is the same to the last bit",
          "[live]") {
  const LiveDrive drive = live_drive("urban", 200);
  const auto text_with = [&](std::launch policy) {
    Estimator estimator(live_description(), settings_of(true), {}, registry());
    estimator.learn_beside(
        [policy](std::function<Learned()> work) { return std::async(policy, std::move(work)); });
    return heard(estimator, drive.arrivals).text();
  };
  CHECK(text_with(std::launch::async) == text_with(std::launch::deferred));
}

TEST_CASE("a search that is stopped from outside is waited for no longer, and the estimate goes on",
          "[live]") {
  const LiveDrive drive = live_drive("urban", 200);
  const std::atomic<bool> stop{true};
  Estimator estimator(live_description(), settings_of(true), {}, registry());
  estimator.stop_learning_with(stop);
  const Said said = heard(estimator, drive.arrivals);
  CHECK(said.count("noise") == 0);
  CHECK(said.counts.lessons == 0);
  CHECK(said.state == State::tracking);
}

TEST_CASE("each pose is settled once, in order, though windows are built again", "[live]") {
  const LiveDrive drive = live_drive("urban", 200);
  const Said said = listen(live_description(), drive.arrivals, {}, settings_of(true));
  REQUIRE(said.count("noise") >= 2);
  REQUIRE(said.settled.size() > 4000);
  for (std::size_t i = 1; i < said.settled.size(); ++i)
    REQUIRE(said.settled[i - 1].stamp < said.settled[i].stamp);
}

TEST_CASE("a state for a later run holds what was learned", "[live]") {
  const LiveDrive drive = white_drive(0.05, 200);
  Estimator first(live_description(), settings_of(true), {}, registry());
  for (const Sample& sample : drive.arrivals) first.take(sample);
  const std::optional<WarmStart> saved = first.warm_start();
  REQUIRE(saved);
  const auto white = std::find_if(saved->noise.parameters.begin(), saved->noise.parameters.end(),
                                  [](const drive::NoiseParameter& of) { return of.option == "white_sigma"; });
  REQUIRE(white != saved->noise.parameters.end());
  CHECK(white->value < 0.7);

  const LiveDrive next = white_drive(0.05, 55);  // too short to learn from
  const auto last_radius = [&](bool warm) {
    Estimator estimator(live_description(), settings_of(true), {}, registry());
    WarmStart start = *saved;
    start.pose.reset();
    start.states.clear();
    if (warm) estimator.begin_with(start);
    return heard(estimator, next.arrivals).poses.back().radius95_m;
  };
  CHECK(last_radius(true) < 0.7 * last_radius(false));
}

TEST_CASE("a yaw rate of the other sign is told", "[live]") {
  LiveDrive drive = live_drive("urban", 200);
  for (Sample& sample : drive.arrivals)
    if (auto* odometry = std::get_if<OdometrySample>(&sample)) odometry->yaw_rate_radps *= -1;
  const Said said = listen(live_description(), drive.arrivals, {}, settings_of(true));
  const auto sign = std::count_if(said.events.begin(), said.events.end(), [](const Event& event) {
    return event.kind == "warning" && event.text.find("yaw rate") != std::string::npos;
  });
  CHECK(sign >= 1);
}

TEST_CASE("a yaw rate from wheels errs with the speed, which is known before anything was learned",
          "[live]") {
  constexpr double kUnlikeWheels = 2e-3;  // rad/m
  const auto said_by = [&](const LiveDrive& drive, std::string_view source) {
    drive::DriveDescription description = live_description();
    description.odometry.front().assembly.yaw_rate_from = source;
    return listen(description, drive.arrivals, {}, settings_of(true));
  };
  const auto drive_of = [&](double duration_s) {
    LiveDrive drive = live_drive("rural", duration_s);
    for (Sample& sample : drive.arrivals)
      if (auto* odometry = std::get_if<OdometrySample>(&sample))
        odometry->yaw_rate_radps += kUnlikeWheels * odometry->speed_mps;
    return drive;
  };
  SECTION("before the first lesson") {
    const LiveDrive drive = drive_of(58);
    const double known = rms(errors_m(said_by(drive, "rear_wheels"), drive));
    CHECK(known < 0.8 * rms(errors_m(said_by(drive, ""), drive)));
    Estimator estimator(live_description(), settings_of(true), {}, registry());
    estimator.know_yaw_rate(0, "rear_wheels");  // as the inputs tell it
    CHECK(heard(estimator, drive.arrivals).text() == said_by(drive, "rear_wheels").text());
  }
  SECTION("and after it") {
    const LiveDrive drive = drive_of(300);
    const double known = late_rms(errors_m(said_by(drive, "rear_wheels"), drive));
    const double found = late_rms(errors_m(said_by(drive, ""), drive));  // a bias of the way
    CHECK(found < 1.1 * known);
    CHECK(known < 1.1 * found);
  }
}

TEST_CASE("a window that is built again from its inputs has the poses of one that never was", "[live]") {
  const LiveDrive drive = live_drive("rural", 200);
  drive::FusionSettings settings = drive::decided(live_fusion(), registry());
  const Frame frame = drive.simulated.frame;
  const drive::Projection projection(frame);
  const auto window_for = [&] {
    return make_window(live_description(), {settings, {}}, frame, std::nullopt, registry());
  };
  PlacedStretch all;
  for (const Sample& sample : drive.arrivals) {
    if (const auto* odometry = std::get_if<OdometrySample>(&sample)) {
      if (!all.stamps.empty()) {
        Interval& interval = all.intervals.emplace_back();
        interval.dt_s = seconds_between(all.stamps.back(), odometry->stamp);
        interval.speed_mps = odometry->speed_mps;
        interval.yaw_rate_radps = odometry->yaw_rate_radps;
        all.givers.push_back(0);
      }
      all.stamps.push_back(odometry->stamp);
      all.poses.push_back(truth_at(odometry->stamp, drive));
    } else if (!all.stamps.empty()) {
      all.fixes.push_back(projection.project(std::get<GeodeticFix>(sample)));
    }
  }
  while (all.fixes.back().stamp > all.stamps.back()) all.fixes.pop_back();
  const std::unique_ptr<Window> whole = window_for();
  REQUIRE(whole->begin(all));
  const std::unique_ptr<Window> again = window_for();
  REQUIRE(again->begin_again(whole->inputs(), all.stamps[all.stamps.size() / 2]));
  CHECK(again->oldest() >= all.stamps[all.stamps.size() / 2]);
  CHECK((again->newest_pose() - whole->newest_pose()).head<2>().norm() < 0.01);
  CHECK((again->covariance() - whole->covariance()).norm() < 0.02 * whole->covariance().norm());
}

}  // namespace learning_test
