/// Compares two fleets of the same drives: which drives got worse, and whether the fleet did.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <waymark/tools/fleet/table/fleet_table.hpp>

namespace waymark::fleet {

/// When a drive counts as changed. Both limits must be exceeded: a percentage alone would count
/// millimetres of a good drive, a length alone would miss what matters to it.
struct RegressionRule {
  double percent = 5;
  double length_m = 0.02;
  /// A difference up to this is a tie in the test of the whole fleet: rounding of another compiler.
  double tie_m = 1e-4;
  double level = 0.05;  ///< of that test

  [[nodiscard]] std::string in_words() const;
};

enum class Change {
  worse,
  better,
  same,
  lost,     ///< had a minimum, and has none now: the worst change
  gained,   ///< the other way round
  unjudged  ///< no error in one of the fleets, or not of one measure
};
[[nodiscard]] std::string to_string(Change change);

/// One drive with one modeling in both fleets.
struct PairedDrive {
  std::string drive;
  std::string modeling;
  std::string environment;  ///< as in the newer fleet, if it states one
  std::string measure;      ///< of the errors: "truth" or "held-out fixes"
  double old_error_m = evaluation::kUndefined;
  double new_error_m = evaluation::kUndefined;
  Change change = Change::unjudged;
  std::string reason{};  ///< for a drive that was lost or gained

  [[nodiscard]] double ratio() const { return new_error_m / old_error_m; }
};

/// The change of a group of pairs.
struct ChangeOfGroup {
  std::size_t worse = 0;  ///< with those that were lost
  std::size_t better = 0;
  std::size_t same = 0;
  std::size_t unjudged = 0;
  std::size_t grew = 0;    ///< errors that grew by more than a tie
  std::size_t shrank = 0;  ///< that shrank by more than a tie
  /// Two-sided exact sign test: the chance that so uneven a split of those comes from equally many both
  /// ways. 1 if there are none.
  double chance = 1;
  double median_ratio = evaluation::kUndefined;  ///< new error over old one
  double ratio_low = evaluation::kUndefined;     ///< 95 % interval of the median, free of a distribution
  double ratio_high = evaluation::kUndefined;
};

enum class FleetChange { none, worse, better };

struct Regression {
  RegressionRule rule;
  std::string old_label;
  std::string new_label;
  std::vector<PairedDrive> pairs;  ///< ordered by drive and modeling
  std::vector<std::string> only_old;
  std::vector<std::string> only_new;
  ChangeOfGroup all;
  std::vector<std::pair<std::string, ChangeOfGroup>> environments;  ///< by name, if there are several

  /// The fleet got worse if a drive was lost on balance, or if the test rejects chance and more errors grew.
  [[nodiscard]] FleetChange fleet() const;
};

/// Pairs drives by name and modeling. @throws InputError if the fleets have no drive in common
[[nodiscard]] Regression compare_fleets(const Fleet& before, const Fleet& now, const RegressionRule& rule);

/// Returns the probability that of n fair coins at most min(k, n - k) or at least max(k, n - k) show heads.
[[nodiscard]] double sign_test(std::size_t k, std::size_t n);

/// Returns 95 % bounds of the median of the distribution that ascending values are drawn from: the order
/// statistics whose binomial coverage is at least 95 %. Undefined for fewer than six values.
/// Source: W. J. Conover, Practical Nonparametric Statistics, confidence interval for a quantile.
[[nodiscard]] std::pair<double, double> median_interval(std::span<const double> ascending);

}  // namespace waymark::fleet
