#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/LU>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/plugins/twist/detail/sensor_way.hpp>
#include <waymark/plugins/twist/edge_twist.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>
#include <waymark/types_se2/plugin_kit/state_along_drive.hpp>

namespace waymark::plugins::twist {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLargestSpeed_mps = 150;
constexpr double kLargestYawRate_radps = 20;
/// A node this near to a row is at the row: stamps of different logs are rounded differently.
constexpr double kSame_s = 1e-3;

enum Column : std::size_t { kVx, kVy, kYawRate, kSigmaV, kSigmaYawRate };

std::vector<SensorColumn> columns() {
  return {{"vx", "m/s", "body", true, "velocity of the sensor, forward in its own axes"},
          {"vy", "m/s", "body", false, "velocity of the sensor, to the left"},
          {"yaw_rate", "rad/s", "ccw", true, "turning rate seen from above"},
          {"sigma_v", "m/s", "", false, "standard deviation of vx and of vy"},
          {"sigma_yaw_rate", "rad/s", "", false, "standard deviation of the yaw rate"}};
}

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = {
      {"sigma_v", "0.1", "m/s", OptionRange{1e-6, 100}, "sigma of vx and vy if the row states none"},
      {"sigma_vy", "0.1", "m/s", OptionRange{1e-6, 100}, "sigma of the vy of rows without one, which is 0"},
      {"sigma_yaw_rate_deg", "0.5", "deg/s", OptionRange{1e-4, 180},
       "sigma of the yaw rate if the row states none"},
      {"longest", "1", "s", OptionRange{1e-3, 3600},
       "longest time between two rows; beyond it the source was silent"}};
  const auto append = [&all](const std::vector<OptionInfo>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(mount_options());
  append(state_options("scale", "1", "random_walk", "0.02", "5e-4",
                       "scale error of the velocities, true velocity = (1 + scale) reading"));
  append(state_options("yaw_rate_bias", "rad/s", "random_walk", "0.005", "2e-5",
                       "bias of the yaw rates, true yaw rate = reading - bias"));
  all.push_back(calibration_period_option());
  return all;
}

/// One row of the log.
struct TwistReading {
  Stamp stamp;
  Eigen::Vector3d twist;      ///< forward, left [(grid) m/s], yaw rate [rad/s]; axes of the sensor
  Eigen::Vector3d variances;  ///< of it
};

class TwistReader {
 public:
  explicit TwistReader(const CheckedOptions& options)
      : sigma_v_(options.number("sigma_v")),
        sigma_vy_(options.number("sigma_vy")),
        sigma_yaw_rate_(kDegree * options.number("sigma_yaw_rate_deg")) {
    const Pose2<double> mount = read_mount(options);
    moves_forward_only_ = mount.position[0] == 0 && std::abs(std::sin(mount.heading)) < 1e-9;
  }

  /// @throws InputError for impossible numbers; it names the row
  [[nodiscard]] TwistReading read(const SensorInput& input, std::size_t row) const {
    const SensorTable& readings = input.readings;
    const double scale = grid_scale_at(input, readings.stamps[row]);
    const double vx = number_of_reading(readings, row, kVx, "vx", kLargestSpeed_mps);
    const double vy =
        has_vy(readings, row) ? number_of_reading(readings, row, kVy, "vy", kLargestSpeed_mps) : 0;
    const double yaw_rate = number_of_reading(readings, row, kYawRate, "yaw_rate", kLargestYawRate_radps);
    const double sigma_v = sigma_of_reading(readings, row, kSigmaV, "sigma_v", sigma_v_);
    const double sigma_yaw_rate =
        sigma_of_reading(readings, row, kSigmaYawRate, "sigma_yaw_rate", sigma_yaw_rate_);
    const Eigen::Vector3d sigmas(sigma_v, has_vy(readings, row) ? sigma_v : sigma_vy_, sigma_yaw_rate);
    return {readings.stamps[row], {scale * vx, scale * vy, yaw_rate}, sigmas.cwiseAbs2()};
  }

 private:
  /// A vehicle does not slip at its body point, so that 0 is right there.
  [[nodiscard]] bool has_vy(const SensorTable& readings, std::size_t row) const {
    if (!std::isnan(readings.at(row, kVy))) return true;
    if (!moves_forward_only_)
      fail_reading(readings, row, "vy",
                   "is missing, and it is 0 only with mount_x 0 and mount_deg 0 or 180; a sensor mounted "
                   "otherwise moves sideways in turns");
    return false;
  }

  double sigma_v_ = 0;
  double sigma_vy_ = 0;
  double sigma_yaw_rate_ = 0;
  bool moves_forward_only_ = true;
};

class Twist final : public SensorModel {
 public:
  explicit Twist(const CheckedOptions& options)
      : reader_(options),
        longest_s_(options.number("longest")),
        mount_(read_mount(options)),
        is_calibrated_(options.word("scale") != "off" || options.word("yaw_rate_bias") != "off"),
        scale_(read_state(options, "scale")),
        bias_(read_state(options, "yaw_rate_bias")) {}

  void extend(const SensorInput& input, Graph& graph) override {
    for (std::size_t row = 0; row < input.readings.size(); ++row) {
      const TwistReading next = reader_.read(input, row);
      if (last_) follow(*last_, next, input.nodes, graph);
      last_ = next;
    }
  }

 private:
  /// The mean of two rows, valid between them.
  struct Piece {
    Eigen::Vector3d twist;
    Eigen::Vector3d density;  ///< of the variance of the way, per second
  };

  /// Moves on to the next row, and joins the node at the beginning with the last one on the way.
  void follow(const TwistReading& before, const TwistReading& next, const DriveNodes& nodes, Graph& graph) {
    const double dt = seconds_between(before.stamp, next.stamp);
    if (dt > longest_s_) from_ = {};
    if (dt > longest_s_ || dt <= 0) return;
    const Piece piece{0.5 * (before.twist + next.twist), 0.5 * dt * (before.variances + next.variances)};
    if (from_.in(graph) < 0) {
      const std::size_t first = first_node_at(nodes, before.stamp.later(-kSame_s));
      if (first == nodes.stamps.size() || nodes.stamps[first] > next.stamp.later(kSame_s)) return;
      begin(first, nodes, graph);
    }
    const std::size_t beyond = first_node_at(nodes, next.stamp.later(kSame_s));
    if (beyond > 0 && nodes.stamps[beyond - 1] > since_ && nodes.stamps[beyond - 1] >= now_) {
      advance(piece, nodes.stamps[beyond - 1]);
      add_edge(nodes.poses[beyond - 1], graph);
      begin(beyond - 1, nodes, graph);
    }
    advance(piece, next.stamp);
  }

  /// Returns the first node at a moment or after it; the number of nodes if there is none.
  static std::size_t first_node_at(const DriveNodes& nodes, Stamp moment) {
    return static_cast<std::size_t>(std::lower_bound(nodes.stamps.begin(), nodes.stamps.end(), moment) -
                                    nodes.stamps.begin());
  }

  void begin(std::size_t node, const DriveNodes& nodes, const Graph& graph) {
    from_.keep(nodes.poses[node], graph);
    since_ = now_ = nodes.stamps[node];
    way_ = {};
  }

  void advance(const Piece& piece, Stamp moment) {
    if (moment <= now_) return;
    way_.add(piece.twist, piece.density, seconds_between(now_, moment));
    now_ = moment;
  }

  void add_edge(VertexIndex to, Graph& graph) {
    const VertexIndex from = from_.in(graph);
    if (!is_calibrated_) {
      const Pose2<double> z = compose(compose(mount_, way_.motion()), inverse(mount_));
      graph.add_edge(EdgeSe2Log{{z.position[0], z.position[1], wrap_angle(z.heading)}}, {from, to},
                     information());
      return;
    }
    EdgeSe2Twist edge;
    edge.way = way_.mean_way();
    edge.bend = way_.bend();
    edge.dt = way_.seconds();
    edge.mount = mount_.vector();
    graph.add_edge(edge, {from, to, scale_.at(since_, graph), bias_.at(since_, graph)}, information());
  }

  /// The error of the body's motion is Ad(M) times that of the sensor's.
  [[nodiscard]] Eigen::Matrix3d information() const {
    const Eigen::Matrix3d back = se2_adjoint(inverse(mount_));
    const Eigen::Matrix3d result = back.transpose() * way_.covariance().inverse() * back;
    return 0.5 * (result + result.transpose());
  }

  TwistReader reader_;
  double longest_s_ = 0;
  Pose2<double> mount_;
  bool is_calibrated_ = true;
  StateAlongDrive<VertexTwistScale, EdgeTwistScaleWalk> scale_;
  StateAlongDrive<VertexTwistBias, EdgeTwistBiasWalk> bias_;
  std::optional<TwistReading> last_;
  KeptVertex from_;  ///< the pose of the node where the way begins
  Stamp since_;      ///< its stamp
  Stamp now_;        ///< where the way ends
  SensorWay way_;
};

void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexTwistScale>();
  registry.add_vertex<VertexTwistBias>();
  registry.add_edge<EdgeSe2Twist>();
  registry.add_edge<EdgeTwistScaleWalk>();
  registry.add_edge<EdgeTwistBiasWalk>();
  registry.add_sensor_model(
      {"twist", "twists from visual or lidar odometry, or from any other relative source", columns(),
       options(), [](const CheckedOptions& options) { return std::make_unique<Twist>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::twist

WAYMARK_PLUGIN(twist, "0.1.0", waymark::plugins::twist::register_types);
