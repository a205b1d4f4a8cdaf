#include <waymark/plugins/heading/heading.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
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

/// The vehicle's way from one fix to another one, long enough to have a direction.
struct Chord {
  Stamp middle;
  double course_rad = 0;
};

/// Returns chords one after another, of the first receiver. @param fixes sorted by stamp
std::vector<Chord> chords_of(std::span<const Fix> fixes) {
  constexpr double kLeast_m = 10;
  constexpr double kAccuracies = 5;
  constexpr double kLongest_s = 10;
  std::vector<Chord> chords;
  std::size_t from = 0;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    if (fixes[i].source != fixes[from].source) continue;
    const double dt = seconds_between(fixes[from].stamp, fixes[i].stamp);
    const Eigen::Vector2d way = fixes[i].position - fixes[from].position;
    if (dt <= kLongest_s && way.norm() < std::max(kLeast_m, kAccuracies * fixes[i].accuracy_m())) continue;
    if (dt <= kLongest_s) chords.push_back({fixes[from].stamp.later(0.5 * dt), std::atan2(way.y(), way.x())});
    from = i;
  }
  return chords;
}

/// Of the turns between the chords of fixes, those that the readings make as well, and those that they make to the
/// other side.
struct TurnsBesideFixes {
  std::size_t same = 0;
  std::size_t against = 0;
};

TurnsBesideFixes turns_beside(std::span<const Fix> fixes, const SensorTable& readings) {
  constexpr double kLeast_rad = 20 * kDegree;
  constexpr double kMost_rad = 150 * kDegree;  // beyond it, or in reverse, no side is told
  constexpr double kLongest_s = 10;            // between the chords
  constexpr double kNear_s = 1;
  const auto reading_at = [&](Stamp stamp) -> std::optional<double> {
    const auto after = std::lower_bound(readings.stamps.begin(), readings.stamps.end(), stamp);
    if (after == readings.stamps.end() || std::abs(seconds_between(stamp, *after)) > kNear_s)
      return std::nullopt;
    return readings.at(static_cast<std::size_t>(after - readings.stamps.begin()), kHeading);
  };
  const auto is_turn = [&](double angle) {
    return std::abs(angle) > kLeast_rad && std::abs(angle) < kMost_rad;
  };
  const std::vector<Chord> chords = chords_of(fixes);
  TurnsBesideFixes turns;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    if (seconds_between(chords[i - 1].middle, chords[i].middle) > kLongest_s) continue;
    const auto before = reading_at(chords[i - 1].middle);
    const auto after = reading_at(chords[i].middle);
    if (!before || !after) continue;
    const double of_fixes = wrap_angle(chords[i].course_rad - chords[i - 1].course_rad);
    const double of_readings = wrap_angle(*after - *before);
    if (!is_turn(of_fixes) || !is_turn(of_readings)) continue;
    ++((of_fixes > 0) == (of_readings > 0) ? turns.same : turns.against);
  }
  return turns;
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

  /// A compass that counts the other way round would bend the whole drive.
  void check_drive(std::span<const Fix> fixes, const SensorTable& readings) const override {
    constexpr std::size_t kFewest = 8;
    constexpr std::size_t kTimes = 4;
    const TurnsBesideFixes turns = turns_beside(fixes, readings);
    if (turns.against < kFewest || turns.against < kTimes * turns.same) return;
    throw InputError(
        "the headings turn against the fixes, in " + std::to_string(turns.against) + " of " +
        std::to_string(turns.against + turns.same) +
        " turns: state the 'convention' of the column 'heading' the other way round (clockwise from "
        "north, or counter-clockwise from east)");
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
