/// How far long work has come: its rate, the time that is left, and the line that says so.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace waymark::program {

/// Rate and remaining time of work that is told how much of it is done, in any unit.
/// Both are of the mean rate since the beginning, and not said before kEarliest_s has shown one.
class ProgressMeter {
 public:
  using Clock = std::function<double()>;  ///< seconds, never going back

  static constexpr double kEarliest_s = 0.5;
  static constexpr double kBetweenLines_s = 0.1;  ///< the eye reads no faster

  explicit ProgressMeter(Clock clock = steady_seconds);

  /// New work begins now.
  void restart();
  /// @param total  0: not known
  void update(double done, double total = 0);

  /// Units per second; nothing while it is not known.
  [[nodiscard]] std::optional<double> rate() const;
  /// Seconds; nothing where rate or total are not known.
  [[nodiscard]] std::optional<double> remaining_s() const;
  /// Whether a line is due: the first one, or kBetweenLines_s after the one before.
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

/// "3 s", "2:10", "1:02:10"; rounded up, as nothing is done before its end.
[[nodiscard]] std::string duration_text(double seconds);

/// "  2:10 left", or nothing where that is not known.
[[nodiscard]] std::string remaining_text(const ProgressMeter& meter);

/// "reading candump.log.gz  412 of 905 MB  46 %  162 MB/s  3 s left". @param size  bytes; 0: not known
[[nodiscard]] std::string reading_line(const std::string& name, std::uint64_t done, std::uint64_t size,
                                       const ProgressMeter& meter);

/// "iteration 12  chi2 538.30076  4.1 iterations/s"; how many there will be nobody knows.
[[nodiscard]] std::string iteration_progress(int iteration, double chi2, const ProgressMeter& meter);

}  // namespace waymark::program
