#include <array>
#include <cmath>

#include <Eigen/LU>

#include <waymark/core/error.hpp>
#include <waymark/core/options.hpp>
#include <waymark/core/plugin.hpp>
#include <waymark/plugins/odometry/edge_odometry.hpp>
#include <waymark/plugins/odometry/noise.hpp>

namespace waymark {
namespace {

/// One edge per interval: EDGE_SE2_ODOMETRY while driving, EDGE_SE2_STANDSTILL while standing.
class ConstantTwist final : public OdometryModel {
 public:
  ConstantTwist(const ProcessNoise& noise, const StandstillNoise& standstill, double standstill_speed,
                bool paper)
      : noise_(noise), standstill_(standstill), standstill_speed_(standstill_speed), paper_(paper) {}

  void build(std::span<const Interval> intervals, std::span<const VertexIndex> poses,
             Graph& graph) const override {
    if (poses.size() != intervals.size() + 1)
      throw UsageError("odometry: one pose more than intervals is needed");
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      const Interval& interval = intervals[i];
      const std::array<VertexIndex, 2> vertices = {poses[i], poses[i + 1]};
      if (std::abs(interval.speed_mps) < standstill_speed_ && !interval.bridged) {
        EdgeSe2Standstill edge;
        edge.speed = interval.speed_mps;
        edge.yaw_rate = interval.yaw_rate_radps;
        edge.dt = interval.dt_s;
        graph.add_edge(edge, vertices, standstill_information(interval));
      } else {
        EdgeSe2Odometry edge;
        edge.speed = interval.speed_mps;
        edge.yaw_rate = interval.yaw_rate_radps;
        edge.dt = interval.dt_s;
        const Eigen::Matrix3d covariance =
            paper_ ? paper_covariance(interval) : process_covariance(interval, noise_);
        graph.add_edge(edge, vertices, symmetric_inverse(covariance));
      }
    }
  }

  [[nodiscard]] double standstill_speed() const override { return standstill_speed_; }

 private:
  static Eigen::Matrix3d symmetric_inverse(const Eigen::Matrix3d& covariance) {
    const Eigen::Matrix3d inverse = covariance.inverse();
    return 0.5 * (inverse + inverse.transpose());
  }

  [[nodiscard]] Eigen::Matrix3d standstill_information(const Interval& interval) const {
    if (paper_) return 1e5 * Eigen::Matrix3d::Identity();  // Sec. II-C
    return standstill_covariance(interval.dt_s, standstill_).diagonal().cwiseInverse().asDiagonal();
  }

  ProcessNoise noise_;
  StandstillNoise standstill_;
  double standstill_speed_;
  bool paper_;
};

std::vector<OptionInfo> options() {
  return {
      {"noise", "process", "",
       "'process': additive process noise; 'paper': 1.1 % per edge, at least 1e-5 m^2 and 1e-6 rad^2, gaps "
       "alike"},
      {"longitudinal_variance_per_m", "2e-3", "m^2/m", "variance of the distance driven; in [1e-9, 1]"},
      {"lateral_variance_per_m", "5e-4", "m^2/m", "variance across the way; in [1e-9, 1]"},
      {"position_variance_per_s", "1e-4", "m^2/s",
       "variance of the position by time, both axes; in [1e-9, 1]"},
      {"heading_variance_per_m", "2.05e-7", "rad^2/m", "variance of the heading by way; in [0, 1]"},
      {"heading_variance_per_s", "1.5e-6", "rad^2/s", "variance of the heading by time; in [1e-12, 1]"},
      {"gap_noise_factor", "100", "", "factor on all of them across a gap of the odometry; in [1, 1e6]"},
      {"standstill_speed", "0.05", "m/s", "below this |speed| the vehicle stands; in [0, 1]"},
      {"standstill_position_variance_per_s", "1e-5", "m^2/s", "of a standing vehicle; in [1e-9, 1]"},
      {"standstill_heading_variance_per_s", "1e-6", "rad^2/s", "of a standing vehicle; in [1e-12, 1]"},
      {"standstill_largest_variance", "1e-5", "m^2, rad^2",
       "per edge, so that information is at least 1e5; in [1e-9, 1]"},
  };
}

std::unique_ptr<OdometryModel> make(const Options& given) {
  constexpr std::string_view kOwner = "odometry";
  const std::vector<OptionInfo> known = options();
  check_option_names(kOwner, given, known);
  const auto number = [&](const char* name, double low, double high) {
    return number_option(kOwner, given, known, name, low, high);
  };
  constexpr std::array<std::string_view, 2> kNoises = {"process", "paper"};
  ProcessNoise noise;
  noise.longitudinal_per_m = number("longitudinal_variance_per_m", 1e-9, 1);
  noise.lateral_per_m = number("lateral_variance_per_m", 1e-9, 1);
  noise.position_per_s = number("position_variance_per_s", 1e-9, 1);
  noise.heading_per_m = number("heading_variance_per_m", 0, 1);
  noise.heading_per_s = number("heading_variance_per_s", 1e-12, 1);
  noise.gap_factor = number("gap_noise_factor", 1, 1e6);
  StandstillNoise standstill;
  standstill.position_per_s = number("standstill_position_variance_per_s", 1e-9, 1);
  standstill.heading_per_s = number("standstill_heading_variance_per_s", 1e-12, 1);
  standstill.largest = number("standstill_largest_variance", 1e-9, 1);
  return std::make_unique<ConstantTwist>(noise, standstill, number("standstill_speed", 0, 1),
                                         word_option(kOwner, given, known, "noise", kNoises) == "paper");
}

void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeSe2Odometry>();
  registry.add_edge<EdgeSe2Standstill>();
  registry.add_odometry_model(
      {"constant_twist", "exact constant-twist integration of speed and yaw rate", options(), make});
}

}  // namespace
}  // namespace waymark

WAYMARK_PLUGIN(odometry, "0.1.0", waymark::register_types);
