/// Estimated states that are no poses and no landmarks: what the calibration of a drive came out as.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::evaluation {

/// One number of a state, over a drive where it wanders.
struct StateReport {
  std::string name;  ///< of the number: "gyro_bias"
  std::string unit;
  std::size_t values = 0;  ///< vertices: 1 for a constant
  double first = 0;
  double last = 0;
  double smallest = 0;
  double largest = 0;
  double sigma = 0;  ///< of the last value, from the marginal covariance; NaN where it is not determined
  double prior_sigma = 0;     ///< of the first value before anything was measured; NaN where it has no prior
  bool observed = true;       ///< whether the drive said more of the first value than its prior
  std::vector<Stamp> stamps;  ///< of the values of a state that wanders; empty for a constant
  std::vector<double> wandering;  ///< one value per stamp
};

/// Vertices of types that state units and have no place in the plane, as far as they were estimated, in the
/// order of their types' first vertices. Vertices of one type with increasing stamps are one state that
/// wanders, others are states of their own.
/// Sigmas are those at the document's values. @throws what marginal_covariances throws
[[nodiscard]] std::vector<StateReport> report_states(const formats::GraphDocument& document);

/// A table for the terminal; empty where there are no states.
[[nodiscard]] std::string states_text(const std::vector<StateReport>& states,
                                      const text::TextLook& look = {});
[[nodiscard]] nlohmann::ordered_json states_json(const std::vector<StateReport>& states);

}  // namespace waymark::evaluation
