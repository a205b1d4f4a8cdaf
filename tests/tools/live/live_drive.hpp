/// A simulated drive as a stream of samples, and what an estimator says about it.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <waymark/tools/live/estimator/estimator.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark_test {

/// Samples in the order of their arrival.
using Arrivals = std::vector<waymark::live::Sample>;

/// A drive with fixes of a second and odometry of 25 Hz.
struct LiveDrive {
  waymark::simulation::SimulatedDrive simulated;
  Arrivals arrivals;  ///< in order of their stamps
};
[[nodiscard]] LiveDrive live_drive(const std::string& preset, double duration_s, std::uint64_t seed = 1);

/// A description with one odometry and receivers of these names.
[[nodiscard]] waymark::drive::DriveDescription live_description(const std::vector<std::string>& receivers = {
                                                                    "gnss"});
/// Settings with the noise as it is by default.
[[nodiscard]] waymark::drive::FusionSettings live_fusion(const std::string& modeling = "correlated");

/// Everything that an estimator said.
struct Said {
  std::vector<waymark::live::LivePose> poses;
  std::vector<waymark::live::SettledPose> settled;
  std::vector<waymark::live::Event> events;
  waymark::live::Counts counts;
  waymark::live::State state{};

  [[nodiscard]] std::size_t count(const std::string& kind) const;
  /// All of it as text, to the last bit.
  [[nodiscard]] std::string text() const;
};
[[nodiscard]] Said listen(const Arrivals& arrivals, const waymark::live::LiveSettings& settings = {},
                          const std::string& modeling = "correlated",
                          const std::vector<std::string>& receivers = {"gnss"});

[[nodiscard]] Said listen(const waymark::drive::DriveDescription& description, const Arrivals& arrivals,
                          const waymark::live::LiveSettings& settings = {},
                          const std::string& modeling = "correlated");
[[nodiscard]] Said listen(const waymark::drive::DriveDescription& description, const Arrivals& arrivals,
                          const waymark::live::LiveSettings& settings,
                          const waymark::drive::FusionSettings& fusion);
/// Gives arrivals to an estimator, to their end. @returns what it says
[[nodiscard]] Said heard(waymark::live::Estimator& estimator, const Arrivals& arrivals);

[[nodiscard]] double rms(std::span<const double> errors);
/// Distances of the poses with a heading from the truth, m.
[[nodiscard]] std::vector<double> errors_m(const Said& said, const LiveDrive& drive);
/// Those of the poses at the end of the lag.
[[nodiscard]] std::vector<double> settled_errors_m(const Said& said, const LiveDrive& drive);
/// Share of these poses whose truth lies within their region of 95 %.
[[nodiscard]] double coverage95(const Said& said, const LiveDrive& drive);

}  // namespace waymark_test
