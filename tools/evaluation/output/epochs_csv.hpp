/// Every epoch of an evaluation as a table: for plots and programs of one's own.
#pragma once

#include <span>
#include <string>

#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::evaluation {

/// Comma-separated values (RFC 4180 with "\n" line ends) under one header line, a row per fix in the order
/// given. The columns are always the same, those of tools/evaluation/README.md, "epochs.csv"; what is not
/// defined is an empty field. Numbers read back to the same double.
[[nodiscard]] std::string epochs_csv(std::span<const EpochResult> epochs);

}  // namespace waymark::evaluation
