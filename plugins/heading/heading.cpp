#include <waymark/plugins/heading/heading.hpp>

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::heading {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Of the states of an offset that wanders. In this time it stays what it is.
constexpr std::int64_t kPeriod_ns = 500'000'000;
constexpr const char* kOffset = "offset";
constexpr const char* kWandering = "wandering";

enum Column : std::size_t { kHeading, kSigma };

std::vector<SensorColumn> columns() {
  return {{"heading", "rad", "ccw_from_east", true, "direction in which the sensor points"},
          {"sigma", "rad", "", false, "standard deviation of the direction"}};
}

std::vector<OptionInfo> options() {
  return {
      {"mount_deg", "0", "deg", OptionRange{-360, 360},
       "direction of the sensor's zero in the body, counter-clockwise from straight ahead"},
      {"sigma_deg", "1", "deg", OptionRange{1e-4, 180}, "sigma of readings that state none"},
      {kOffset, kWandering, "", OptionWords{kWandering, "constant", "off"},
       "offset of all readings of the drive, beside mount_deg: 'constant' (estimated), 'wandering' about such a "
       "constant, or 'off' (0)"},
      {"offset_sigma_deg", "5", "deg", OptionRange{1e-4, 1000}, "sigma of the prior of the constant about 0"},
      {"wander_sigma_deg", "1", "deg", OptionRange{1e-3, 180}, "sigma of an offset that wanders",
       NoisePrior{.mean = 1, .deviation = 1.5, .where_option = kOffset, .where_word = kWandering}},
      {"wander_time", "60", "s", OptionRange{1, 1e5}, "correlation time of an offset that wanders",
       NoisePrior{.mean = 60, .deviation = 1, .where_option = kOffset, .where_word = kWandering}}};
}

class Heading final : public SensorModel {
 public:
  explicit Heading(const CheckedOptions& options)
      : mounting_(kDegree * options.number("mount_deg")),
        sigma_(kDegree * options.number("sigma_deg")),
        estimates_offset_(options.word(kOffset) != "off"),
        offset_sigma_(kDegree * options.number("offset_sigma_deg")) {
    if (options.word(kOffset) == kWandering)
      wander_.emplace(kDegree * options.number("wander_sigma_deg"), options.number("wander_time"));
  }

  void extend(const SensorInput& input, Graph& graph) override {
    const VertexIndex offset =
        estimates_offset_ ? offset_.in_or(graph, [&] { return add_offset(graph); }) : -1;
    for (std::size_t row = 0; row < input.readings.size(); ++row) {
      const double sigma = sigma_of_reading(input.readings, row, kSigma, "sigma", sigma_);
      const double reading = number_of_reading(input.readings, row, kHeading, "heading", kLargestAngle_rad);
      const auto place = find_place(input.nodes, input.readings.stamps[row]);
      if (!place) continue;
      const double measured = wrap_angle(reading - mounting_ - place->ahead.heading);
      const Eigen::Matrix<double, 1, 1> information(1 / (sigma * sigma));
      if (wander_) {
        const VertexIndex wander = wander_->at(begin_of_period(input.readings.stamps[row]), graph);
        graph.add_edge(EdgeHeadingWandering{measured}, {place->pose, offset, wander}, information);
      } else if (estimates_offset_) {
        graph.add_edge(EdgeHeadingOffset{measured}, {place->pose, offset}, information);
      } else {
        graph.add_edge(EdgeHeading{measured}, {place->pose}, information);
      }
    }
  }

 private:
  [[nodiscard]] VertexIndex add_offset(Graph& graph) const {
    const VertexIndex offset = graph.add_vertex<VertexHeadingOffset>(graph.free_id(), {0});
    add_prior_about_zero(graph, offset, offset_sigma_);
    return offset;
  }

  static Stamp begin_of_period(Stamp stamp) {
    const std::int64_t after = stamp.nanoseconds % kPeriod_ns;
    return Stamp{stamp.nanoseconds - (after < 0 ? after + kPeriod_ns : after)};
  }

  double mounting_ = 0;
  double sigma_ = 0;
  bool estimates_offset_ = false;
  double offset_sigma_ = 0;
  KeptVertex offset_;
  std::optional<GaussMarkovProcess<VertexHeadingWander, EdgeHeadingWanderDecay, EdgeHeadingWanderBetween>>
      wander_;
};

void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexHeadingOffset>();
  registry.add_vertex<VertexHeadingWander>();
  registry.add_edge<EdgeHeading>();
  registry.add_edge<EdgeHeadingOffset>();
  registry.add_edge<EdgeHeadingWandering>();
  registry.add_edge<EdgeHeadingWanderDecay>();
  registry.add_edge<EdgeHeadingWanderBetween>();
  registry.add_sensor_model(
      {"heading", "absolute heading of a dual antenna or a compass", columns(), options(),
       [](const CheckedOptions& options) { return std::make_unique<Heading>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::heading

WAYMARK_PLUGIN(heading, "0.1.0", waymark::plugins::heading::register_types);
