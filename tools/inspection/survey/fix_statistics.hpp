/// What the fixes of one receiver are like.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/inspection/survey/running_statistics.hpp>

namespace waymark::inspection {

/// Asked for as the default sigma: a fix that has it came without an accuracy.
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

/// Numbers only; what is suspicious about them: suspicions.hpp.
struct FixSummary {
  std::size_t fixes = 0;
  StampSeries stamps;
  BoundingBox box;        ///< of the fixes within 1000 km of the median position and not at 0/0
  Range height;           ///< m
  double distance_m = 0;  ///< sum of the ways between neighbouring fixes, noise included
  std::size_t with_accuracy = 0;
  SigmaSummary east, north;
  bool accuracy_constant = false;  ///< all fixes have the same
  bool axes_equal = false;         ///< of every fix, and uncorrelated
  std::size_t with_speed = 0, with_course = 0;
  Range speed;               ///< m/s, the receiver's own
  Sighting zero;             ///< positions at latitude and longitude 0
  Sighting far;              ///< more than 1000 km from the median position; amount: m
  Sighting frozen;           ///< stretches of at least five equal positions; amount: the first one's length
  Sighting frozen_moving;    ///< such, while the receiver's own speed was above 1 m/s
  std::size_t repeated = 0;  ///< fixes at their predecessor's position
  std::size_t repeated_in_frozen = 0;  ///< of them in such stretches
  std::size_t speed_comparisons = 0;
  double speed_factor = 0;  ///< median of receiver's speed over way per time between fixes; NaN: not compared
  double resolution_m = 0;  ///< the step of the positions where it is a decimal one of at least 1 m; else 0
};

/// Takes fixes in the order of the log; memory does not grow.
class FixStatistics {
 public:
  FixStatistics();
  void add(const GeodeticFix& fix);
  [[nodiscard]] FixSummary summary() const;

 private:
  /// A square of five degrees: where fixes are, coarsely, so that at the end it is known which were far off.
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
  std::optional<GeodeticFix> last_, anchor_;  ///< anchor: begin of the way that speeds are compared over
  double first_variance_ = 0;
  std::size_t run_ = 1;         ///< fixes at the last position
  std::size_t run_moving_ = 0;  ///< of them above 1 m/s
  std::size_t run_line_ = 0;
  Stamp run_stamp_;
  std::array<bool, 6> decimal_step_{};  ///< whether all positions so far are multiples of kSteps
};

/// Metres between two places: on the sphere of the same area, within 0.6 %.
[[nodiscard]] double distance_m(double latitude_a, double longitude_a, double latitude_b, double longitude_b);

}  // namespace waymark::inspection
