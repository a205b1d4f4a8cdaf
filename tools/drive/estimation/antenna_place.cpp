#include <waymark/tools/drive/estimation/antenna_place.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

#include <nlopt.h>
#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/estimation/trial_drive.hpp>

namespace waymark::drive {
namespace {

/// An antenna ahead and to the left, m, and a delay of the fixes, s.
using PlaceAndDelay = Eigen::Vector3d;

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
  const PlaceAndDelay first(0.5, 0.5, 0.05);
  const PlaceAndDelay near(0.01, 0.01, 0.001);
  Minimum least;
  PlaceSearch search{trial};
  nlopt_opt bobyqa = nlopt_create(NLOPT_LN_BOBYQA, 3);
  nlopt_set_min_objective(bobyqa, cost_of_place, &search);
  nlopt_set_lower_bounds(bobyqa, low.data());
  nlopt_set_upper_bounds(bobyqa, bounds.data());
  nlopt_set_initial_step(bobyqa, first.data());
  nlopt_set_xtol_abs(bobyqa, near.data());
  nlopt_set_maxeval(bobyqa, kMostEvaluations);
  nlopt_optimize(bobyqa, least.at.data(), &least.cost);  // its best values stand whatever ends it
  nlopt_destroy(bobyqa);
  if (search.thrown) std::rethrow_exception(search.thrown);
  return least;
}

/// Returns the second derivatives of the cost by central differences.
Eigen::Matrix3d curvature_at(const Minimum& minimum, const PlaceAndDelay& steps, TrialDrive& trial) {
  const auto& [at, here] = minimum;
  Eigen::Matrix3d curvature;
  Eigen::Vector3d after;
  for (int i = 0; i < 3; ++i) {
    const PlaceAndDelay step = steps[i] * PlaceAndDelay::Unit(i);
    after[i] = cost_at(at + step, trial);
    curvature(i, i) = (cost_at(at - step, trial) - 2 * here + after[i]) / (steps[i] * steps[i]);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const double both =
          cost_at(at + steps[i] * PlaceAndDelay::Unit(i) + steps[j] * PlaceAndDelay::Unit(j), trial);
      // Each step alone costs its slope and half its curvature; what is left over both is the product of them.
      const double cross = (both - after[i] - after[j] + here) / (steps[i] * steps[j]);
      curvature(i, j) = curvature(j, i) = cross;
    }
  }
  return curvature;
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
                     [](const Fix& fix) { return fix.antenna_m == Eigen::Vector2d::Zero(); });
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
  constexpr double kSigmas = 4;
  constexpr double kLeast_m = 0.1;
  constexpr double kFarthest_m = 10;
  constexpr double kLatest_s = 1;
  if (!may_be_found(placed, settings)) return std::nullopt;
  TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s), kWindows, kWindow_s),
                   settings, registry, between);
  const double unmoved = cost_at(PlaceAndDelay::Zero(), trial);
  const PlaceAndDelay bounds(kFarthest_m, kFarthest_m, kLatest_s);
  const Minimum least = least_of(bounds, trial);
  const bool is_inside = (least.at.cwiseAbs().array() < 0.9 * bounds.array()).all();
  const double spread = trial.spread(least.cost);
  const double size_m = least.at.head<2>().norm();
  if (!(unmoved - least.cost > kGain * spread * spread) || !(size_m > kLeast_m) || !is_inside)
    return std::nullopt;
  const Eigen::Matrix3d covariance =
      spread * spread * curvature_at(least, steps_of(trial.drive()), trial).inverse();
  const AntennaPlace antenna{least.at.head<2>(), covariance.diagonal().head<2>().cwiseSqrt()};
  const Eigen::Vector2d direction = antenna.place_m / size_m;
  const double sigma_m = std::sqrt(direction.dot(covariance.topLeftCorner<2, 2>() * direction));
  if (!antenna.sigma_m.allFinite() || !(size_m > kSigmas * sigma_m)) return std::nullopt;
  return antenna;
}

}  // namespace waymark::drive
