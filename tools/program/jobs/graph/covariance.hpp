/// Tables of the covariances of an optimised document.
#pragma once

#include <string>

#include <waymark/core/optimize/summary.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/text/text_sink.hpp>

namespace waymark::program {

/// @throws UsageError where a table is asked for without covariances, or its name ends neither in .csv nor
/// in .json; OutputError where it cannot be written.
void check_covariance_file(const std::string& path, const std::string& which);

/// Writes document.covariances as a table, all or nothing; numbers read back exactly.
///
/// CSV: id, tag, stamp_ns, then the upper triangle with columns named by the vertex's numbers: x_x, x_y,
/// x_heading, y_y, y_heading, heading_heading. Where there are vertices of several types, columns of all;
/// what a vertex has not is an empty field. JSON: the same, and before it what the covariances are of: chart,
/// held vertices, robust losses, chi2, version.
void write_covariances(const std::string& path, const formats::GraphDocument& document,
                       const Summary& summary);

}  // namespace waymark::program
