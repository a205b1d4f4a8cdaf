/// Keeps fixes out of a second fusion, and tells how well it predicts them: a verdict without
/// truth.
#pragma once

#include <optional>

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Fuses the drive again without a tenth of its fixes: those of one run of 5 s in every 50 s. The
/// noise is that of all fixes, so that nothing else differs. Cost: one more minimisation, so a
/// graph with more than 300,000 vertices is not fused again.
/// @param modeled the drive with all fixes, at its minimum
/// @return empty for a drive that has truth or withheld fixes of its own, for one that is too large, for
/// fewer than 10 fixes to judge, and if the second fusion has no minimum
[[nodiscard]] std::optional<evaluation::HeldOut> hold_out(const drive::PreparedDrive& drive,
                                                          const drive::ModeledDrive& modeled,
                                                          const TypeRegistry& registry,
                                                          const Console& console);

}  // namespace waymark::program
