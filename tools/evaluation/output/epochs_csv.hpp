/// Every epoch of an evaluation as a table, for plots and for other programs.
#pragma once

#include <span>
#include <string>

#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::evaluation {

/// Returns comma-separated values (RFC 4180 with "\n" line ends) under one header line, one
/// row per fix in the given order. The columns are always the same:
/// tools/evaluation/README.md, "epochs.csv", lists them. Undefined values are empty fields.
/// Numbers read back to the same double.
[[nodiscard]] std::string epochs_csv(std::span<const EpochResult> epochs);

}  // namespace waymark::evaluation
