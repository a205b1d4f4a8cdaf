/// The six tables of the paper with its figures beside ours, and one table more.
#pragma once

#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::reproduction {

/// Returns Dataset overview; GNSS; G1; G2; G3; G2 without rejection; and a table that is not in the
/// paper: the default model beside G2, with the consistency of the covariances. The tables of
/// results have three triples of columns: the figures of the paper, its settings on these drives,
/// our settings on these drives. Averages and improvements below them are computed as in the paper.
/// Drives that are not in the paper are left out.
[[nodiscard]] std::vector<text::Table> paper_tables(const std::vector<DriveResult>& drives);

}  // namespace waymark::reproduction
