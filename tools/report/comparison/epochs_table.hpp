/// LABEL.epochs.csv read back: what was found at each fix.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::report {

/// The columns that a comparison needs, by their names: stamp_ns, the offsets of raw fix and fused pose,
/// nees. Empty fields are not defined; other members of the results are left empty.
/// @param name  of the file, for errors
/// @throws InputError "g1.epochs.csv:3: ..." for a column that is missing and a field that is no number
[[nodiscard]] std::vector<evaluation::EpochResult> read_epochs_table(std::string_view text,
                                                                     const std::string& name);

}  // namespace waymark::report
