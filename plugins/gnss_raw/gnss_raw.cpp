#include <waymark/plugins/gnss_raw/gnss_raw.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>
#include <waymark/plugins/gnss_raw/detail/local_sky.hpp>
#include <waymark/plugins/gnss_raw/detail/noise.hpp>
#include <waymark/plugins/gnss_raw/detail/satellite_groups.hpp>
#include <waymark/plugins/gnss_raw/detail/single_point.hpp>
#include <waymark/plugins/gnss_raw/detail/states.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::gnss_raw {
namespace {

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = {
      {"antenna_x", "0", "m", OptionRange{-100, 100}, "antenna in the body frame, forward"},
      {"antenna_y", "0", "m", OptionRange{-100, 100}, "antenna in the body frame, to the left"},
      {"satellites_at", "transmission", "", OptionWords{"transmission", "reception"},
       "axes of the satellites' positions: those of the Earth when the signal leaves, 'transmission', or "
       "when it arrives, 'reception'"},
      {"systems", "all", "", OptionWords{"all", "gps"},
       "systems whose pseudoranges are used: 'all', or 'gps' alone"},
      {"range_rates", "on", "", OptionWords{"on", "off"}, "range rates are used, 'on', or left out, 'off'"}};
  for (OptionInfo& option : noise_options()) all.push_back(std::move(option));
  for (OptionInfo& option : drive_state_options()) all.push_back(std::move(option));
  return all;
}

/// The poses between which the velocity at a moment is the mean one.
struct Chord {
  std::size_t from = 0;
  std::size_t to = 1;
};

/// Returns the interval that contains a moment near a node. At a node itself the interval before counts,
/// so that the next part of a drive changes nothing.
std::optional<Chord> chord_at(const DriveNodes& nodes, std::size_t node, double ahead_s) {
  constexpr double kLongest_s = 0.5;
  constexpr double kAtNode_s = 1e-6;
  const bool after = node == 0 || (ahead_s > kAtNode_s && node + 1 < nodes.stamps.size());
  const Chord chord = after ? Chord{node, node + 1} : Chord{node - 1, node};
  if (chord.to >= nodes.stamps.size() || nodes.intervals[chord.from].dt_s > kLongest_s) return std::nullopt;
  return chord;
}

class GnssRaw final : public SensorModel {
 public:
  explicit GnssRaw(const CheckedOptions& options)
      : antenna_(options.number("antenna_x"), options.number("antenna_y")),
        turned_(options.word("satellites_at") == "reception"),
        gps_alone_(options.word("systems") == "gps"),
        uses_rates_(options.word("range_rates") == "on"),
        noise_(read_noise(options)),
        states_(read_states(options)) {}

  [[nodiscard]] std::vector<RoughPosition> rough_positions(const SensorTable& readings) const override {
    std::vector<RoughPosition> positions;
    Eigen::Vector3d guess = Eigen::Vector3d::Zero();
    for (const Epoch& epoch : epochs_of(readings)) {
      const auto solved = single_point(epoch, guess, turned_);
      if (!solved) continue;
      guess = solved->position;
      positions.push_back({epoch.stamp, solved->position, antenna_, std::max(3.0, solved->residual_m)});
    }
    return positions;
  }

  void extend(const SensorInput& input, Graph& graph) override {
    for (const Epoch& epoch : epochs_of(input.readings)) {
      const auto place = find_place(input.nodes, epoch.stamp);
      if (place && !epoch.satellites.empty()) add_epoch(epoch, *place, input, graph);
    }
  }

 private:
  void add_epoch(const Epoch& epoch, const ReadingPlace& place, const SensorInput& input, Graph& graph) {
    const auto guess = graph.value(place.pose);
    const VertexIndex height = states_.height(epoch.stamp, graph);
    const LocalSky sky({.position = {guess[0], guess[1]}, .height_m = graph.value(height)[0]}, turned_,
                       input.context.require_geodesy());
    const double offset_m = sky.common_offset_m(epoch);
    const VertexIndex clock = states_.clock(epoch.stamp, offset_m, graph);
    const Eigen::Vector2d antenna = place.ahead.position + rotate(place.ahead.heading, antenna_);
    const auto chord =
        chord_at(input.nodes, place.node, seconds_between(input.nodes.stamps[place.node], epoch.stamp));
    SatelliteGroups groups(input.groups);
    for (const SatelliteReading& reading : epoch.satellites) {
      if (!std::isnan(reading.pseudorange_m) && (!gps_alone_ || reading.system == kGps))
        groups.add_pseudorange(
            add_pseudorange(epoch.stamp, reading, sky, {place.pose, height, clock}, antenna, graph), reading,
            sky);
      if (!std::isnan(reading.range_rate_mps) && uses_rates_ && chord)
        groups.add_range_rate(add_range_rate(epoch.stamp, reading, sky, clock, *chord, input.nodes, graph),
                              reading, sky);
    }
  }

  EdgePlace add_pseudorange(Stamp stamp, const SatelliteReading& reading, const LocalSky& sky,
                            const std::array<VertexIndex, 3>& pose_height_clock,
                            const Eigen::Vector2d& antenna, Graph& graph) {
    const RangeNoise noise = noise_.of(reading);
    EdgeGnssPseudorange edge;
    edge.satellite = sky.local(reading.position);
    edge.measured = reading.pseudorange_m - states_.absorbed_m() - edge.satellite.norm();
    edge.reference = sky.reference();
    edge.ground = sky.ground();
    edge.antenna = antenna;
    edge.spread = noise.lasting_m;
    edge.slow_spread = noise.slow_m;
    edge.skew = noise_.reflection_skew();
    const auto [pose, height, clock] = pose_height_clock;
    return graph.add_edge(edge,
                          {pose, height, clock, states_.system(reading.system, graph),
                           states_.multipath().of(reading.system, reading.satellite, stamp, graph),
                           states_.slow().of(reading.system, reading.satellite, stamp, graph)},
                          Eigen::Matrix<double, 1, 1>(1 / (noise.white_m * noise.white_m)), noise_.tails());
  }

  EdgePlace add_range_rate(Stamp stamp, const SatelliteReading& reading, const LocalSky& sky,
                           VertexIndex clock, const Chord& chord, const DriveNodes& nodes, Graph& graph) {
    const Eigen::Vector3d satellite = sky.local(reading.position);
    const Eigen::Vector3d towards = satellite.normalized();
    const Eigen::Vector3d velocity = sky.local_velocity(reading.velocity, satellite.norm());
    EdgeGnssRangeRate edge;
    edge.measured = reading.range_rate_mps - towards.dot(velocity);
    edge.direction = towards.head<2>();
    edge.rate = sky.ground() / nodes.intervals[chord.from].dt_s;
    edge.antenna = antenna_;
    const double sigma = noise_.range_rate_sigma(reading, since_last_rate(reading, stamp));
    return graph.add_edge(edge, {nodes.poses[chord.from], nodes.poses[chord.to], clock},
                          Eigen::Matrix<double, 1, 1>(1 / (sigma * sigma)), noise_.tails());
  }

  /// Returns the time since the last range rate of a satellite, s; a long one for the first.
  double since_last_rate(const SatelliteReading& reading, Stamp stamp) {
    const auto [last, is_first] = last_rates_.try_emplace({reading.system, reading.satellite}, stamp);
    constexpr double kLong_s = 1e6;
    return is_first ? kLong_s : seconds_between(std::exchange(last->second, stamp), stamp);
  }

  Eigen::Vector2d antenna_;
  bool turned_;
  bool gps_alone_;
  bool uses_rates_;
  Noise noise_;
  States states_;
  std::map<std::pair<int, int>, Stamp> last_rates_;
};

/// A part of the time for which reflections last.
constexpr double kNoisePeriod_s = 5;

void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexGnssClock>();
  registry.add_vertex<VertexGnssHeight>();
  registry.add_vertex<VertexGnssSystemBias>();
  registry.add_vertex<VertexGnssSatelliteBias>();
  registry.add_edge<EdgeGnssClockStep>();
  registry.add_edge<EdgeGnssHeightWalk>();
  registry.add_edge<EdgeGnssSatelliteBiasDecay>();
  registry.add_edge<EdgeGnssPseudorange>();
  registry.add_edge<EdgeGnssRangeRate>();
  registry.add_sensor_model({"gnss_raw",
                             "pseudoranges and range rates of a GNSS receiver, with its clock",
                             raw_columns(),
                             options(),
                             [](const CheckedOptions& given) { return std::make_unique<GnssRaw>(given); },
                             "none",
                             {.period_s = kNoisePeriod_s, .options = {{"reflection_skew", "0"}}}});
}

}  // namespace
}  // namespace waymark::plugins::gnss_raw

WAYMARK_PLUGIN(gnss_raw, "0.1.0", waymark::plugins::gnss_raw::register_types);
