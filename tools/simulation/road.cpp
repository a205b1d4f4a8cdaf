#include <waymark/tools/simulation/road.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/core/base/angle.hpp>
#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {
namespace {

constexpr double kTick = 1.0 / kTicksPerSecond;
constexpr double kParkedAtStart = 8;    // s
constexpr double kCornerSpread = 8;     // deg, deviation of corners from 90
constexpr double kSpeedResponse = 0.6;  // s, of the driver to the wanted speed
constexpr double kPedalResponse = 0.3;  // s, of the vehicle to the driver
constexpr double kWanderTau = 20;       // s
constexpr double kHalting = 0.3;        // m/s; below it the vehicle comes to rest evenly

/// A piece of the way with one law of curvature.
struct Piece {
  double start_m = 0;
  double length_m = 0;
  double peak_curvature = 0;  // 1/m, signed; 0: straight
  double speed_mps = 0;       // upper limit of the speed on it
  double stop_s = 0;          // the vehicle stops at its end for this time
  bool canyon = false;

  [[nodiscard]] double end_m() const { return start_m + length_m; }
  [[nodiscard]] double curvature(double way_m) const {
    if (peak_curvature == 0) return 0;
    const double s = std::sin(std::numbers::pi * (way_m - start_m) / length_m);
    return peak_curvature * s * s;
  }
};

/// Builds the way leg by leg, as far as the driver must see.
class Way {
 public:
  Way(std::uint64_t seed, double cruise_factor) : random_(seed, kRoadStream), cruise_factor_(cruise_factor) {}

  /// @param road the road of legs that begin from now on
  void extend_to(double way_m, const RoadRecipe& road) {
    while (end_m_ < way_m) add_leg(road);
  }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  void add_leg(const RoadRecipe& road) {
    // Everything that a leg may need is drawn, used or not. So probabilities and lengths can be
    // tuned without a different road.
    const double length = random_.uniform(road.leg_min_m, road.leg_max_m);
    const double cruise = cruise_factor_ * random_.uniform(road.cruise_min_mps, road.cruise_max_mps);
    const bool canyon = random_.uniform() < road.canyon_probability;
    const bool corner = random_.uniform() < road.corner_probability;
    const bool stop = random_.uniform() < road.stop_probability;
    const double corner_deg = 90 + kCornerSpread * random_.normal();
    const double corner_sense = random_.uniform() < 0.5 ? -1 : 1;
    const double stop_s = random_.uniform(road.stop_min_s, road.stop_max_s);

    const double end = end_m_ + length;
    while (end_m_ < end) {
      const double straight = std::min(road.straight_m * random_.exponential(), end - end_m_);
      const double angle = road.bend_sigma_deg * kDegree * random_.normal();
      const double radius = random_.uniform(road.bend_radius_min_m, road.bend_radius_max_m);
      add_piece(straight, 0, cruise, canyon);
      if (end_m_ < end) add_turn(angle, radius, cruise, canyon, road);
    }
    if (stop) pieces_.back().stop_s = stop_s;
    if (corner) add_turn(corner_sense * corner_deg * kDegree, road.corner_radius_m, cruise, canyon, road);
  }

  void add_turn(double angle, double radius, double cruise, bool canyon, const RoadRecipe& road) {
    const double speed = std::min(cruise, std::sqrt(road.lateral_acceleration_mps2 * radius));
    add_piece(2 * std::abs(angle) * radius, std::copysign(1 / radius, angle), speed, canyon);
  }

  void add_piece(double length, double peak_curvature, double speed, bool canyon) {
    if (length <= 0) return;
    pieces_.push_back({end_m_, length, peak_curvature, speed, 0, canyon});
    end_m_ += length;
  }

  RandomStream random_;
  double cruise_factor_;
  double end_m_ = 0;
  std::vector<Piece> pieces_;
};

class Driver {
 public:
  Driver(std::uint64_t seed, double cruise_factor)
      : way_(seed, cruise_factor),
        traffic_(seed, kTrafficStream),
        heading_(std::numbers::pi * traffic_.uniform(-1, 1)) {}

  DrivenState step(const RoadRecipe& road) {
    const double horizon = 50 + speed_ * speed_ / (2 * road.deceleration_mps2);
    way_.extend_to(way_m_ + horizon, road);
    while (way_.pieces()[at_].end_m() <= way_m_ && !stop_ahead(at_)) ++at_;
    const Piece& piece = way_.pieces()[at_];
    const double curvature = piece.curvature(std::min(way_m_, piece.end_m()));
    const DrivenState state{way_m_, speed_, curvature * speed_, heading_, piece.canyon};
    const double speed = next_speed(road);
    const double moved = 0.5 * (speed_ + speed) * kTick;
    heading_ += moved * piece.curvature(std::min(way_m_ + 0.5 * moved, piece.end_m()));
    way_m_ += moved;
    speed_ = speed;
    return state;
  }

 private:
  [[nodiscard]] bool stop_ahead(std::size_t piece) const {
    return way_.pieces()[piece].stop_s > 0 && stopped_at_ != piece;
  }

  /// Returns the smallest of the speeds that the pieces up to the horizon allow here.
  [[nodiscard]] double wanted_speed(const RoadRecipe& road, double wander) const {
    const std::vector<Piece>& pieces = way_.pieces();
    const double brake = road.deceleration_mps2;
    const double horizon = way_m_ + 50 + speed_ * speed_ / (2 * brake);
    double wanted = pieces[at_].speed_mps * wander;
    for (std::size_t i = at_; i < pieces.size() && pieces[i].start_m < horizon; ++i) {
      const double before = std::max(0.0, pieces[i].start_m - way_m_);
      const double limit = pieces[i].speed_mps * wander;
      wanted = std::min(wanted, std::sqrt(limit * limit + 2 * brake * before));
      if (!stop_ahead(i)) continue;
      wanted = std::min(wanted, std::sqrt(2 * brake * std::max(0.0, pieces[i].end_m() - way_m_)));
      break;
    }
    return wanted;
  }

  double next_speed(const RoadRecipe& road) {
    if (ticks_++ % kTicksPerSecond == 0) wander_value_ = wander_.next(1, traffic_);
    if (standing_s_ > 0) {
      standing_s_ -= kTick;
      return 0;
    }
    const double wanted = wanted_speed(road, std::max(0.5, 1 + road.speed_wander * wander_value_));
    const double pedal =
        std::clamp((wanted - speed_) / kSpeedResponse, -1.5 * road.deceleration_mps2, road.acceleration_mps2);
    acceleration_ += (pedal - acceleration_) * kTick / kPedalResponse;
    double speed = std::max(0.0, speed_ + acceleration_ * kTick);
    if (stop_ahead(at_) && speed_ < kHalting && way_.pieces()[at_].end_m() - way_m_ < kHalting)
      speed = std::max(0.0, speed_ - 0.5 * road.deceleration_mps2 * kTick);
    if (speed == 0 && stop_ahead(at_)) {
      standing_s_ = way_.pieces()[at_].stop_s;
      stopped_at_ = at_;
      acceleration_ = 0;
    }
    return speed;
  }

  Way way_;
  RandomStream traffic_;
  GaussMarkov wander_{kWanderTau};
  double wander_value_ = 0;
  std::int64_t ticks_ = 0;
  std::size_t at_ = 0;  // piece
  std::size_t stopped_at_ = static_cast<std::size_t>(-1);
  double standing_s_ = kParkedAtStart;
  double way_m_ = 0;
  double speed_ = 0;
  double acceleration_ = 0;
  double heading_;
};

/// Returns the road that a tick belongs to.
const RoadRecipe& road_at(const SimulationRecipe& recipe, double share_of_duration) {
  double total = 0;
  for (const RoadRecipe& road : recipe.roads) total += road.share;
  double until = 0;
  for (const RoadRecipe& road : recipe.roads) {
    until += road.share / total;
    if (share_of_duration < until) return road;
  }
  return recipe.roads.back();
}

}  // namespace

std::vector<DrivenState> drive_roads(const SimulationRecipe& recipe, std::uint64_t seed, std::int64_t ticks,
                                     double cruise_factor) {
  Driver driver(seed, cruise_factor);
  std::vector<DrivenState> states;
  states.reserve(static_cast<std::size_t>(ticks));
  for (std::int64_t t = 0; t < ticks; ++t) {
    states.push_back(driver.step(road_at(recipe, static_cast<double>(t) / static_cast<double>(ticks))));
  }
  return states;
}

std::vector<DrivenState> drive_distance(const SimulationRecipe& recipe, std::uint64_t seed,
                                        std::int64_t ticks) {
  constexpr double kTolerance = 0.002;
  constexpr int kTries = 14;
  std::vector<DrivenState> best = drive_roads(recipe, seed, ticks, 1);
  if (recipe.distance_m <= 0) return best;
  const auto off = [&](const std::vector<DrivenState>& states) {
    return states.back().way_m / recipe.distance_m - 1;
  };
  // A higher speed does not always give a longer distance (one red light more or less), so the best
  // result of the bisection is kept.
  double low = 0.2;
  double high = 5;
  double factor = 1;
  double error = off(best);
  for (int i = 0; i < kTries && std::abs(off(best)) > kTolerance; ++i) {
    (error > 0 ? high : low) = factor;
    factor = std::sqrt(low * high);
    std::vector<DrivenState> states = drive_roads(recipe, seed, ticks, factor);
    error = off(states);
    if (std::abs(error) < std::abs(off(best))) best = std::move(states);
  }
  return best;
}

}  // namespace waymark::simulation
