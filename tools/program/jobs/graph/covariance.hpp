/// Tables of the covariances of an optimised document.
#pragma once

#include <string>

#include <waymark/core/optimize/summary.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/text/text_sink.hpp>

namespace waymark::program {

/// @throws UsageError if a table is requested without covariances, or its name ends neither in .csv
/// nor in .json; OutputError if it cannot be written
void check_covariance_file(const std::string& path, const std::string& which);

/// Writes document.covariances as a table, completely or not at all. Numbers read back exactly.
///
/// CSV has id, tag and stamp_ns, and then the upper triangle. Its columns are named by the numbers
/// of the vertex: x_x, x_y, x_heading, y_y, y_heading, heading_heading. If there are vertices of
/// several types, there are the columns of all types, and fields that a vertex does not have are
/// empty. JSON has the same. Before that it describes the covariances: chart, held vertices, robust
/// losses, chi2, version.
void write_covariances(const std::string& path, const formats::GraphDocument& document,
                       const Summary& summary);

}  // namespace waymark::program
