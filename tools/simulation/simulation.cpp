#include <waymark/tools/simulation/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/simulation/road.hpp>
#include <waymark/tools/simulation/sensors/lasting_errors.hpp>
#include <waymark/tools/simulation/sensors/sensors.hpp>

namespace waymark::simulation {
namespace {

/// 2021-03-15 09:00:00 UTC on the GPS scale, a whole second: the start of simulated time.
constexpr Stamp kStart{1'299'834'018'000'000'000};

Stamp stamp_of(std::size_t tick) {
  return {kStart.nanoseconds + static_cast<std::int64_t>(tick) * (1'000'000'000 / kTicksPerSecond)};
}

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
    return {
        stamp_of(tick),       tick,        {position_[0], position_[1], state.heading_rad}, state.speed_mps,
        state.yaw_rate_radps, state.canyon};
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

/// Returns what the fixes of all epochs show, with their stamps. A fix before the first odometry
/// sample would be dropped, so there is no epoch at second 0.
std::vector<PlacedState> place_epochs(const GnssRecipe& recipe, const std::vector<DrivenState>& states,
                                      const drive::Projection& projection) {
  const auto late = static_cast<std::ptrdiff_t>(std::lround(recipe.delay_s * kTicksPerSecond));
  const auto first = static_cast<std::ptrdiff_t>(std::lround(recipe.first_s * kTicksPerSecond));
  const auto step = static_cast<std::ptrdiff_t>(std::lround(kTicksPerSecond / recipe.rate_hz));
  const auto ticks = static_cast<std::ptrdiff_t>(states.size());
  Placement placement(states, projection);
  std::vector<PlacedState> placed;
  for (std::ptrdiff_t tick = first; tick < ticks; tick += step) {
    if (tick - late < 0 || tick - late >= ticks) continue;
    placed.push_back(placement.at(static_cast<std::size_t>(tick - late)));
    placed.back().tick = static_cast<std::size_t>(tick);
    placed.back().stamp = stamp_of(placed.back().tick);
  }
  return placed;
}

void sense_all_odometry(const std::vector<DrivenState>& states, SimulatedDrive& drive) {
  const std::vector<OdometryRecipe> recipes = drive.recipe.all_odometry();
  for (std::size_t i = 0; i < recipes.size(); ++i)
    drive.further_odometry.push_back(
        sense_odometry(states, kStart, recipes[i], SourceStreams(drive.seed, i)));
  SimulatedOdometry& first = drive.further_odometry.front();
  drive.speed_scale = first.speed_scale;
  drive.gyro_bias_radps = first.gyro_bias_radps;
  drive.odometry = std::move(first.samples);
  drive.further_odometry.erase(drive.further_odometry.begin());
}

/// Returns the lasting errors that receivers have in common, at every tick; none if they share none.
LastingErrors common_errors(const SimulatedDrive& drive, std::size_t ticks) {
  const std::vector<GnssRecipe> recipes = drive.recipe.all_gnss();
  const auto shares = [](const GnssRecipe& recipe) { return recipe.common_share > 0; };
  if (std::none_of(recipes.begin(), recipes.end(), shares)) return {};
  return draw_lasting_errors(ticks, 1.0 / kTicksPerSecond, drive.recipe.gnss, {drive.seed, kCommonBiasStream},
                             {drive.seed, kCommonFastStream});
}

void sense_all_gnss(const std::vector<DrivenState>& states, const drive::Projection& projection,
                    SimulatedDrive& drive) {
  const LastingErrors common = common_errors(drive, states.size());
  const std::vector<GnssRecipe> recipes = drive.recipe.all_gnss();
  for (std::size_t i = 0; i < recipes.size(); ++i)
    drive.further_gnss.push_back(sense_gnss(place_epochs(recipes[i], states, projection), projection,
                                            recipes[i], common, SourceStreams(drive.seed, i)));
  SimulatedGnss& first = drive.further_gnss.front();
  drive.gnss_bias_m = first.bias_m;
  drive.fixes = std::move(first.fixes);
  drive.further_gnss.erase(drive.further_gnss.begin());
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
  sense_all_odometry(states, drive);
  sense_all_gnss(states, projection, drive);
  const auto truth_step = static_cast<std::size_t>(std::lround(kTicksPerSecond / recipe.truth.rate_hz));
  sense_truth(place_every(truth_step, states, projection), projection, drive);
  return drive;
}

}  // namespace waymark::simulation
