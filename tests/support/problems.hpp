/// Small problems made in code, the same in every run: a noisy circle, a walk on a grid, a
/// drive with fixes.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark_test {

/// Returns the information matrix of a relative pose with these standard deviations.
[[nodiscard]] inline Eigen::Matrix3d pose_information(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(std::pow(sigma_m, -2), std::pow(sigma_m, -2), std::pow(sigma_rad, -2)).asDiagonal();
}

/// Returns z with Gaussian noise.
inline Eigen::Vector3d noisy(const Eigen::Vector3d& z, double sigma_m, double sigma_rad,
                             std::mt19937_64& random) {
  std::normal_distribution<double> unit(0, 1);
  const double x = z[0] + sigma_m * unit(random);
  const double y = z[1] + sigma_m * unit(random);
  return {x, y, waymark::wrap_angle(z[2] + sigma_rad * unit(random))};
}

/// Poses on a circle with a spacing of 1 m. There is noisy odometry, and a loop closure from every
/// fifth pose to its opposite. The initial guess is the odometry; nothing is fixed. The information
/// is in units of the noise, with a correlation.
[[nodiscard]] inline waymark::Graph noisy_circle(int poses, std::uint64_t seed = 1) {
  using namespace waymark;
  std::mt19937_64 random(seed);
  const double step = 2 * std::numbers::pi / poses;
  const double radius = 0.5 / std::sin(0.5 * step);
  std::vector<Pose2<double>> truth;
  for (int i = 0; i < poses; ++i) {
    truth.emplace_back(radius * std::cos(i * step), radius * std::sin(i * step),
                       i * step + 0.5 * std::numbers::pi);
  }
  Eigen::Matrix3d information = pose_information(0.05, 0.01);
  information(0, 2) = information(2, 0) = 300;
  Graph graph;
  Pose2<double> start = truth[0];
  std::vector<Eigen::Vector3d> odometry;
  for (int i = 0; i < poses; ++i) {
    graph.add_vertex<VertexSe2>(VertexId(i),
                                {start.position[0], start.position[1], wrap_angle(start.heading)});
    if (i + 1 == poses) break;
    const auto a = static_cast<std::size_t>(i);
    odometry.push_back(noisy(between(truth[a], truth[a + 1]).vector(), 0.05, 0.01, random));
    start = compose(start, constant_pose<double>(odometry.back()));
  }
  for (int i = 0; i + 1 < poses; ++i)
    graph.add_edge(EdgeSe2{odometry[static_cast<std::size_t>(i)]}, {i, i + 1}, information);
  for (int i = 0; i < poses; i += 5) {
    const int j = (i + poses / 2) % poses;
    const auto z = between(truth[static_cast<std::size_t>(i)], truth[static_cast<std::size_t>(j)]).vector();
    graph.add_edge(EdgeSe2{noisy(z, 0.05, 0.01, random)}, {i, j}, information);
  }
  return graph;
}

/// A random walk along the streets of a square grid, 1 m per step. Wherever the walk meets its
/// own way, an edge goes to the last earlier pose. The initial guess is the truth plus noise;
/// nothing is fixed.
[[nodiscard]] inline waymark::Graph grid_walk(int poses, int side, std::uint64_t seed = 1,
                                              double sigma_m = 0.02, double sigma_rad = 0.005) {
  using namespace waymark;
  std::mt19937_64 random(seed);
  const Eigen::Matrix3d information = pose_information(sigma_m, sigma_rad);
  Graph graph;
  std::vector<Pose2<double>> truth;
  std::map<std::pair<int, int>, int> last_visit;
  int x = 0;
  int y = 0;
  int direction = 0;
  constexpr int kDx[] = {1, 0, -1, 0};
  constexpr int kDy[] = {0, 1, 0, -1};
  for (int i = 0; i < poses; ++i) {
    truth.emplace_back(x, y, direction * 0.5 * std::numbers::pi);
    const Eigen::Vector3d start = noisy(truth.back().vector(), 0.1, 0.02, random);
    graph.add_vertex<VertexSe2>(VertexId(i), {start[0], start[1], start[2]});
    const auto join = [&](int from) {
      const auto z = between(truth[static_cast<std::size_t>(from)], truth.back()).vector();
      graph.add_edge(EdgeSe2{noisy(z, sigma_m, sigma_rad, random)}, {from, i}, information);
    };
    if (i > 0) join(i - 1);
    const auto [known, first] = last_visit.try_emplace({x, y}, i);
    if (!first) {
      if (i - known->second > 10) join(known->second);
      known->second = i;
    }
    if (random() % 4 == 0) direction = static_cast<int>(random() % 4);
    const auto leaves = [&] {
      return std::abs(x + kDx[direction]) > side / 2 || std::abs(y + kDy[direction]) > side / 2;
    };
    while (leaves()) direction = (direction + 1) % 4;
    x += kDx[direction];
    y += kDy[direction];
  }
  return graph;
}

/// A drive: a chain of poses at 25 Hz with odometry edges, and fixes at 1 Hz with their vertices.
/// The initial guess is dead reckoning. The caller chooses the modeling.
struct Drive {
  waymark::Graph graph;
  std::vector<waymark::Fix> fixes;
  std::vector<waymark::Interval> intervals;
  Eigen::Vector2d antenna_m{0, 0};

  /// Adds the fixes with a modeling of the registry.
  void add_fixes(const waymark::TypeRegistry& registry, std::string_view modeling,
                 const waymark::Options& options = {}) {
    std::vector<waymark::FixMoment> moments;
    for (const waymark::Fix& fix : fixes) {
      const auto node = static_cast<std::size_t>(fix.vertex);
      const waymark::Interval& motion = intervals[std::min(node, intervals.size() - 1)];
      const double turn = motion.yaw_rate_radps;
      moments.push_back({antenna_m, {motion.speed_mps - turn * antenna_m[1], turn * antenna_m[0]}});
    }
    registry.make_gnss_modeling(modeling, options)->extend({fixes, moments, antenna_m}, graph);
  }
};

/// A winding drive with stops. The gyro has a bias of 3e-4 rad/s, and the axes of the fixes
/// are correlated.
[[nodiscard]] inline Drive make_drive(const waymark::TypeRegistry& registry, int poses,
                                      Eigen::Vector2d antenna_m = {0, 0}, std::uint64_t seed = 1,
                                      const waymark::Options& odometry = {}) {
  using namespace waymark;
  constexpr double kDt = 0.04;
  constexpr int kPerFix = 25;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> unit(0, 1);
  Drive drive;
  drive.antenna_m = antenna_m;
  Pose2<double> truth(3, -2, 0.7);
  Pose2<double> start = truth;
  std::vector<VertexIndex> chain;
  for (int i = 0; i < poses; ++i) {
    chain.push_back(drive.graph.add_vertex<VertexSe2>(
        VertexId(i), {start.position[0], start.position[1], wrap_angle(start.heading)}));
    if (i % kPerFix == 0) {
      Fix fix;
      fix.stamp = Stamp{std::int64_t{i} * 40'000'000};
      const double a = 1.5 + std::sin(0.01 * i);
      fix.covariance << a * a, 0.3 * a, 0.3 * a, 1.5;
      const double u = unit(random);
      const Eigen::Vector2d noise(a * u, 0.3 * u + std::sqrt(1.5 - 0.09) * unit(random));
      fix.position = truth.position + rotate(truth.heading, antenna_m) + noise;
      fix.epoch = i / kPerFix;
      fix.vertex = VertexId(i);
      drive.fixes.push_back(fix);
    }
    if (i + 1 == poses) break;
    const double t = i * kDt;
    const bool stands = std::fmod(t, 60) > 50;
    const double speed = stands ? 0 : 9 + 4 * std::sin(0.07 * t);
    const double yaw_rate = stands ? 0 : 0.15 * std::sin(0.05 * t) + 0.1 * std::sin(0.31 * t);
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(speed * kDt, 0, yaw_rate * kDt)));
    const Interval interval{stands ? 0 : speed * 1.003 + 0.05 * unit(random),
                            yaw_rate + 3e-4 + 1e-3 * unit(random), kDt, false};
    drive.intervals.push_back(interval);
    if (!stands) {
      start = compose(start, se2_exp<double>(Eigen::Vector3d(interval.speed_mps * kDt, 0,
                                                             interval.yaw_rate_radps * kDt)));
    }
  }
  std::vector<Stamp> stamps;
  for (int i = 0; i < poses; ++i) stamps.push_back(Stamp{std::int64_t{i} * 40'000'000});
  registry.make_odometry_model("constant_twist", odometry)
      ->extend({{stamps, chain, drive.intervals}}, drive.graph);
  return drive;
}

}  // namespace waymark_test
