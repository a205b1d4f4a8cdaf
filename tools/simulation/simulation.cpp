#include <waymark/tools/simulation/simulation.hpp>

#include <cmath>

#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/simulation/road.hpp>
#include <waymark/tools/simulation/sensors.hpp>

namespace waymark::simulation {
namespace {

/// 2021-03-15 09:00:00 UTC on the GPS scale, a whole second: the start of simulated time.
constexpr Stamp kStart{1'299'834'018'000'000'000};

/// Maps the way on the ground into the frame: lengths are multiplied by the point scale
/// of the place.
class Placement {
 public:
  Placement(const std::vector<DrivenState>& states, const drive::Projection& projection)
      : states_(states), projection_(projection) {}

  /// Returns the vehicle at a tick. Ticks must not decrease.
  PlacedState at(std::size_t tick) {
    for (; tick_ < tick; ++tick_) advance();
    const DrivenState& state = states_[tick];
    return {{kStart.nanoseconds + static_cast<std::int64_t>(tick) * (1'000'000'000 / kTicksPerSecond)},
            {position_[0], position_[1], state.heading_rad},
            state.speed_mps,
            state.canyon};
  }

 private:
  void advance() {
    if (tick_ % kTicksPerSecond == 0)  // the scale changes by less than 1e-8 in a second
      scale_ = projection_.to_grid(projection_.to_geodetic(position_)).scale;
    const double moved = scale_ * (states_[tick_ + 1].way_m - states_[tick_].way_m);
    const double heading = 0.5 * (states_[tick_].heading_rad + states_[tick_ + 1].heading_rad);
    position_ += moved * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  }

  const std::vector<DrivenState>& states_;
  const drive::Projection& projection_;
  std::size_t tick_ = 0;
  double scale_ = 1;
  Eigen::Vector2d position_{0, 0};
};

std::vector<PlacedState> place_every(std::size_t step, const std::vector<DrivenState>& states,
                                     const drive::Projection& projection) {
  Placement placement(states, projection);
  std::vector<PlacedState> placed;
  for (std::size_t tick = 0; tick < states.size(); tick += step) placed.push_back(placement.at(tick));
  return placed;
}

/// Returns what the fixes of all whole seconds show, with their stamps. The fix of second 0 would
/// be before the first odometry sample and be dropped.
std::vector<PlacedState> place_epochs(double delay_s, const std::vector<DrivenState>& states,
                                      const drive::Projection& projection) {
  const auto late = static_cast<std::ptrdiff_t>(std::lround(delay_s * kTicksPerSecond));
  const auto ticks = static_cast<std::ptrdiff_t>(states.size());
  Placement placement(states, projection);
  std::vector<PlacedState> placed;
  for (std::ptrdiff_t tick = kTicksPerSecond; tick < ticks; tick += kTicksPerSecond) {
    if (tick - late < 0 || tick - late >= ticks) continue;
    placed.push_back(placement.at(static_cast<std::size_t>(tick - late)));
    placed.back().stamp.nanoseconds = kStart.nanoseconds + tick * (1'000'000'000 / kTicksPerSecond);
  }
  return placed;
}

}  // namespace

SimulatedDrive simulate(const SimulationRecipe& given, std::uint64_t seed) {
  const SimulationRecipe recipe = given.varied ? varied(given, seed) : given;
  check(recipe);
  SimulatedDrive drive;
  drive.name = "Simulated: " + recipe.name + ", seed " + std::to_string(seed);
  drive.seed = seed;
  drive.recipe = recipe;
  drive.frame = drive::choose_frame({recipe.start_latitude_deg, recipe.start_longitude_deg}, {}, {});
  const drive::Projection projection(drive.frame);

  const double step = kTicksPerSecond / recipe.odometry.rate_hz;
  const auto samples = std::llround(recipe.duration_s * recipe.odometry.rate_hz);
  const auto ticks = std::llround(static_cast<double>(samples) * step);
  const std::vector<DrivenState> states = drive_distance(recipe, seed, ticks);
  drive.distance_m = states.back().way_m;
  sense_odometry(states, kStart, drive);

  sense_gnss(place_epochs(recipe.gnss.delay_s, states, projection), projection, drive);
  const auto truth_step = static_cast<std::size_t>(std::lround(kTicksPerSecond / recipe.truth.rate_hz));
  sense_truth(place_every(truth_step, states, projection), projection, drive);
  return drive;
}

}  // namespace waymark::simulation
