/// Compares the sources of a drive: fuses it once without each of them.
#pragma once

#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/evaluation/source_comparison.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Fuses the drive without each source that it can do without. The noise is that of all sources, so that
/// nothing else differs. Empty for a drive with one odometry, one receiver and no sensors. A warning goes
/// into the document for a source without which there is no minimum.
/// @param modeled the drive with all sources, at its minimum, with covariances at its fixes
[[nodiscard]] evaluation::SourceComparison compare_sources(const drive::PreparedDrive& drive,
                                                           drive::ModeledDrive& modeled,
                                                           const evaluation::Evaluation& evaluated,
                                                           const TypeRegistry& registry,
                                                           const Console& console);

}  // namespace waymark::program
