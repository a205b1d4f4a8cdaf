/// A drive without one of its sources, to see what the source contributes.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// A source of a drive.
struct SourceOfDrive {
  std::string name;
  std::string kind;  ///< "odometry", "gnss", or the name of a sensor model
};

/// Returns all sources: relative ones, absolute ones, further sensors.
[[nodiscard]] std::vector<SourceOfDrive> sources_of(const PreparedDrive& drive);

/// Tells whether a drive can do without a source: another one of the kind is left.
[[nodiscard]] bool can_do_without(const PreparedDrive& drive, const SourceOfDrive& source);

/// Returns the drive without a source. The fixes of an absolute one are withheld, so that they can be
/// compared with what the others say.
[[nodiscard]] PreparedDrive without_source(const PreparedDrive& drive, const SourceOfDrive& source);

}  // namespace waymark::drive
