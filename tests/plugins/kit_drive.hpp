/// A simulated drive with known truth for the sensor kit. Its odometry has exactly the noise of the
/// odometry edges, so tests can compare covariances with true errors.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/plugins/odometry/detail/noise.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace waymark_test {

/// Nodes are at 10 Hz, fixes at every full second.
struct KitRecipe {
  int seconds = 60;
  std::function<Eigen::Vector2d(double)> motion = [](double) {
    return Eigen::Vector2d(10, 0);
  };  ///< true speed and yaw rate at a time
  waymark::plugins::odometry::ProcessNoise noise{1e-6, 1e-6, 1e-8, 0, 1e-10, 1};
  double speed_scale = 0;  ///< true speed = (1 + scale) reading; if not 0, a state estimates it
  double fix_sigma_m = 2;
  double fix_period_s = 1;
  double last_fix_s = std::numeric_limits<double>::infinity();
  Eigen::Vector2d antenna_m{0, 0};
};

struct KitDrive {
  waymark::Graph graph;
  std::vector<waymark::Stamp> stamps;
  std::vector<waymark::VertexIndex> poses;
  std::vector<waymark::Interval> intervals;
  std::vector<waymark::Pose2<double>> truth;
  std::vector<waymark::Fix> fixes;
  Eigen::Vector2d antenna_m{0, 0};

  [[nodiscard]] waymark::DriveNodes nodes() const { return {stamps, poses, intervals}; }
  void add_sensor(const std::string& name, const waymark::SensorTable& readings,
                  const waymark::Options& options = {}) {
    const auto model = registry().make_sensor_model(name, options);
    model->check_drive(fixes, readings);
    model->extend({nodes(), fixes, antenna_m, readings}, graph);
  }
  void add_fixes() { registry().make_gnss_modeling("g1", {})->extend({fixes, {}, antenna_m}, graph); }
};

constexpr int kNodesPerSecond = 10;

inline waymark::Stamp kit_stamp(double seconds) {
  return waymark::Stamp::from_seconds(1000 + seconds);
}

/// A log with named columns. Values that a row does not give are NaN.
class Readings {
 public:
  explicit Readings(const std::string& sensor) : columns_(registry().sensor_model(sensor).columns) {
    table_.columns = columns_.size();
  }
  void add(waymark::Stamp stamp, const std::map<std::string, double>& row) {
    table_.stamps.push_back(stamp);
    std::size_t found = 0;
    for (const waymark::SensorColumn& column : columns_) {
      const auto given = row.find(column.name);
      found += given != row.end() ? 1 : 0;
      table_.values.push_back(given == row.end() ? std::numeric_limits<double>::quiet_NaN() : given->second);
    }
    REQUIRE(found == row.size());
  }
  [[nodiscard]] const waymark::SensorTable& table() const { return table_; }

 private:
  std::vector<waymark::SensorColumn> columns_;
  waymark::SensorTable table_;
};

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  double operator()(double sigma) { return sigma * unit_(random_); }
  Eigen::Vector3d operator()(const Eigen::Matrix3d& covariance) {
    const Eigen::Vector3d white((*this)(1), (*this)(1), (*this)(1));
    return covariance.llt().matrixL() * white;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_{0, 1};
};

inline waymark::Options odometry_options(const KitRecipe& recipe) {
  using waymark::shortest;
  waymark::Options options = {{"longitudinal_variance_per_m", shortest(recipe.noise.longitudinal_per_m)},
                              {"lateral_variance_per_m", shortest(recipe.noise.lateral_per_m)},
                              {"position_variance_per_s", shortest(recipe.noise.position_per_s)},
                              {"heading_variance_per_m", shortest(recipe.noise.heading_per_m)},
                              {"heading_variance_per_s", shortest(recipe.noise.heading_per_s)}};
  if (recipe.speed_scale != 0) {
    options["speed_scale"] = "constant";
    options["speed_scale_sigma"] = "0.1";
  }
  return options;
}

/// Returns the drive with its odometry and its fixes. The initial guess is dead reckoning from the
/// true first pose. The truth of a node is the previous pose, moved as the odometry says, times
/// exp(e) with e drawn from the covariance of the edge.
[[nodiscard]] inline KitDrive make_kit_drive(const KitRecipe& recipe, std::uint64_t seed) {
  using namespace waymark;
  Noise noise(seed);
  KitDrive drive;
  drive.antenna_m = recipe.antenna_m;
  Pose2<double> truth(30, -20, 0.4);
  Pose2<double> start = truth;
  const int count = recipe.seconds * kNodesPerSecond + 1;
  constexpr double kDt = 1.0 / kNodesPerSecond;
  for (int i = 0; i < count; ++i) {
    const double t = i * kDt;
    drive.stamps.push_back(kit_stamp(t));
    drive.truth.push_back(truth);
    drive.poses.push_back(drive.graph.add_vertex<VertexSe2>(
        VertexId(i), {start.position[0], start.position[1], wrap_angle(start.heading)}));
    const int per_fix = static_cast<int>(std::lround(recipe.fix_period_s * kNodesPerSecond));
    if (i % per_fix == 0 && t <= recipe.last_fix_s) {
      Fix fix;
      fix.stamp = drive.stamps.back();
      fix.covariance = recipe.fix_sigma_m * recipe.fix_sigma_m * Eigen::Matrix2d::Identity();
      fix.position = truth.position + rotate(truth.heading, recipe.antenna_m);
      fix.position += Eigen::Vector2d(noise(recipe.fix_sigma_m), noise(recipe.fix_sigma_m));
      fix.vertex = VertexId(i);
      fix.antenna_m = recipe.antenna_m;
      drive.fixes.push_back(fix);
    }
    if (i + 1 == count) break;
    const Eigen::Vector2d motion = recipe.motion(t);
    const Interval reading{motion[0] / (1 + recipe.speed_scale), motion[1], kDt, false};
    const Eigen::Vector3d error = noise(plugins::odometry::process_covariance(reading, recipe.noise));
    truth = compose(truth, se2_exp<double>(Eigen::Vector3d(motion[0] * kDt, 0, motion[1] * kDt)));
    truth = compose(truth, se2_exp<double>(error));
    start = compose(start, se2_exp<double>(Eigen::Vector3d(reading.speed_mps * kDt, 0, motion[1] * kDt)));
    drive.intervals.push_back(reading);
  }
  registry()
      .make_odometry_model("constant_twist", odometry_options(recipe))
      ->extend({drive.nodes()}, drive.graph);
  drive.add_fixes();
  return drive;
}

/// Errors of the optimum against the truth, with the stated covariances.
struct Solution {
  std::vector<Eigen::Vector3d> errors;  ///< x, y in the axes of the frame, heading
  std::vector<Eigen::Matrix3d> covariances;

  [[nodiscard]] double rms_position() const {
    double sum = 0;
    for (const auto& e : errors) sum += e.head<2>().squaredNorm();
    return std::sqrt(sum / static_cast<double>(errors.size()));
  }
  [[nodiscard]] double rms_heading() const {
    double sum = 0;
    for (const auto& e : errors) sum += e[2] * e[2];
    return std::sqrt(sum / static_cast<double>(errors.size()));
  }
  [[nodiscard]] double sigma(int node, int part) const {
    return std::sqrt(covariances[static_cast<std::size_t>(node)](part, part));
  }
  /// Returns e^T C^-1 e of a node: 3 on average if the covariance is right.
  [[nodiscard]] double normalised(int node) const {
    const auto& e = errors[static_cast<std::size_t>(node)];
    return e.dot(covariances[static_cast<std::size_t>(node)].llt().solve(e));
  }
};

[[nodiscard]] inline Solution solve(KitDrive& drive) {
  using namespace waymark;
  OptimizerOptions tight;
  tight.decrement_tolerance = 1e-10;
  const Summary summary = optimize(drive.graph, *registry().make_algorithm("dogleg"),
                                   *registry().make_linear_solver("block_cholesky"), tight);
  INFO(summary.message);
  REQUIRE(summary.converged());
  Solution solution;
  const CovarianceBlocks blocks = marginal_covariances(drive.graph, drive.poses);
  for (std::size_t i = 0; i < drive.poses.size(); ++i) {
    const auto value = drive.graph.value(drive.poses[i]);
    const Pose2<double>& truth = drive.truth[i];
    solution.errors.emplace_back(value[0] - truth.position[0], value[1] - truth.position[1],
                                 wrap_angle(value[2] - truth.heading));
    solution.covariances.emplace_back(blocks[i]);
  }
  return solution;
}

/// Returns the only vertex of a type, or -1.
[[nodiscard]] inline waymark::VertexIndex find_state(const waymark::Graph& graph, std::string_view tag) {
  for (waymark::VertexIndex v = 0; v < static_cast<waymark::VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag == tag) return v;
  }
  return -1;
}

/// Returns the number of edges of a type.
[[nodiscard]] inline std::size_t edges_of(const waymark::Graph& graph, std::string_view tag) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    if (graph.edge_type(b).tag == tag) count += graph.batch(b).size();
  return count;
}

/// Checks that the mean of a chi-square with `freedom` degrees over n draws is within four of its
/// sigmas of `freedom`.
inline void check_mean_chi_square(double sum, int freedom, int n) {
  CHECK(sum / n == Approx(freedom).margin(4 * std::sqrt(2.0 * freedom / n)));
}

}  // namespace waymark_test
