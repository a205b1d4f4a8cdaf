/// Estimated states that are neither poses nor landmarks: the calibration of a drive.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::evaluation {

/// One number of a state. If the state wanders, it has a value for each stamp.
struct StateReport {
  /// name of the number, "gyro_bias"; with its source if the drive has several, "wheels.gyro_bias"
  std::string name;
  std::string unit;
  std::size_t values = 0;  ///< vertices: 1 for a constant
  double first = 0;
  double last = 0;
  double smallest = 0;
  double largest = 0;
  /// of the last value, from the marginal covariance; NaN if undetermined
  double sigma = 0;
  /// of the first value, before any measurement; NaN without a prior
  double prior_sigma = 0;
  /// the drive has more information about the first value than its prior
  bool observed = true;
  /// |first value| over sqrt(prior^2 - posterior^2) of it, which is about 1 if the prior is right; NaN
  /// without a prior
  double surprise = 0;
  std::vector<Stamp> stamps;      ///< of the values of a wandering state; empty for a constant
  std::vector<double> wandering;  ///< one value per stamp
  std::string source{};           ///< of the drive, if it has several
};

/// Reports the estimated vertices of types that state units and have no place in the plane, in the
/// order of their types' first vertices. Vertices of one type with increasing stamps are one
/// wandering state. All other vertices are separate states. Sigmas are those at the values of the
/// document. @throws what marginal_covariances throws
[[nodiscard]] std::vector<StateReport> report_states(const formats::GraphDocument& document);

/// Returns a table for the terminal; empty if there are no states.
[[nodiscard]] std::string states_text(const std::vector<StateReport>& states,
                                      const text::TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json states_json(const std::vector<StateReport>& states);

}  // namespace waymark::evaluation
