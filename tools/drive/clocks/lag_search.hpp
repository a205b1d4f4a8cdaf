/// Finds where odometry and GNSS of one drive fit together, whatever their clocks say.
#pragma once

#include <optional>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/clocks/gnss_motion.hpp>

namespace waymark::drive {

/// An odometry is silent between samples that are further apart than this, in s, and than 2.5 usual intervals.
inline constexpr double kLongestSilence_s = 1;

/// One alignment of the logs. If the odometry's stamps are reduced by late_s, they fit.
struct Lag {
  double late_s = 0;
  /// CommonMotion::score() of speed and of yaw rate, added
  double score = 0;
  double speed_correlation = 0;
  double turn_correlation = 0;
};

/// Compares alignments of odometry and GNSS.
class LagSearch {
 public:
  /// @param odometry sorted, two samples at least
  LagSearch(const std::vector<OdometrySample>& odometry, const GnssMotion& speeds, const GnssMotion& turns);

  /// Returns the best alignment on a grid of half a second in [from_s, to_s]. Empty if the logs nowhere share
  /// 20 readings.
  [[nodiscard]] std::optional<Lag> best(double from_s, double to_s) const;
  /// Returns the best of all alignments in which the logs share half a minute, if no other one (5 s away) is
  /// nearly as good. @param largest_s 0: any
  [[nodiscard]] std::optional<Lag> find(double largest_s) const;

 private:
  /// Means over any time, in constant time.
  struct Grid {
    std::vector<double> integral{0};

    void add(double value);
    [[nodiscard]] double mean(double from_s, double to_s) const;
    [[nodiscard]] double at(double time_s) const;
  };
  struct Reading {
    double from_s, to_s;  ///< after the first sample of the odometry
    double value;
    bool follows;  ///< the reading before it in about the usual time
  };

  void add(const GnssMotion& motion, Stamp first, std::vector<Reading>& readings) const;
  [[nodiscard]] double correlation(const Grid& grid, const std::vector<Reading>& readings, double late_s,
                                   double& score) const;
  [[nodiscard]] std::optional<Lag> at(double late_s) const;

  Grid speed_;
  Grid yaw_rate_;
  Grid silent_;  ///< 1 where the odometry has a gap
  std::vector<Reading> speeds_;
  std::vector<Reading> turns_;
  double length_s_ = 0;  ///< of the odometry
};

}  // namespace waymark::drive
