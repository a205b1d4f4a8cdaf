#include <numbers>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::loop_closure {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

enum Column : std::size_t { kDt, kX, kY, kHeading, kSigma, kSigmaHeading };

std::vector<SensorColumn> columns() {
  return {{"dt", "s", "", true, "time of the second pose minus time of the first; may be negative"},
          {"x", "m", "", true, "second pose seen from the first, forward"},
          {"y", "m", "", true, "second pose seen from the first, to the left"},
          {"heading", "rad", "ccw", true, "turn from the first to the second"},
          {"sigma", "m", "", false, "standard deviation of x and of y"},
          {"sigma_heading", "rad", "", false, "standard deviation of the heading"}};
}

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = {
      {"sigma", "0.1", "m", OptionRange{1e-6, 1e4}, "sigma of x and y if the row states none"},
      {"sigma_heading_deg", "0.5", "deg", OptionRange{1e-4, 180},
       "sigma of the heading if the row states none"}};
  for (const OptionInfo& option : mount_options()) all.push_back(option);
  return all;
}

class LoopClosure final : public SensorModel {
 public:
  explicit LoopClosure(const CheckedOptions& options)
      : sigma_(options.number("sigma")),
        sigma_heading_(kDegree * options.number("sigma_heading_deg")),
        mount_(read_mount(options)) {}

  void extend(const SensorInput& input, Graph& graph) override {
    const SensorTable& readings = input.readings;
    for (std::size_t row = 0; row < readings.size(); ++row) {
      const double sigma = sigma_of_reading(readings, row, kSigma, "sigma", sigma_);
      const double sigma_heading =
          sigma_of_reading(readings, row, kSigmaHeading, "sigma_heading", sigma_heading_);
      const Stamp moment = readings.stamps[row];
      const auto from = find_place(input.nodes, moment);
      const auto to = find_place(input.nodes, moment_later(readings, row));
      if (!from || !to) continue;
      if (from->node == to->node)
        fail_reading(readings, row, "dt",
                     "both poses fall on one node of the drive: the odometry's interval is longer");
      const double scale = grid_scale_at(input, moment);
      const Pose2<double> seen(scale * number_of_reading(readings, row, kX, "x", kLargestLength_m),
                               scale * number_of_reading(readings, row, kY, "y", kLargestLength_m),
                               number_of_reading(readings, row, kHeading, "heading", kLargestAngle_rad));
      add_edge(*from, *to, seen, Eigen::Vector3d(sigma, sigma, sigma_heading), graph);
    }
  }

 private:
  static Stamp moment_later(const SensorTable& readings, std::size_t row) {
    constexpr double kLongest_s = 1e7;
    return readings.stamps[row].later(number_of_reading(readings, row, kDt, "dt", kLongest_s));
  }

  /// At the two moments the sensor stood at A = ahead_from mount and B = ahead_to mount, in the
  /// frames of the nodes. So the relative pose of the nodes is A Z B^-1, and its error is Ad(B)
  /// times the error of Z.
  void add_edge(const ReadingPlace& from, const ReadingPlace& to, const Pose2<double>& seen,
                const Eigen::Vector3d& sigmas, Graph& graph) const {
    const Pose2<double> sensor_from = compose(from.ahead, mount_);
    const Pose2<double> sensor_to = compose(to.ahead, mount_);
    const Pose2<double> z = compose(compose(sensor_from, seen), inverse(sensor_to));
    const Eigen::Matrix3d back = se2_adjoint(inverse(sensor_to));
    const Eigen::Vector3d weights = sigmas.cwiseAbs2().cwiseInverse();
    const Eigen::Matrix3d information = back.transpose() * weights.asDiagonal() * back;
    graph.add_edge(EdgeSe2{{z.position[0], z.position[1], wrap_angle(z.heading)}}, {from.pose, to.pose},
                   0.5 * (information + information.transpose()));
  }

  double sigma_ = 0;
  double sigma_heading_ = 0;
  Pose2<double> mount_;
};

void register_types(TypeRegistry& registry) {
  registry.add_sensor_model(
      {"loop_closure", "relative poses between two moments, from scan matching", columns(), options(),
       [](const CheckedOptions& options) { return std::make_unique<LoopClosure>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::loop_closure

WAYMARK_PLUGIN(loop_closure, "0.1.0", waymark::plugins::loop_closure::register_types);
