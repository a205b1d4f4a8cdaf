/// Residuals of the measurements of each source of a drive, after the fit.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/tools/text/table.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::evaluation {

/// The measurements of one source with one edge type.
struct SourceResiduals {
  std::string source;
  std::string kind;  ///< "odometry", "gnss", or the name of a sensor model
  std::string tag;   ///< of the edge type
  std::size_t measurements = 0;
  /// of all whitened components (residuals.hpp); about 1 or below if the noise is as stated
  double rms = kUndefined;
  double largest = kUndefined;    ///< sqrt(e^T Omega e) of the edge that fits worst
  std::size_t robust = 0;         ///< measurements with a loss
  std::size_t down_weighted = 0;  ///< whose loss leaves less than half of their weight
  double weight = kUndefined;     ///< mean weight, 1 without a loss
};

/// Returns a row per source and type of its measuring edges, in the order of the document. Empty if the
/// document has no sources of its own.
[[nodiscard]] std::vector<SourceResiduals> residuals_by_source(const formats::GraphDocument& document);

/// Returns a table for the terminal and for reports; without rows if there are none.
/// @param label of the result, if there are several
[[nodiscard]] text::Table source_residuals_table(const std::vector<SourceResiduals>& residuals,
                                                 const std::string& label = "");
[[nodiscard]] nlohmann::ordered_json source_residuals_json(const std::vector<SourceResiduals>& residuals);

}  // namespace waymark::evaluation
