/// Writes the trajectory of a document into files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>

namespace waymark::program {

/// Writes the trajectory of all poses in the formats of kTrajectoryForms (those for maps only if
/// the frame is known). Writes nothing for a document without poses. Returns the names.
std::vector<std::string> write_trajectories(const formats::GraphDocument& document,
                                            const evaluation::ResultFolder& folder, const std::string& label);

/// Tells whether a file holds a trajectory alone, by its ending: .bag (ROS 1), .mcap (ROS 2), .tum and .kitti (evo).
[[nodiscard]] bool is_trajectory_file(const std::string& path);

/// Writes the poses in order of time to such a file. Returns how many. @throws InputError for a graph without any
std::size_t write_trajectory_file(const formats::GraphDocument& document, const std::string& path);

}  // namespace waymark::program
