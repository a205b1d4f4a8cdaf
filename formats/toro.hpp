/// TORO's plane graphs: `VERTEX2 id x y heading`, `EDGE2 from to x y heading` and six numbers of the
/// information matrix in TORO's order, I_ff I_fs I_ss I_rr I_fr I_sr (f forward, s sideward, r rotation).
///
/// GTSAM writes the same tags with a covariance in the same order, and nothing in the file tells one from the
/// other: so this format is never guessed, only asked for.
#pragma once

#include <string>
#include <string_view>

#include <waymark/formats/graph_document.hpp>

namespace waymark {

/// Reads a TORO file into VERTEX_SE2 and EDGE_SE2. Vertices may stand below the edges that join them.
/// @param name for messages
/// @throws InputError with line and column; UsageError where the registry lacks the two types
[[nodiscard]] GraphDocument read_toro(std::string_view text, const std::string& name,
                                      const TypeRegistry& registry);

}  // namespace waymark
