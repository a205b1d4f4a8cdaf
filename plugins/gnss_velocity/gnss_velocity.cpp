#include <waymark/plugins/gnss_velocity/gnss_velocity.hpp>

#include <algorithm>
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::gnss_velocity {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// A measured speed is that of one moment. Over a longer interval between poses (a gap) it
/// says too little.
constexpr double kLongestWay_s = 0.5;

std::vector<OptionInfo> options() {
  const OptionWords on_or_off = {"on", "off"};
  return {{"course", "on", "", on_or_off, "use the course: 'on' or 'off'"},
          {"speed", "on", "", on_or_off, "use the Doppler speed: 'on' or 'off'"},
          {"min_speed", "3", "m/s", OptionRange{0.1, 100},
           "below this |speed| of the odometry neither course nor speed is used"},
          {"course_sigma_deg", "2", "deg", OptionRange{1e-3, 180}, "sigma of courses that state none"},
          {"speed_sigma", "0.2", "m/s", OptionRange{1e-4, 100}, "sigma of speeds that state none"}};
}

class GnssVelocity final : public SensorModel {
 public:
  explicit GnssVelocity(const CheckedOptions& options)
      : uses_course_(options.word("course") == "on"),
        uses_speed_(options.word("speed") == "on"),
        min_speed_(options.number("min_speed")),
        course_sigma_(kDegree * options.number("course_sigma_deg")),
        speed_sigma_(options.number("speed_sigma")) {
    if (!uses_course_ && !uses_speed_)
      throw UsageError("gnss_velocity: course and speed are both off; leave the sensor out");
  }

  void check_drive(std::span<const Fix> fixes, const SensorTable&) const override {
    const bool any = std::any_of(fixes.begin(), fixes.end(), [&](const Fix& fix) {
      return (uses_course_ && fix.heading_rad) || (uses_speed_ && fix.speed_mps);
    });
    if (any) return;
    throw InputError("no accepted fix has " +
                     std::string(!uses_speed_    ? "a course; does the gnss log have a column 'course'?"
                                 : !uses_course_ ? "a speed; does the gnss log have a column 'speed'?"
                                                 : "a course or a speed; does the gnss log have columns "
                                                   "'course' and 'speed'?"));
  }

  void extend(const SensorInput& input, Graph& graph) override {
    for (const Fix& fix : input.fixes) {
      const auto place = find_place(input.nodes, fix.stamp);
      if (!place) continue;
      const Interval& motion = motion_at(input.nodes, place->node);
      if (std::abs(motion.speed_mps) < min_speed_) continue;
      if (uses_course_ && fix.heading_rad) add_course(fix, *place, motion, graph);
      if (uses_speed_ && fix.speed_mps) add_speed(input, fix, place->node, graph);
    }
  }

 private:
  void add_course(const Fix& fix, const ReadingPlace& place, const Interval& motion, Graph& graph) const {
    const double sigma = fix.heading_sigma_rad.value_or(course_sigma_);
    EdgeGnssCourse edge;
    edge.course = wrap_angle(*fix.heading_rad - place.ahead.heading);
    edge.speed = motion.speed_mps;
    edge.yaw_rate = motion.yaw_rate_radps;
    edge.antenna = fix.antenna_m;
    graph.add_edge(edge, {place.pose}, Eigen::Matrix<double, 1, 1>(1 / (sigma * sigma)));
  }

  /// The edge joins the node before the fix and the one after it. The mean speed between them is
  /// close to the speed at the fix, in the middle.
  void add_speed(const SensorInput& input, const Fix& fix, std::size_t node, Graph& graph) const {
    const DriveNodes& nodes = input.nodes;
    const std::size_t from = node > 0 ? node - 1 : 0;
    const std::size_t to = std::min(node + 1, nodes.poses.size() - 1);
    const double dt = seconds_between(nodes.stamps[from], nodes.stamps[to]);
    if (from == to || dt > kLongestWay_s) return;
    EdgeGnssSpeed edge;
    edge.speed = fix.grid_scale * *fix.speed_mps;
    edge.dt = dt;
    edge.antenna = fix.antenna_m;
    const double sigma_m = fix.speed_sigma_mps.value_or(speed_sigma_) * dt;
    graph.add_edge(edge, {nodes.poses[from], nodes.poses[to]},
                   Eigen::Matrix<double, 1, 1>(1 / (sigma_m * sigma_m)));
  }

  bool uses_course_ = true;
  bool uses_speed_ = true;
  double min_speed_ = 0;
  double course_sigma_ = 0;
  double speed_sigma_ = 0;
};

void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeGnssCourse>();
  registry.add_edge<EdgeGnssSpeed>();
  registry.add_sensor_model(
      {"gnss_velocity",
       "course and Doppler speed of the GNSS fixes",
       {},
       options(),
       [](const CheckedOptions& options) { return std::make_unique<GnssVelocity>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::gnss_velocity

WAYMARK_PLUGIN(gnss_velocity, "0.1.0", waymark::plugins::gnss_velocity::register_types);
