#include <waymark/tools/drive/trials/antenna_place.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <nlopt.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

/// An antenna ahead and to the left of where it is taken to be, m, and a delay of the fixes, s.
using PlaceAndDelay = Eigen::Vector3d;

/// The first steps of a search.
const PlaceAndDelay kFirst(0.5, 0.5, 0.05);

double cost_at(const PlaceAndDelay& at, TrialDrive& trial) {
  return trial.cost_with([&](PlacedDrive& drive) {
    for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
      drive.fixes[i].antenna_m += at.head<2>();
      drive.fixes[i].position += at[2] * trial.velocity_at(i);
    }
  });
}

struct Minimum {
  PlaceAndDelay at = PlaceAndDelay::Zero();
  double cost = 0;
};

struct PlaceSearch {
  TrialDrive& trial;
  std::exception_ptr thrown{};  // it must not fly through code in C
};

double cost_of_place(unsigned, const double* at, double*, void* data) {
  PlaceSearch& search = *static_cast<PlaceSearch*>(data);
  if (search.thrown) return std::numeric_limits<double>::max();
  try {
    const double cost = cost_at(Eigen::Map<const PlaceAndDelay>(at), search.trial);
    return std::isfinite(cost) ? cost : std::numeric_limits<double>::max();
  } catch (...) {
    search.thrown = std::current_exception();
    return std::numeric_limits<double>::max();
  }
}

/// Finds the least cost without derivatives (BOBYQA, Powell 2009): far from it the errors of precise fixes
/// cost the same wherever the antenna is.
Minimum least_of(const PlaceAndDelay& bounds, TrialDrive& trial) {
  constexpr int kMostEvaluations = 60;
  const PlaceAndDelay low = -bounds;
  const PlaceAndDelay near(0.01, 0.01, 0.001);
  Minimum least;
  PlaceSearch search{trial};
  nlopt_opt bobyqa = nlopt_create(NLOPT_LN_BOBYQA, 3);
  nlopt_set_min_objective(bobyqa, cost_of_place, &search);
  nlopt_set_lower_bounds(bobyqa, low.data());
  nlopt_set_upper_bounds(bobyqa, bounds.data());
  nlopt_set_initial_step(bobyqa, kFirst.data());
  nlopt_set_xtol_abs(bobyqa, near.data());
  nlopt_set_maxeval(bobyqa, kMostEvaluations);
  nlopt_optimize(bobyqa, least.at.data(), &least.cost);  // its best values stand whatever ends it
  nlopt_destroy(bobyqa);
  if (search.thrown) std::rethrow_exception(search.thrown);
  return least;
}

/// The cost about a place.
struct Slopes {
  Eigen::Vector3d gradient;
  Eigen::Matrix3d curvature;
};

/// Returns the derivatives of the cost by central differences.
Slopes slopes_at(const Minimum& minimum, const PlaceAndDelay& steps, TrialDrive& trial) {
  const auto& [at, here] = minimum;
  Slopes slopes;
  Eigen::Vector3d after;
  for (int i = 0; i < 3; ++i) {
    const PlaceAndDelay step = steps[i] * PlaceAndDelay::Unit(i);
    after[i] = cost_at(at + step, trial);
    const double before = cost_at(at - step, trial);
    slopes.gradient[i] = (after[i] - before) / (2 * steps[i]);
    slopes.curvature(i, i) = (before - 2 * here + after[i]) / (steps[i] * steps[i]);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const double both =
          cost_at(at + steps[i] * PlaceAndDelay::Unit(i) + steps[j] * PlaceAndDelay::Unit(j), trial);
      // Each step alone costs its slope and half its curvature; what is left over both is the product of them.
      const double cross = (both - after[i] - after[j] + here) / (steps[i] * steps[j]);
      slopes.curvature(i, j) = slopes.curvature(j, i) = cross;
    }
  }
  return slopes;
}

/// Tells whether no place within the bounds seems to make the fixes more probable by some half chi2: a parabola
/// through ten costs about here, where a search takes sixty, is not deep enough.
bool is_flat(const Slopes& slopes, const PlaceAndDelay& bounds, double gain) {
  const Eigen::Matrix3d within = 0.5 * bounds.cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::Matrix3d> factor(slopes.curvature + within);
  return factor.info() == Eigen::Success && 0.5 * slopes.gradient.dot(factor.solve(slopes.gradient)) < gain;
}

/// Returns steps of a fraction of the accuracy of the fixes.
PlaceAndDelay steps_of(const PlacedDrive& drive) {
  constexpr double kUsualSpeed_mps = 10;
  std::vector<double> accuracies;
  for (const Fix& fix : drive.fixes) accuracies.push_back(fix.accuracy_m());
  const double step_m = std::clamp(0.25 * upper_median(std::move(accuracies)), 0.02, 0.3);
  return {step_m, step_m, step_m / kUsualSpeed_mps};
}

bool may_be_found(const PlacedDrive& placed, const FusionSettings& settings) {
  return settings.lever_arm && !placed.fixes.empty() && placed.receivers.size() == 1 &&
         std::all_of(placed.fixes.begin(), placed.fixes.end(),
                     [&](const Fix& fix) { return fix.antenna_m == placed.fixes.front().antenna_m; });
}

}  // namespace

std::optional<AntennaPlace> find_antenna_place(const PlacedDrive& placed,
                                               std::span<const PreparedSensor> sensors,
                                               const FusionSettings& settings, const TypeRegistry& registry,
                                               const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 2;
  constexpr double kNodePeriod_s = 0.5;
  constexpr std::size_t kWindows = 12;
  constexpr double kWindow_s = 200;
  constexpr double kGain = 15;
  constexpr double kFlat = 0.5;  // of that
  constexpr double kSigmas = 4;
  constexpr double kLeast_m = 0.1;
  constexpr double kFarthest_m = 10;
  constexpr double kLatest_s = 1;
  if (!may_be_found(placed, settings)) return std::nullopt;
  TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s), kWindows, kWindow_s),
                   settings, registry, between);
  const double unmoved = cost_at(PlaceAndDelay::Zero(), trial);
  const PlaceAndDelay bounds(kFarthest_m, kFarthest_m, kLatest_s);
  const Minimum here{PlaceAndDelay::Zero(), unmoved};
  const double flat = kFlat * kGain * std::pow(trial.spread(unmoved), 2);
  if (is_flat(slopes_at(here, kFirst, trial), bounds, flat)) return std::nullopt;
  const Minimum least = least_of(bounds, trial);
  const bool is_inside = (least.at.cwiseAbs().array() < 0.9 * bounds.array()).all();
  const double spread = trial.spread(least.cost);
  const double size_m = least.at.head<2>().norm();
  if (!(unmoved - least.cost > kGain * spread * spread) || !(size_m > kLeast_m) || !is_inside)
    return std::nullopt;
  const Eigen::Matrix3d covariance =
      spread * spread * slopes_at(least, steps_of(trial.drive()), trial).curvature.inverse();
  const Eigen::Vector2d& taken_m = placed.fixes.front().antenna_m;
  const AntennaPlace antenna{taken_m + least.at.head<2>(), taken_m,
                             covariance.diagonal().head<2>().cwiseSqrt()};
  const Eigen::Vector2d direction = least.at.head<2>() / size_m;
  const double sigma_m = std::sqrt(direction.dot(covariance.topLeftCorner<2, 2>() * direction));
  if (!antenna.sigma_m.allFinite() || !(size_m > kSigmas * sigma_m)) return std::nullopt;
  return antenna;
}

std::string warning_of(const AntennaPlace& antenna, const std::string& receiver) {
  const auto side = [](double value, const char* positive, const char* negative) {
    return value < 0 ? negative : positive;
  };
  const Eigen::Vector2d& at = antenna.place_m;
  const std::string place = fmt::format(
      "{:.2f} +- {:.2f} m {} and {:.2f} +- {:.2f} m {} the point of the vehicle whose motion the odometry measures",
      std::abs(at.x()), antenna.sigma_m.x(), side(at.x(), "ahead of", "behind"), std::abs(at.y()),
      antenna.sigma_m.y(), side(at.y(), "to the left of", "to the right of"));
  const std::string cure = fmt::format("state 'antenna: [{:.2f}, {:.2f}]'", at.x(), at.y());
  if (antenna.taken_m == Eigen::Vector2d::Zero())
    return fmt::format(
        "the antenna of '{}' seems to be {}, but is fused as if it were there: {} for it, or the result is off by as "
        "much, and late or early in bends",
        receiver, place, cure);
  const bool is_mirrored = (antenna.taken_m.array() * at.array() < -0.04).any();
  return fmt::format(
      "the antenna of '{}' is stated at [{:.2f}, {:.2f}], but the drive shows it {}: check {}the point that it is measured from, or {}",
      receiver, antenna.taken_m.x(), antenna.taken_m.y(), place,
      is_mirrored ? "the signs (ahead and to the left are positive) and " : "", cure);
}

}  // namespace waymark::drive
