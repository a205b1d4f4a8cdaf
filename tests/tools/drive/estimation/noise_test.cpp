// The noise of a drive, on drives made by the very error model whose parameters are estimated.
#include <cmath>
#include <map>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/estimation/noise_objective.hpp>
#include <waymark/tools/drive/estimation/noise_spread.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace noise_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark_test;

namespace {

struct Truth {
  double white_m = 0.8;
  double multipath_m = 2.5;
  double multipath_time_s = 30;
  double heading_variance_per_s = 2e-5;
  double accuracy_exponent = 1;
};

/// Twenty minutes of bends at 10 Hz, fixes at 1 Hz: odometry with a white error of the yaw rate, fixes with a
/// Gauss-Markov error, Student's t of four degrees of freedom, and claimed accuracies that swing by 2.5.
PreparedDrive make_drive(const Truth& truth, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  constexpr double kStep = 0.1;
  constexpr int kSamples = 12'000;
  PreparedDrive drive;
  Pose2<double> pose(0, 0, 0.3);
  const double decay = std::exp(-1 / truth.multipath_time_s);
  Eigen::Vector2d lasting(normal(random), normal(random));
  for (int i = 0; i <= kSamples; ++i) {
    const double t = i * kStep;
    const double speed = 12 + 4 * std::sin(t / 17);
    const double turn = 0.15 * std::sin(t / 11) + 0.05 * std::sin(t / 3);
    drive.odometry.push_back(
        {.stamp = Stamp::from_seconds(1000 + t), .speed_mps = speed, .yaw_rate_radps = turn});
    if (i % 10 == 0 && i > 0) {
      const double claimed = std::exp(0.9 * std::sin(t / 60));
      const double scale = std::pow(claimed, truth.accuracy_exponent);
      double chi_square = 0;
      for (int k = 0; k < 4; ++k) chi_square += std::pow(normal(random), 2);
      const double student = truth.white_m / std::sqrt(chi_square / 4);
      Fix fix;
      fix.stamp = drive.odometry.back().stamp;
      fix.epoch = i / 10;
      fix.position = pose.position + scale * (truth.multipath_m * lasting +
                                              student * Eigen::Vector2d(normal(random), normal(random)));
      fix.covariance = 9 * claimed * claimed * Eigen::Matrix2d::Identity();
      drive.fixes.push_back(fix);
      lasting =
          decay * lasting + std::sqrt(1 - decay * decay) * Eigen::Vector2d(normal(random), normal(random));
    }
    // The vehicle turns a little otherwise than the gyro says.
    const double slip = std::sqrt(truth.heading_variance_per_s * kStep) * normal(random);
    const double half = 0.15 * std::sin((t + kStep) / 11) + 0.05 * std::sin((t + kStep) / 3);
    const double next = 12 + 4 * std::sin((t + kStep) / 17);
    pose = compose(pose, se2_exp<double>(Eigen::Vector3d(0.5 * (speed + next) * kStep, 0,
                                                         0.5 * (turn + half) * kStep + slip)));
  }
  return drive;
}

/// The default modeling with the other noise parameters of the odometry stated.
FusionSettings complete_settings(const Options& modeling_options = {}) {
  FusionSettings settings;
  settings.modeling_options = modeling_options;
  settings.odometry_options = {{"heading_variance_per_m", "0"},
                               {"longitudinal_variance_per_m", "1e-6"},
                               {"lateral_variance_per_m", "1e-6"}};
  return decided(settings, registry());
}

NoiseEstimate estimate(const PreparedDrive& drive, const FusionSettings& settings) {
  const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry());
  NoiseEstimate noise = estimate_noise(placed, {}, settings, registry());
  find_deviations(placed, {}, settings, registry(), noise);
  return noise;
}

const NoiseParameter& find(const NoiseEstimate& noise, const std::string& option) {
  for (const NoiseParameter& parameter : noise.parameters) {
    if (parameter.option == option) return parameter;
  }
  FAIL("no parameter " << option);
  return noise.parameters.front();
}

}  // namespace

TEST_CASE("noise: what a drive was made with is found, within what the drive can show") {
  const Truth truth;
  constexpr int kSeeds = 6;
  const std::vector<std::pair<std::string, double>> expected = {
      {"white_sigma", truth.white_m},
      {"multipath_sigma", truth.multipath_m},
      {"multipath_time", truth.multipath_time_s},
      {"heading_variance_per_s", truth.heading_variance_per_s},
      {"accuracy_exponent", truth.accuracy_exponent}};
  std::map<std::string, double> mean;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const NoiseEstimate noise =
        estimate(make_drive(truth, 40 + static_cast<std::uint64_t>(seed)), complete_settings());
    CHECK(noise.evaluations < 300);
    for (const auto& [option, value] : expected) {
      const NoiseParameter& parameter = find(noise, option);
      CHECK(parameter.observed());
      const double away =
          parameter.prior.linear ? parameter.value - value : std::log(parameter.value / value);
      mean[option] += away / kSeeds;
    }
  }
  // Logarithms of a ratio. Laplace's method at heavy tails takes a third of the white noise, and
  // with it a quarter of the time (tools/drive/MEASUREMENTS.md).
  CHECK(std::abs(mean["white_sigma"]) < 0.4);
  CHECK(std::abs(mean["multipath_sigma"]) < 0.2);
  CHECK(std::abs(mean["multipath_time"]) < 0.3);
  CHECK(std::abs(mean["heading_variance_per_s"]) < 0.3);
  CHECK(std::abs(mean["accuracy_exponent"]) < 0.1);  // a difference, not a ratio
}

TEST_CASE("noise: what is stated is not estimated, what the drive cannot show keeps its prior") {
  Truth truth;
  PreparedDrive drive = make_drive(truth, 3);
  for (Fix& fix : drive.fixes) fix.covariance = Eigen::Matrix2d::Identity();
  const NoiseEstimate noise = estimate(drive, complete_settings({{"white_sigma", "1"}}));
  for (const NoiseParameter& parameter : noise.parameters) {
    CHECK(parameter.option != "white_sigma");
    CHECK(parameter.option != "longitudinal_variance_per_m");
  }
  const NoiseParameter& exponent = find(noise, "accuracy_exponent");
  CHECK_FALSE(exponent.observed());
  CHECK(exponent.deviation == Approx(exponent.prior.deviation).epsilon(0.05));
  const FusionSettings with = with_noise(complete_settings({{"white_sigma", "1"}}), noise);
  CHECK(with.modeling_options.at("white_sigma") == "1");
  CHECK(with.modeling_options.contains("multipath_sigma"));
  CHECK_FALSE(with.modeling_options.contains("heading_variance_per_s"));
  CHECK(with.odometry_options.contains("heading_variance_per_s"));

  // Options of the odometry may be stated with its states too.
  FusionSettings calibrated = complete_settings();
  calibrated.calibration->insert_or_assign("heading_variance_per_s", "1e-6");
  for (const NoiseParameter& parameter : estimate(drive, calibrated).parameters)
    CHECK(parameter.option != "heading_variance_per_s");
}

namespace {

/// The largest difference of two estimates, in deviations of the first.
double apart(const NoiseEstimate& one, const NoiseEstimate& other) {
  double largest = 0;
  for (const NoiseParameter& parameter : one.parameters) {
    for (const NoiseParameter& same : other.parameters) {
      if (same.name() != parameter.name()) continue;
      const double away =
          parameter.prior.linear ? same.value - parameter.value : std::log(same.value / parameter.value);
      largest = std::max(largest, std::abs(away) / parameter.deviation);
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("noise: the derivatives of the objective are those of its differences") {
  const PreparedDrive drive = make_drive({.accuracy_exponent = 0.5}, 6);
  const FusionSettings settings = complete_settings();
  const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry());
  NoiseEstimate noise = estimate(drive, settings);
  const CoarseDrive coarse = coarsen(placed, {});
  NoiseObjective objective(coarse, settings, registry());
  const Eigen::VectorXd minimum = coordinates_of(noise);
  // The cost is bent, and steps a little, where weights of losses reach their bounds, and the minimum itself may
  // be such a place.
  for (const double away : {0.2, 0.6, -0.6}) {
    const Eigen::VectorXd at = minimum.array() + away;
    place_at(at, noise);
    Eigen::VectorXd gradient;
    const double cost = objective.with_gradient(noise, gradient);
    CHECK(objective.at(noise) == Approx(cost).epsilon(1e-9));
    objective.stay();
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      // Weights that reach that of their mass bend the cost, so that a longer difference is a mean.
      constexpr double kStep = 2e-3;
      const auto beside = [&](double step) {
        Eigen::VectorXd moved = at;
        moved[i] += step;
        place_at(moved, noise);
        return objective.at(noise);
      };
      INFO(noise.parameters[static_cast<std::size_t>(i)].option << " at " << away);
      const double difference = (beside(kStep) - beside(-kStep)) / (2 * kStep);
      CHECK(gradient[i] == Approx(difference).epsilon(0.01).margin(0.03));
    }
  }
}

TEST_CASE("noise: a parameter without effect changes nothing, and is not observed") {
  PreparedDrive drive = make_drive({}, 3);
  for (Fix& fix : drive.fixes) fix.covariance = Eigen::Matrix2d::Identity();
  const NoiseEstimate with = estimate(drive, complete_settings());
  const NoiseEstimate without = estimate(drive, complete_settings({{"accuracy_exponent", "0.5"}}));
  CHECK_FALSE(find(with, "accuracy_exponent").observed());
  CHECK(find(with, "accuracy_exponent").value == Approx(0.5).margin(0.003));
  CHECK(apart(without, with) < 0.01);
}

TEST_CASE("noise: the frame's origin and the order of the receivers change nothing") {
  PreparedDrive drive = make_drive({}, 4);
  drive.odometry.resize(drive.odometry.size() / 2 + 1);  // three searches with two receivers take long
  drive.fixes.resize(drive.fixes.size() / 2);
  drive.receivers = {{"rear"}, {"front"}};
  for (std::size_t i = 0; i < drive.fixes.size(); i += 2) drive.fixes[i].source = 1;
  const NoiseEstimate here = estimate(drive, complete_settings());
  CHECK(find(here, "white_sigma").name() == "rear.white_sigma");
  for (Fix& fix : drive.fixes) fix.position += Eigen::Vector2d(1000, -1);
  CHECK(apart(here, estimate(drive, complete_settings())) < 0.01);
  for (Fix& fix : drive.fixes) fix.source = 1 - fix.source;
  std::swap(drive.receivers[0], drive.receivers[1]);
  CHECK(apart(here, estimate(drive, complete_settings())) < 0.01);
}

TEST_CASE("noise: what a stand-in for an accuracy says does not count") {
  // Fixes without a claim in the second half: whatever stands in for it, the drive says the same.
  PreparedDrive drive = make_drive({}, 5);
  for (std::size_t i = drive.fixes.size() / 2; i < drive.fixes.size(); ++i)
    drive.fixes[i].accuracy_claimed = false;
  const auto with_stand_in = [&](double sigma_m) {
    for (Fix& fix : drive.fixes) {
      if (!fix.accuracy_claimed) fix.covariance = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
    }
    return estimate(drive, complete_settings());
  };
  CHECK(apart(with_stand_in(0.5), with_stand_in(50)) < 1e-6);
}

TEST_CASE("noise: the search ends where the caller asks for it, with nothing") {
  const PreparedDrive drive = make_drive({}, 3);
  const FusionSettings settings = complete_settings();
  const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry());
  struct Ended {};
  bool ends = false;
  const auto between = [&] {
    if (ends) throw Ended();
  };
  const CoarseDrive coarse = coarsen(placed, {});
  NoiseEstimate noise = estimate_noise(placed, {}, settings, registry(), {}, between);
  NoiseObjective objective(coarse, settings, registry(), between);
  Eigen::VectorXd gradient;
  (void)objective.with_gradient(noise, gradient);
  ends = true;
  CHECK_THROWS_AS(objective.with_gradient(noise, gradient), Ended);
  CHECK_THROWS_AS(estimate_noise(placed, {}, settings, registry(), {}, between), Ended);
  CHECK_THROWS_AS(find_deviations(placed, {}, settings, registry(), noise, between), Ended);
  FusionSettings whole;
  CHECK_THROWS_AS(Fusion(drive, registry(), between).fuse(whole), Ended);
}

TEST_CASE("noise: what is not known of it widens covariances as much as noise that is drawn") {
  const PreparedDrive drive = make_drive({}, 3);
  const FusionSettings settings = complete_settings();
  const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry());
  const NoiseEstimate noise = estimate_noise(placed, {}, settings, registry());
  const CoarseDrive coarse = coarsen(placed, {});
  NoiseObjective objective(coarse, settings, registry());
  (void)objective.at(noise);
  objective.stay();
  const std::vector<PoseBelief> here = objective.beliefs_at(noise);
  const Eigen::VectorXd at = coordinates_of(noise);
  constexpr double kDeviation = 0.3;
  const Eigen::MatrixXd covariance =
      kDeviation * kDeviation * Eigen::MatrixXd::Identity(at.size(), at.size());
  const std::vector<PoseSpread> spread = spread_over_noise(objective, noise, covariance);
  REQUIRE(spread.size() == here.size());
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0, kDeviation);
  constexpr int kPairs = 60;
  const std::vector<std::size_t> nodes = {here.size() / 4, here.size() / 2};
  std::vector<double> drawn(nodes.size());
  NoiseEstimate other = noise;
  for (int pair = 0; pair < kPairs; ++pair) {
    const Eigen::VectorXd away = at.unaryExpr([&](double) { return normal(random); });
    for (const double side : {-1.0, 1.0}) {
      place_at(at + side * away, other);
      const std::vector<PoseBelief> there = objective.beliefs_at(other);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const PoseBelief& moved = there[nodes[i]];
        const PoseBelief& still = here[nodes[i]];
        drawn[i] += (moved.covariance - still.covariance).topLeftCorner<2, 2>().trace() +
                    (moved.pose - still.pose).head<2>().squaredNorm();
      }
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    INFO("node " << nodes[i]);
    const double widened = spread[nodes[i]].covariance.topLeftCorner<2, 2>().trace();
    CHECK(widened == Approx(drawn[i] / (2 * kPairs)).epsilon(0.2));
    CHECK(widened > 0.02 * here[nodes[i]].covariance.topLeftCorner<2, 2>().trace());
  }
  const std::vector<PoseSpread> known = spread_over_noise(objective, noise, 1e-4 * covariance);
  CHECK(known[nodes[0]].covariance.isZero());
}

TEST_CASE("noise: a long drive may stand through its middle") {
  constexpr double kStop_s = 1200;
  PreparedDrive drive = make_drive({}, 3);
  const PreparedDrive moving = drive;
  const auto half = std::ssize(moving.odometry) / 2;
  const auto half_fixes = std::ssize(moving.fixes) / 2;
  drive.odometry.resize(static_cast<std::size_t>(half));
  drive.fixes.resize(static_cast<std::size_t>(half_fixes));
  for (double t = 0.1; t < kStop_s; t += 0.1)
    drive.odometry.push_back({.stamp = moving.odometry[static_cast<std::size_t>(half - 1)].stamp.later(t)});
  for (double t = 1; t < kStop_s; ++t) {
    Fix fix = drive.fixes.back();
    fix.stamp = moving.fixes[static_cast<std::size_t>(half_fixes - 1)].stamp.later(t);
    ++fix.epoch;
    fix.position.x() += 1e-3 * std::sin(t);
    drive.fixes.push_back(fix);
  }
  for (auto i = half; i < std::ssize(moving.odometry); ++i) {
    drive.odometry.push_back(moving.odometry[static_cast<std::size_t>(i)]);
    drive.odometry.back().stamp = drive.odometry.back().stamp.later(kStop_s);
  }
  for (auto i = half_fixes; i < std::ssize(moving.fixes); ++i) {
    drive.fixes.push_back(moving.fixes[static_cast<std::size_t>(i)]);
    drive.fixes.back().stamp = drive.fixes.back().stamp.later(kStop_s);
  }
  const NoiseEstimate noise = estimate(drive, complete_settings());
  CHECK(find(noise, "multipath_sigma").observed());
}

TEST_CASE("noise: a spread is added at its time, to poses alone") {
  Graph graph;
  const auto pose_at = [&](double seconds) {
    const VertexIndex v = graph.add_vertex<VertexSe2>(graph.free_id(), Pose2<double>(0, 0, 0));
    graph.set_stamp(v, Stamp::from_seconds(seconds));
    return v;
  };
  const VertexIndex before = pose_at(90);
  const VertexIndex between = pose_at(102.5);
  const VertexIndex after = pose_at(130);
  const VertexIndex timeless = graph.add_vertex<VertexSe2>(graph.free_id(), Pose2<double>(0, 0, 0));
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  std::vector<formats::VertexCovariance> covariances;
  for (const VertexIndex v : {before, between, after, timeless}) covariances.push_back({v, one});
  covariances.push_back({before, one.topLeftCorner<2, 2>()});
  const std::vector<PoseSpread> spread = {{Stamp::from_seconds(100), 4 * one},
                                          {Stamp::from_seconds(110), 8 * one}};
  widen(covariances, graph, spread);
  CHECK(covariances[0].covariance.isApprox(5 * one));
  CHECK(covariances[1].covariance.isApprox(6 * one));
  CHECK(covariances[2].covariance.isApprox(9 * one));
  CHECK(covariances[3].covariance == one);
  CHECK(covariances[4].covariance.isIdentity(0));
}

TEST_CASE("noise: a modeling without such options and fixes that leave nothing open have none") {
  const PreparedDrive drive = make_drive({}, 3);
  FusionSettings settings;
  settings.modeling = "g1";
  settings.odometry_options = {{"heading_variance_per_s", "1e-6"}, {"longitudinal_variance_per_m", "1e-3"}};
  const NoiseEstimate noise = estimate(drive, decided(settings, registry()));
  CHECK(noise.parameters.empty());
  CHECK(noise.evaluations == 0);
}

TEST_CASE("model: a complete error model brings its own defaults, and what is stated overrides them") {
  REQUIRE(registry().gnss_modeling("correlated").complete);
  REQUIRE_FALSE(registry().gnss_modeling("g2").complete);
  FusionSettings settings;
  const FusionSettings ours = decided(settings, registry());
  CHECK(ours.gate.enabled == false);
  CHECK(ours.calibration == default_calibration());
  CHECK(ours.estimates_noise == true);
  CHECK(decided(ours, registry()) == ours);
  settings.modeling = "g2";
  const FusionSettings theirs = decided(settings, registry());
  CHECK(theirs.gate.enabled == true);
  CHECK(theirs.calibration == Options());
  CHECK(theirs.estimates_noise == false);

  FusionSettings stated;
  stated.gate.enabled = true;
  stated.calibration = Options();
  stated.estimates_noise = false;
  CHECK(decided(stated, registry()).gate.enabled == true);
  CHECK(decided(stated, registry()).calibration == Options());
  CHECK(decided(stated, registry()).estimates_noise == false);
}

TEST_CASE("coarse: fewer nodes and fixes, the same way and turn") {
  const PreparedDrive drive = make_drive({}, 5);
  const PlacedDrive placed = place_drive(drive, timeline_of(drive), complete_settings(), registry());
  const PlacedDrive coarse = coarsen(placed, {}).drive;
  const auto sum = [](const std::vector<Interval>& intervals, auto quantity) {
    double total = 0;
    for (const Interval& interval : intervals) total += quantity(interval);
    return total;
  };
  const auto way = [](const Interval& i) { return i.speed_mps * i.dt_s; };
  const auto turn = [](const Interval& i) { return i.yaw_rate_radps * i.dt_s; };
  CHECK(sum(coarse.timeline.intervals, way) == Approx(sum(placed.timeline.intervals, way)).epsilon(1e-12));
  CHECK(sum(coarse.timeline.intervals, turn) == Approx(sum(placed.timeline.intervals, turn)).margin(1e-9));
  CHECK(coarse.timeline.stamps.front() == placed.timeline.stamps.front());
  CHECK(coarse.timeline.stamps.back() == placed.timeline.stamps.back());
  CHECK(coarse.timeline.intervals.size() == coarse.timeline.stamps.size() - 1);
  CHECK(coarse.timeline.stamps.size() < placed.timeline.stamps.size() * 11 / 20);
  CHECK(coarse.fixes.size() == 172);  // every seventh of 1200
  for (const Fix& fix : coarse.fixes)
    CHECK(coarse.timeline.stamps[static_cast<std::size_t>(fix.vertex) - 1] == fix.stamp);
}

TEST_CASE("coarse: straight ways are merged up to a second, turns as far as a twist follows them") {
  PreparedDrive drive = make_drive({}, 5);
  const auto coarse_of = [&] {
    return coarsen(place_drive(drive, timeline_of(drive), complete_settings(), registry()), {}).drive;
  };
  for (OdometrySample& sample : drive.odometry) sample.yaw_rate_radps = 0.1;
  const PlacedDrive steady = coarse_of();  // whatever the speed does, this is one circle
  CHECK(steady.timeline.intervals.size() < drive.odometry.size() / 8);
  // The yaw rate changes by 1 rad/s^2 to and fro: at 12 m/s a twist of 0.25 s misses by 1.5 cm.
  for (std::size_t i = 0; i < drive.odometry.size(); ++i)
    drive.odometry[i].yaw_rate_radps =
        0.5 * std::sin(2 * seconds_between(drive.odometry[0].stamp, drive.odometry[i].stamp));
  const PlacedDrive turning = coarse_of();
  CHECK(turning.timeline.intervals.size() > 2 * steady.timeline.intervals.size());
}

TEST_CASE("coarse: the noise of a poor gyro keeps no nodes, its motion does") {
  PreparedDrive drive = make_drive({}, 5);
  const auto intervals = [&](double noise, double turns) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0, noise);
    for (OdometrySample& sample : drive.odometry)
      sample.yaw_rate_radps =
          turns * std::sin(2 * seconds_between(drive.odometry[0].stamp, sample.stamp)) + normal(random);
    return coarsen(place_drive(drive, timeline_of(drive), complete_settings(), registry()), {})
        .drive.timeline.intervals.size();
  };
  const std::size_t straight = intervals(0, 0);
  CHECK(intervals(0.06, 0) < straight * 6 / 5);  // at 10 Hz 0.02 rad/sqrt(s): 0.2 s of it miss by 6 mm
  CHECK(intervals(1e-4, 0.5) > 2 * straight);
}

TEST_CASE("coarse: readings a period apart are kept, all rows of each, and jitter costs none") {
  PreparedSensor sensor;
  sensor.readings.columns = 1;
  const auto add = [&](double seconds, double value) {
    sensor.readings.stamps.push_back(Stamp::from_seconds(seconds));
    sensor.readings.values.push_back(value);
  };
  for (int i = 0; i <= 10; ++i) {  // epochs of two rows
    const double jitter = i == 5 ? -0.2 : 0;
    add(i + jitter, i);
    add(i + jitter + 0.0004, i);
  }
  const PreparedSensor all = thinned(sensor, 0);
  CHECK(all.readings.values == sensor.readings.values);
  const PreparedSensor few = thinned(sensor, 5);
  CHECK(few.readings.values == std::vector<double>{0, 0, 5, 5, 10, 10});
  CHECK(few.readings.size() == 6);
}

TEST_CASE("coarse: the middle of a drive is a drive with the nodes, fixes and motion of its time") {
  const PreparedDrive drive = make_drive({}, 5);
  const CoarseDrive whole =
      coarsen(place_drive(drive, timeline_of(drive), complete_settings(), registry()), {});
  const PlacedDrive piece = middle_of(whole, 300).drive;
  const std::vector<Stamp>& all = whole.drive.timeline.stamps;
  const std::vector<Stamp>& stamps = piece.timeline.stamps;
  CHECK(seconds_between(stamps.front(), stamps.back()) == Approx(300).margin(2.1));
  CHECK(seconds_between(stamps.front(), stamps.back()) >= 300);
  CHECK(seconds_between(all.front(), stamps.front()) ==
        Approx(seconds_between(stamps.back(), all.back())).margin(2.1));
  REQUIRE(piece.timeline.intervals.size() == stamps.size() - 1);
  for (std::size_t i = 0; i + 1 < stamps.size(); ++i)
    CHECK(piece.timeline.intervals[i].dt_s == Approx(seconds_between(stamps[i], stamps[i + 1])));
  std::size_t expected = 0;
  for (const Fix& fix : whole.drive.fixes)
    expected += fix.stamp >= stamps.front() && fix.stamp <= stamps.back() ? 1 : 0;
  CHECK(piece.fixes.size() == expected);
  REQUIRE(piece.timeline.fix_node.size() == expected);
  for (std::size_t i = 0; i < expected; ++i) {
    CHECK(stamps[piece.timeline.fix_node[i]] == piece.fixes[i].stamp);
    CHECK(piece.fixes[i].vertex == vertex_of(piece.timeline.fix_node[i]));
  }
}

TEST_CASE("coarse: a sample of a long drive has its windows, and gaps of the odometry between them") {
  const PreparedDrive drive = make_drive({}, 5);
  const CoarseDrive whole =
      coarsen(place_drive(drive, timeline_of(drive), complete_settings(), registry()), {});
  const std::vector<Stamp>& all = whole.drive.timeline.stamps;
  const double length_s = seconds_between(all.front(), all.back());
  const PlacedDrive sample = sample_of(whole, 3, 60).drive;
  std::size_t gaps = 0;
  double measured_s = 0;
  REQUIRE(sample.timeline.intervals.size() == sample.timeline.stamps.size() - 1);
  for (std::size_t i = 0; i < sample.timeline.intervals.size(); ++i) {
    const Interval& interval = sample.timeline.intervals[i];
    CHECK(interval.dt_s == Approx(seconds_between(sample.timeline.stamps[i], sample.timeline.stamps[i + 1])));
    if (!interval.bridged) {
      measured_s += interval.dt_s;
      continue;
    }
    ++gaps;
    CHECK(interval.gap_s == Approx(length_s / 3 - 60).margin(4));
    // its motion leads from one window to the other
    const Eigen::Vector3d& begin = sample.start.poses[i];
    const Pose2<double> from(begin[0], begin[1], begin[2]);
    const Pose2<double> end = compose(from, se2_exp<double>({interval.speed_mps * interval.dt_s, 0,
                                                             interval.yaw_rate_radps * interval.dt_s}));
    CHECK((end.position - sample.start.poses[i + 1].head<2>()).norm() < 1e-6);
  }
  CHECK(gaps == 2);
  CHECK(measured_s == Approx(180).margin(6));
  for (std::size_t i = 0; i < sample.fixes.size(); ++i)
    CHECK(sample.timeline.stamps[sample.timeline.fix_node[i]] == sample.fixes[i].stamp);
  CHECK(sample_of(whole, 3, 0.3 * length_s).drive.timeline.stamps == all);
}

TEST_CASE("coarse: of a drive that is parked for hours, what drives and 20 minutes of the stop are taken") {
  const PreparedDrive moving = make_drive({}, 5);
  PreparedDrive drive = moving;
  const auto half = std::ssize(moving.odometry) / 2;
  drive.odometry.resize(static_cast<std::size_t>(half));
  constexpr double kParked_s = 8 * 3600;
  const Stamp stop = drive.odometry.back().stamp;
  for (double t = 0.1; t < kParked_s; t += 0.4) drive.odometry.push_back({.stamp = stop.later(t)});
  for (auto i = half; i < std::ssize(moving.odometry); ++i) {
    drive.odometry.push_back(moving.odometry[static_cast<std::size_t>(i)]);
    drive.odometry.back().stamp = drive.odometry.back().stamp.later(kParked_s);
  }
  for (Fix& fix : drive.fixes)
    if (fix.stamp > stop) fix.stamp = fix.stamp.later(kParked_s);
  const CoarseDrive whole =
      coarsen(place_drive(drive, timeline_of(drive), complete_settings(), registry()), {});
  const PlacedDrive sample = sample_of(whole).drive;
  double measured_s = 0;
  for (const Interval& interval : sample.timeline.intervals)
    measured_s += interval.bridged ? 0 : interval.dt_s;
  CHECK(
      measured_s ==
      Approx(seconds_between(moving.odometry.front().stamp, moving.odometry.back().stamp) + 1200).margin(5));
  CHECK(sample.fixes.size() == whole.drive.fixes.size());
}

TEST_CASE("fuse: modelings that agree on gate and guess share them, and give what each gives alone") {
  const PreparedDrive drive = make_drive({}, 7);
  Fusion fusion(drive, registry());
  FusionSettings settings;
  for (const std::string modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    settings.modeling = modeling;
    const FusedDrive together = fusion.fuse(settings);
    const FusedDrive alone = fuse(drive, settings, registry());
    CHECK(together.minimum.summary.converged());
    CHECK(together.minimum.summary.final_chi2 == alone.minimum.summary.final_chi2);
    CHECK(together.model.document.graph.values() == alone.model.document.graph.values());
    CHECK(together.model.document.provenance == alone.model.document.provenance);
    CHECK(together.model.placed.gate.rejected == alone.model.placed.gate.rejected);
  }
}

TEST_CASE("fuse: the gate, the lever arm and the guess are those of the settings, not of the one before") {
  PreparedDrive drive = make_drive({}, 7);
  for (Fix& fix : drive.fixes) fix.antenna_m = {1, 0};
  Fusion fusion(drive, registry());
  FusionSettings settings;
  settings.modeling = "g1";
  const ModeledDrive gated = fusion.model(settings);
  settings.gate.enabled = false;
  settings.lever_arm = false;
  settings.initial_guess.first_heading_rad = 1.25;
  const ModeledDrive open = fusion.model(settings);
  CHECK(gated.placed.gate.reasons.contains("off") == false);
  CHECK(open.placed.gate.reasons.at("off") == drive.fixes.size());
  CHECK(gated.document.antenna_m == Eigen::Vector2d(1, 0));
  CHECK(open.document.antenna_m == Eigen::Vector2d(0, 0));
  CHECK(open.placed.start.poses.front()[2] == Approx(1.25));
  CHECK(gated.placed.start.poses.front()[2] != Approx(1.25));
}

}  // namespace noise_test
