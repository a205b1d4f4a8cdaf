/// Reads LABEL.epochs.csv: the results at each fix.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::report {

/// Reads the columns that a comparison needs, by their names: stamp_ns, the offsets of raw fix and
/// fused pose, nees. Empty fields are undefined values. Other members of the results stay empty.
/// @param name name of the file, for errors
/// @throws InputError "g1.epochs.csv:3: ..." for a missing column and a field that is no number
[[nodiscard]] std::vector<evaluation::EpochResult> read_epochs_table(std::string_view text,
                                                                     const std::string& name);

}  // namespace waymark::report
