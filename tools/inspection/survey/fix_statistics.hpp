/// Statistics of the fixes of one receiver.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// The inspection requests this as the default sigma. A fix with this sigma had no accuracy.
inline constexpr double kNoAccuracy = 999'999;  // m

/// A rectangle of latitudes and longitudes, degrees.
struct BoundingBox {
  Range latitude, longitude;

  [[nodiscard]] double height_m() const;  ///< south to north
  [[nodiscard]] double width_m() const;   ///< west to east, at the middle latitude
};

/// Sigma of one axis, 1 sigma, m.
struct SigmaSummary {
  double median = 0, percent95 = 0;
  Range range;
};

/// Numbers only; suspicions.hpp judges them.
struct FixSummary {
  std::size_t fixes = 0;
  StampSeries stamps;
  BoundingBox box;        ///< of the fixes at most 1000 km from the median position and not at 0/0
  Range height;           ///< m
  double distance_m = 0;  ///< sum of the distances between consecutive fixes, noise included
  std::map<FixQuality, std::size_t> qualities;
  std::map<FixQuality, std::size_t> without_accuracy;  ///< by quality
  Range satellites, hdop, correction_age_s;            ///< of the fixes that tell them
  std::size_t with_accuracy = 0;
  SigmaSummary east, north;
  bool accuracy_constant = false;  ///< all fixes have the same accuracy
  /// both axes of every fix have the same sigma, and are uncorrelated
  bool axes_equal = false;
  std::size_t with_speed = 0, with_course = 0;
  Range speed;    ///< m/s, measured by the receiver
  Sighting zero;  ///< positions at latitude and longitude 0
  Sighting far;   ///< more than 1000 km from the median position; amount: distance in m
  /// stretches of at least five equal positions; amount: length of the first one
  Sighting frozen;
  /// such stretches while the receiver's own speed was above 1 m/s
  Sighting frozen_moving;
  std::size_t repeated = 0;            ///< fixes at the position of their predecessor
  std::size_t repeated_in_frozen = 0;  ///< those of them in such stretches
  std::size_t speed_comparisons = 0;
  /// median of (speed of the receiver) / (distance / time between fixes); NaN: not compared
  double speed_factor = 0;
  /// step of the positions if it is a decimal one of at least 1 m; else 0
  double resolution_m = 0;
};

/// Returns the number of fixes without accuracy whose quality has a usual sigma (formats/logs/fix_quality.hpp).
[[nodiscard]] std::size_t fixes_with_usual_sigma(const FixSummary& fixes);
/// Returns these sigmas: "fixed 0.02 m, single 3 m x HDOP".
[[nodiscard]] std::string usual_sigmas(const FixSummary& fixes);

/// Takes fixes in the order of the log. Memory does not grow.
class FixStatistics {
 public:
  FixStatistics();
  void add(const GeodeticFix& fix);
  [[nodiscard]] FixSummary summary() const;

 private:
  /// A square of five degrees. The squares record roughly where fixes are, so that the end can tell
  /// which were far away.
  struct Cell {
    std::size_t count = 0;
    BoundingBox box;
    std::size_t line = 0;
    Stamp stamp;
  };
  void add_place(const GeodeticFix& fix);
  void add_way(const GeodeticFix& fix);
  void add_accuracy(const GeodeticFix& fix);
  void compare_speed(const GeodeticFix& fix);
  void end_run();

  FixSummary summary_;
  std::vector<Cell> cells_;
  EvenSample latitudes_, longitudes_;
  Quantiles sigma_east_, sigma_north_, speed_factors_;
  /// anchor: begin of the distance over which speeds are compared
  std::optional<GeodeticFix> last_, anchor_;
  double first_variance_ = 0;
  std::size_t run_ = 1;         ///< fixes at the last position
  std::size_t run_moving_ = 0;  ///< those of them above 1 m/s
  std::size_t run_line_ = 0;
  Stamp run_stamp_;
  /// all positions so far are multiples of the step in kSteps
  std::array<bool, 6> decimal_step_{};
};

/// Returns the metres between two places, on the sphere of the same area: exact to 0.6 %.
[[nodiscard]] double distance_m(double latitude_a, double longitude_a, double latitude_b, double longitude_b);

}  // namespace waymark::inspection
