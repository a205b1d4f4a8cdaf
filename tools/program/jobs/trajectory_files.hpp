/// Writes the trajectory of a document into files.
#pragma once

#include <string>
#include <vector>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>

namespace waymark::program {

/// Writes the trajectory of all poses in the formats of kTrajectoryForms (those for maps only if
/// the frame is known). Writes nothing for a document without poses. Returns the names.
std::vector<std::string> write_trajectories(const formats::GraphDocument& document,
                                            const evaluation::ResultFolder& folder, const std::string& label);

}  // namespace waymark::program
