#include <array>
#include <cmath>

#include <Eigen/LU>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/plugins/odometry/calibration.hpp>
#include <waymark/plugins/odometry/detail/noise.hpp>
#include <waymark/plugins/odometry/edge_odometry.hpp>
#include <waymark/types_se2/plugin_kit/state_along_drive.hpp>

namespace waymark::plugins::odometry {
namespace {

/// Adds one edge per interval: EDGE_SE2_ODOMETRY while driving, EDGE_SE2_STANDSTILL while standing.
/// If a state is calibrated, the driving edge is the first of EDGE_SE2_ODOMETRY_CALIBRATED, _YAW_CALIBRATED and
/// _YAW_SCALED that has it, and an EDGE_GYRO_AT_REST is added beside the standstill.
class ConstantTwist final : public OdometryModel {
 public:
  struct Configuration {
    ProcessNoise noise;
    StandstillNoise standstill;
    double standstill_speed = 0;
    /// rad^2 per s; not heading_per_s, because driving shakes a gyro
    double gyro_at_rest_per_s = 0;
    bool paper = false;
    StateOptions gyro_bias;
    StateOptions speed_scale;
    StateOptions yaw_per_speed;
    StateOptions yaw_scale;
  };

  explicit ConstantTwist(const Configuration& configuration)
      : given_(configuration),
        bias_(configuration.gyro_bias),
        scale_(configuration.speed_scale),
        per_speed_(configuration.yaw_per_speed),
        yaw_scale_(configuration.yaw_scale) {}

  void extend(const OdometryInput& input, Graph& graph) override {
    const DriveNodes& nodes = input.nodes;
    if (nodes.poses.size() != nodes.intervals.size() + 1)
      throw UsageError("odometry: one pose more than intervals is needed");
    for (std::size_t i = 0; i < nodes.intervals.size(); ++i) {
      const Interval& interval = nodes.intervals[i];
      const std::array<VertexIndex, 2> poses = {nodes.poses[i], nodes.poses[i + 1]};
      if (interval.stands(given_.standstill_speed) && !interval.bridged) {
        graph.add_edge(reading<EdgeSe2Standstill>(interval), poses, standstill_information(interval));
        if (bias_.is_calibrated()) add_gyro_at_rest(interval, bias_.at(nodes.stamps[i], graph), graph);
      } else {
        add_motion(nodes, i, poses, graph);
      }
    }
  }

  [[nodiscard]] double standstill_speed() const override { return given_.standstill_speed; }

 private:
  template <typename E>
  static E reading(const Interval& interval) {
    E edge;
    edge.speed = interval.speed_mps;
    edge.yaw_rate = interval.yaw_rate_radps;
    edge.dt = interval.dt_s;
    return edge;
  }

  /// Stamps are needed for calibration states only.
  void add_motion(const DriveNodes& nodes, std::size_t i, const std::array<VertexIndex, 2>& poses,
                  Graph& graph) {
    const Interval& interval = nodes.intervals[i];
    const auto [from, to] = poses;
    const Eigen::Matrix3d information = motion_information(interval);
    const auto scale = [&] { return scale_.at(nodes.stamps[i], graph); };
    const auto bias = [&] { return bias_.at(nodes.stamps[i], graph); };
    const auto per_speed = [&] { return per_speed_.at(nodes.stamps[i], graph); };
    if (yaw_scale_.is_calibrated())
      graph.add_edge(reading<EdgeSe2OdometryYawScaled>(interval),
                     {from, to, scale(), bias(), per_speed(), yaw_scale_.at(nodes.stamps[i], graph)},
                     information);
    else if (per_speed_.is_calibrated())
      graph.add_edge(reading<EdgeSe2OdometryYawCalibrated>(interval),
                     {from, to, scale(), bias(), per_speed()}, information);
    else if (bias_.is_calibrated() || scale_.is_calibrated())
      graph.add_edge(reading<EdgeSe2OdometryCalibrated>(interval), {from, to, scale(), bias()}, information);
    else
      graph.add_edge(reading<EdgeSe2Odometry>(interval), poses, information);
  }

  [[nodiscard]] Eigen::Matrix3d motion_information(const Interval& interval) const {
    const Eigen::Matrix3d covariance =
        given_.paper ? paper_covariance(interval) : process_covariance(interval, given_.noise);
    const Eigen::Matrix3d inverse = covariance.inverse();
    return 0.5 * (inverse + inverse.transpose());
  }

  [[nodiscard]] Eigen::Matrix3d standstill_information(const Interval& interval) const {
    if (given_.paper) return 1e5 * Eigen::Matrix3d::Identity();  // Sec. II-C
    return standstill_covariance(interval.dt_s, given_.standstill).diagonal().cwiseInverse().asDiagonal();
  }

  /// The mean of a white yaw rate with density q over dt has the variance q / dt.
  void add_gyro_at_rest(const Interval& interval, VertexIndex bias, Graph& graph) const {
    graph.add_edge(EdgeGyroAtRest{interval.yaw_rate_radps}, {bias},
                   Eigen::Matrix<double, 1, 1>(interval.dt_s / given_.gyro_at_rest_per_s));
  }

  Configuration given_;
  StateAlongDrive<VertexGyroBias, EdgeGyroBiasWalk> bias_;
  StateAlongDrive<VertexSpeedScale, EdgeSpeedScaleWalk> scale_;
  StateAlongDrive<VertexYawPerSpeed, EdgeYawPerSpeedWalk> per_speed_;
  StateAlongDrive<VertexYawScale, EdgeYawScaleWalk> yaw_scale_;
};

constexpr const char* kGapFactor = "gap_noise_factor";
constexpr const char* kTrackSigma = "track_sigma";
constexpr const char* kTrackHeading = "track_heading_sigma";

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = {
      {"noise", "process", "", OptionWords{"process", "paper"},
       "noise model: 'process', additive process noise; 'paper', 1.1 % per edge, at least 1e-5 m^2 "
       "and 1e-6 rad^2, also across gaps"},
      {"longitudinal_variance_per_m", "2e-3", "m^2/m", OptionRange{1e-9, 1},
       "variance along the way per metre driven", NoisePrior{2e-3, 0.8}},
      {"lateral_variance_per_m", "5e-4", "m^2/m", OptionRange{1e-9, 1},
       "variance across the way per metre driven"},
      {"position_variance_per_s", "1e-4", "m^2/s", OptionRange{1e-9, 1},
       "variance of each axis of the position per second"},
      {"heading_variance_per_m", "2.05e-7", "rad^2/m", OptionRange{0, 1},
       "heading variance per metre driven"},
      {"heading_variance_per_s", "1.5e-6", "rad^2/s", OptionRange{1e-12, 1}, "heading variance per second",
       NoisePrior{4e-6, 1.4}},
      {kGapFactor, "100", "", OptionRange{1, 1e6},
       "factor on the default process noise across a gap of the odometry, whatever the other options say"},
      {"standstill_speed", "0.05", "m/s", OptionRange{0, 1},
       "below this |speed| the vehicle stands, unless it turns on the spot (0.1 rad/s)"},
      {"standstill_position_variance_per_s", "1e-5", "m^2/s", OptionRange{1e-9, 1},
       "position variance per second at rest"},
      {"standstill_heading_variance_per_s", "1e-6", "rad^2/s", OptionRange{1e-12, 1},
       "heading variance per second at rest"},
      {"gyro_at_rest_variance_per_s", "1.5e-6", "rad^2/s", OptionRange{1e-12, 1},
       "variance of the turn that the gyro reads at rest"},
      {"standstill_largest_variance", "1e-5", "m^2, rad^2", OptionRange{1e-9, 1},
       "largest variance of an edge at rest, so that its information is at least 1e5"},
  };
  for (const std::vector<OptionInfo>& state :
       {state_options("gyro_bias", "rad/s", "off", "0.01", "2e-6", "reading of the gyro at rest"),
        state_options("speed_scale", "1", "off", "0.01", "2e-4",
                      "scale error of the speed, true speed = (1 + scale) reading"),
        state_options("yaw_per_speed", "rad/m", "off", "1e-3", "1e-5",
                      "error of a yaw rate from wheels or steering, true yaw rate = reading - this * speed"),
        state_options("yaw_scale", "1", "off", "0.01", "1e-4",
                      "scale error of the yaw rate, true yaw rate = (1 + scale) reading")})
    all.insert(all.end(), state.begin(), state.end());
  all.push_back(
      {kTrackSigma, "0.2", "m", OptionRange{1e-3, 100},
       "how far the track of a further relative source is beside that of the first one, to and fro, "
       "independent from second to second"});
  all.push_back(
      {kTrackHeading, "0.01", "rad", OptionRange{1e-5, 1}, "how far its heading is off, to and fro"});
  all.push_back(calibration_period_option());
  return all;
}

std::unique_ptr<OdometryModel> make(const CheckedOptions& options) {
  ConstantTwist::Configuration configuration;
  ProcessNoise& noise = configuration.noise;
  noise.longitudinal_per_m = options.number("longitudinal_variance_per_m");
  noise.lateral_per_m = options.number("lateral_variance_per_m");
  noise.position_per_s = options.number("position_variance_per_s");
  noise.heading_per_m = options.number("heading_variance_per_m");
  noise.heading_per_s = options.number("heading_variance_per_s");
  noise.gap_factor = options.number(kGapFactor);
  StandstillNoise& standstill = configuration.standstill;
  standstill.position_per_s = options.number("standstill_position_variance_per_s");
  standstill.heading_per_s = options.number("standstill_heading_variance_per_s");
  standstill.largest = options.number("standstill_largest_variance");
  configuration.gyro_at_rest_per_s = options.number("gyro_at_rest_variance_per_s");
  configuration.standstill_speed = options.number("standstill_speed");
  configuration.paper = options.word("noise") == "paper";
  configuration.gyro_bias = read_state(options, "gyro_bias");
  configuration.speed_scale = read_state(options, "speed_scale");
  configuration.yaw_per_speed = read_state(options, "yaw_per_speed");
  configuration.yaw_scale = read_state(options, "yaw_scale");
  return std::make_unique<ConstantTwist>(configuration);
}

void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexGyroBias>();
  registry.add_vertex<VertexSpeedScale>();
  registry.add_vertex<VertexYawPerSpeed>();
  registry.add_vertex<VertexYawScale>();
  registry.add_edge<EdgeSe2Odometry>();
  registry.add_edge<EdgeSe2Standstill>();
  registry.add_edge<EdgeSe2OdometryCalibrated>();
  registry.add_edge<EdgeSe2OdometryYawCalibrated>();
  registry.add_edge<EdgeSe2OdometryYawScaled>();
  registry.add_edge<EdgeGyroAtRest>();
  registry.add_edge<EdgeGyroBiasWalk>();
  registry.add_edge<EdgeSpeedScaleWalk>();
  registry.add_edge<EdgeYawPerSpeedWalk>();
  registry.add_edge<EdgeYawScaleWalk>();
  registry.add_odometry_model({"constant_twist", "exact constant-twist integration of speed and yaw rate",
                               options(), make, kGapFactor, kTrackSigma, kTrackHeading});
}

}  // namespace
}  // namespace waymark::plugins::odometry

WAYMARK_PLUGIN(odometry, "0.1.0", waymark::plugins::odometry::register_types);
