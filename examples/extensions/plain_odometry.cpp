// An odometry model: how the motion between two nodes becomes an edge. This one has one noise for all
// motion, and no calibration.
#include <cmath>

#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/se2.hpp>

using namespace waymark;

class PlainOdometry final : public OdometryModel {
 public:
  explicit PlainOdometry(const CheckedOptions& options)
      : sigma_m_(options.number("sigma")),
        sigma_rad_(options.number("sigma_heading")),
        rest_mps_(options.number("rest")) {}

  /// Called with the next nodes of a drive, often all of them. Speed and yaw rate are means over an interval.
  void extend(const OdometryInput& input, Graph& graph) override {
    const DriveNodes& nodes = input.nodes;
    for (std::size_t i = 0; i < nodes.intervals.size(); ++i) {
      const Interval& interval = nodes.intervals[i];
      const bool rests = std::abs(interval.speed_mps) < rest_mps_;
      const Eigen::Vector3d way(interval.speed_mps * interval.dt_s, 0,
                                interval.yaw_rate_radps * interval.dt_s);
      const Pose2<double> motion = se2_exp<double>(rests ? Eigen::Vector3d(0, 0, 0) : way);
      // A bridged gap was not measured. Its noise is that of the assumption that nothing changed in it.
      const double factor = interval.bridged ? 100 : 1;
      const double at = 1 / (factor * sigma_m_ * sigma_m_ * interval.dt_s);
      const double turned = 1 / (factor * sigma_rad_ * sigma_rad_ * interval.dt_s);
      graph.add_edge(EdgeSe2{motion.vector()}, {nodes.poses[i], nodes.poses[i + 1]},
                     Eigen::Vector3d(at, at, turned).asDiagonal());
    }
  }

  /// Below it the vehicle stands. The initial guess uses the same bound.
  [[nodiscard]] double standstill_speed() const override { return rest_mps_; }

 private:
  double sigma_m_;
  double sigma_rad_;
  double rest_mps_;
};

static std::vector<OptionInfo> options() {
  return {{"sigma", "0.1", "m/sqrt(s)", OptionRange{1e-6, 100}, "deviation of the way after one second"},
          {"sigma_heading", "0.002", "rad/sqrt(s)", OptionRange{1e-6, 10},
           "deviation of the heading after one second"},
          {"rest", "0.03", "m/s", OptionRange{0, 1}, "speed below which the vehicle stands"}};
}

static void register_types(TypeRegistry& registry) {
  registry.add_odometry_model(
      {"plain", "the measured motion with one noise", options(),
       [](const CheckedOptions& given) { return std::make_unique<PlainOdometry>(given); }});
}
WAYMARK_PLUGIN(plain_odometry, "1.0.0", register_types);
