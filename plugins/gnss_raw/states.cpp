#include <waymark/plugins/gnss_raw/detail/states.hpp>

#include <array>
#include <cmath>

#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

namespace waymark::plugins::gnss_raw {
namespace {

constexpr double kMillisecond_m = kLight_mps / 1000;
/// Nothing is known of the first clock.
constexpr double kAnyClock = 1e6;
/// Heights on the Earth.
constexpr double kAnyHeight_m = 3000;
/// After so many times its duration a lasting error is forgotten.
constexpr double kForgotten = 5;
/// Orbits are broadcast anew every one or two hours, and the ionosphere changes as slowly.
constexpr double kSlow_s = 3600;
constexpr double kSlowPeriod_s = 120;

}  // namespace

// A receiver that lets its clock run to a millisecond sets it back; all pseudoranges then jump by 300 km.
// Nothing else moves them alike by more than half of that between two epochs.
void States::absorb_steps(Stamp stamp, double offset_m) {
  if (!last_offset_) {
    absorbed_m_ = kMillisecond_m * std::round(offset_m / kMillisecond_m);
    last_offset_ = {stamp, offset_m - absorbed_m_};
    return;
  }
  const double dt = seconds_between(last_offset_->first, stamp);
  const double expected = last_offset_->second + drift_mps_ * dt;
  absorbed_m_ = kMillisecond_m * std::round((offset_m - expected) / kMillisecond_m);
  const double offset = offset_m - absorbed_m_;
  if (dt >= 1) {  // nearer epochs tell the drift too roughly
    drift_mps_ = (offset - last_offset_->second) / dt;
    last_offset_ = {stamp, offset};
  }
}

VertexIndex States::clock(Stamp stamp, double offset_m, Graph& graph) {
  if (!std::isnan(offset_m)) absorb_steps(stamp, offset_m);
  const VertexIndex last = clock_.in(graph);
  const double bias = std::isnan(offset_m) ? (last < 0 ? 0 : graph.value(last)[0]) : offset_m - absorbed_m_;
  const VertexIndex next =
      graph.add_vertex<VertexGnssClock>(graph.free_id(), {bias, last < 0 ? 0 : graph.value(last)[1]});
  graph.set_stamp(next, stamp);
  if (last < 0) {
    add_prior_about_zero(graph, next, kAnyClock);
  } else {
    const double dt = seconds_between(clock_stamp_, stamp);
    const double drift_variance = parameters_.drift_walk * parameters_.drift_walk * dt;
    const double bias_variance =
        parameters_.clock_walk * parameters_.clock_walk * dt + drift_variance * dt * dt / 12;
    graph.add_edge(EdgeGnssClockStep{dt}, {last, next},
                   Eigen::Matrix2d(Eigen::Vector2d(1 / bias_variance, 1 / drift_variance).asDiagonal()));
  }
  clock_stamp_ = stamp;
  return clock_.keep(next, graph);
}

VertexIndex States::system(int system, Graph& graph) {
  const bool is_first = systems_.empty() || (systems_.size() == 1 && systems_.contains(system));
  return systems_[system].in_or(graph, [&] {
    const VertexIndex made = graph.add_vertex<VertexGnssSystemBias>(graph.free_id(), {0});
    if (is_first) {
      graph.set_fixed(made, true);
    } else {
      add_prior_about_zero(graph, made, parameters_.system_bias_sigma_m);
    }
    return made;
  });
}

VertexIndex LastingErrors::of(int system, int satellite, Stamp stamp, Graph& graph) {
  if (!parameters_.present) {
    return no_error_.in_or(graph, [&] {
      const VertexIndex made = graph.add_vertex<VertexGnssSatelliteBias>(graph.free_id(), {0});
      graph.set_fixed(made, true);
      return made;
    });
  }
  OfSatellite& error = satellites_[{system, satellite}];
  const VertexIndex last = error.vertex.in(graph);
  const double dt = seconds_between(error.since, stamp);
  constexpr double kJitter = 0.999;
  if (last >= 0 && dt < kJitter * parameters_.period_s) return last;
  const VertexIndex next = graph.add_vertex<VertexGnssSatelliteBias>(graph.free_id(), {0});
  graph.set_stamp(next, stamp);
  if (last < 0 || dt > kForgotten * parameters_.time_s) {
    add_prior_about_zero(graph, next, 1);
  } else {
    const double decay = std::exp(-dt / parameters_.time_s);
    graph.add_edge(EdgeGnssSatelliteBiasDecay{{decay}}, {last, next},
                   Eigen::Matrix<double, 1, 1>(1 / (1 - decay * decay)));
  }
  error.since = stamp;
  return error.vertex.keep(next, graph);
}

std::vector<OptionInfo> drive_state_options() {
  return {
      {"multipath_time", "30", "s", OptionRange{0.1, 1e4}, "how long a lasting error of a satellite lasts"},
      {"multipath_period", "1", "s", OptionRange{0.01, 1e3}, "time between two values of a lasting error"},
      {"clock_walk", "0.1", "m/sqrt(s)", OptionRange{1e-6, 1e6}, "wander of the clock's bias"},
      {"drift_walk", "0.1", "m/s/sqrt(s)", OptionRange{1e-6, 1e6}, "wander of the clock's drift"},
      {"height_walk", "0.1", "m/sqrt(s)", OptionRange{1e-6, 100}, "wander of the antenna's height"},
      {"height_period", "5", "s", OptionRange{0.1, 1e4}, "time between two heights"},
      {"system_bias_sigma", "20", "m", OptionRange{1e-3, 1e6},
       "sigma of the prior of a system's bias about 0"}};
}

States::Parameters read_states(const CheckedOptions& options) {
  return {
      .height = {.model = StateModel::random_walk,
                 .prior_sigma = kAnyHeight_m,
                 .walk_sigma = options.number("height_walk"),
                 .period_s = options.number("height_period")},
      .clock_walk = options.number("clock_walk"),
      .drift_walk = options.number("drift_walk"),
      .system_bias_sigma_m = options.number("system_bias_sigma"),
      .multipath = {.present = options.number("multipath_sigma") > 0,
                    .time_s = options.number("multipath_time"),
                    .period_s = options.number("multipath_period")},
      .slow = {.present = options.number("slow_sigma") > 0, .time_s = kSlow_s, .period_s = kSlowPeriod_s}};
}

}  // namespace waymark::plugins::gnss_raw
