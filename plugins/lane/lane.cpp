#include <waymark/plugins/lane/lane.hpp>

#include <cmath>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::lane {
namespace {

enum Column : std::size_t { kOffset, kAx, kAy, kBx, kBy, kSigma };

std::vector<SensorColumn> columns() {
  return {{"offset", "m", "", true, "distance of the vehicle to the left of the line from a to b"},
          {"ax", "m", "x", true, "point a of the line in the frame: x"},
          {"ay", "m", "y", true, "point a: y"},
          {"bx", "m", "x", true, "point b, from a in the direction of the line: x"},
          {"by", "m", "y", true, "point b: y"},
          {"sigma", "m", "", false, "standard deviation of the offset"}};
}

std::vector<OptionInfo> options() {
  return {{"sigma", "0.2", "m", OptionRange{1e-6, 1e4}, "sigma of offsets that state none"},
          {"lever_x", "0", "m", OptionRange{-100, 100},
           "the vehicle's measured point in the body frame, forward"},
          {"lever_y", "0", "m", OptionRange{-100, 100},
           "the vehicle's measured point in the body frame, to the left"}};
}

class Lane final : public SensorModel {
 public:
  explicit Lane(const CheckedOptions& options)
      : sigma_(options.number("sigma")), lever_(options.number("lever_x"), options.number("lever_y")) {}

  void extend(const SensorInput& input, Graph& graph) override {
    const SensorTable& readings = input.readings;
    for (std::size_t row = 0; row < readings.size(); ++row) {
      const double sigma = sigma_of_reading(readings, row, kSigma, "sigma", sigma_);
      const auto length = [&](Column column, const char* name) {
        return number_of_reading(readings, row, column, name, kLargestLength_m);
      };
      const Eigen::Vector2d a(length(kAx, "ax"), length(kAy, "ay"));
      const Eigen::Vector2d b(length(kBx, "bx"), length(kBy, "by"));
      const double offset = length(kOffset, "offset");
      if (a == b) fail_reading(readings, row, "bx", "a and b are one point: they give no line");
      const auto place = find_place(input.nodes, readings.stamps[row]);
      if (!place) continue;
      EdgeLateralOffset edge;
      edge.offset = grid_scale_at(input, readings.stamps[row]) * offset;
      edge.point = a;
      edge.heading = std::atan2(b[1] - a[1], b[0] - a[0]);
      edge.lever = place->ahead.position + rotate(place->ahead.heading, lever_);
      graph.add_edge(edge, {place->pose}, Eigen::Matrix<double, 1, 1>(1 / (sigma * sigma)));
    }
  }

 private:
  double sigma_ = 0;
  Eigen::Vector2d lever_{0, 0};
};

void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeLateralOffset>();
  registry.add_sensor_model({"lane", "lateral offsets to straight lines of a map", columns(), options(),
                             [](const CheckedOptions& options) { return std::make_unique<Lane>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::lane

WAYMARK_PLUGIN(lane, "0.1.0", waymark::plugins::lane::register_types);
