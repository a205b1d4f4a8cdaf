/// The progress of long work: its rate, the remaining time, and the line that shows them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace waymark::program {

/// Rate and remaining time of work that reports its progress, in any unit. Both use the mean rate
/// since the beginning, and are unknown before kEarliest_s.
class ProgressMeter {
 public:
  using Clock = std::function<double()>;  ///< seconds, never decreasing

  static constexpr double kEarliest_s = 0.5;
  static constexpr double kBetweenLines_s = 0.1;  ///< the eye reads no faster

  explicit ProgressMeter(Clock clock = steady_seconds);

  /// Starts new work now.
  void restart();
  /// @param total 0: not known
  void update(double done, double total = 0);

  /// Returns units per second; nothing if not known yet.
  [[nodiscard]] std::optional<double> rate() const;
  /// Returns seconds; nothing if rate or total are not known.
  [[nodiscard]] std::optional<double> remaining_s() const;
  /// Tells whether a line is due: the first one, or kBetweenLines_s after the previous one.
  [[nodiscard]] bool due();

 private:
  static double steady_seconds();

  Clock clock_;
  double begin_s_ = 0;
  double now_s_ = 0;
  double done_ = 0;
  double total_ = 0;
  std::optional<double> shown_s_;
};

/// Returns "3 s", "2:10", "1:02:10", rounded up.
[[nodiscard]] std::string duration_text(double seconds);

/// Returns "  2:10 left", or nothing if that is not known.
[[nodiscard]] std::string remaining_text(const ProgressMeter& meter);

/// Returns "reading candump.log.gz  412 of 905 MB  46 %  162 MB/s  3 s left". @param size bytes;
/// 0: not known
[[nodiscard]] std::string reading_line(const std::string& name, std::uint64_t done, std::uint64_t size,
                                       const ProgressMeter& meter);

/// Returns "iteration 12  chi2 538.30076  4.1 iterations/s". The number of iterations is not
/// known beforehand.
[[nodiscard]] std::string iteration_progress(int iteration, double chi2, const ProgressMeter& meter);

}  // namespace waymark::program
