/// Small steps that every GNSS modeling takes: the information of a fix, the paper's literal edge, the origin
/// node.
#pragma once

#include <array>
#include <string>

#include <Eigen/LU>

#include <waymark/core/error.hpp>
#include <waymark/core/modeling.hpp>
#include <waymark/core/options.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark {

/// Inverse of the fix's covariance: 1/m^2, frame axes.
[[nodiscard]] inline Eigen::Matrix2d position_information(const Fix& fix) {
  const Eigen::Matrix2d inverse = fix.covariance.inverse();
  return 0.5 * (inverse + inverse.transpose());
}

/// The same with a heading axis that carries no information.
[[nodiscard]] inline Eigen::Matrix3d pose_information(const Fix& fix) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner<2, 2>() = position_information(fix);
  return information;
}

/// The vertex of a fix's pose. @throws UsageError where the fix names none.
[[nodiscard]] inline VertexIndex pose_vertex(const Fix& fix, const Graph& graph) {
  const auto found = graph.find(fix.vertex);
  if (!found)
    throw UsageError("fix of epoch " + std::to_string(fix.epoch) + " belongs to no pose of the graph");
  return *found;
}

/// The fixed node at the frame's origin, "UTM origin" of the paper.
inline VertexIndex add_origin(VertexId id, Graph& graph) {
  const VertexIndex origin = graph.add_vertex<VertexSe2>(id, {0, 0, 0});
  graph.set_fixed(origin, true);
  return origin;
}

/// The option that all modelings share: which error a fix has.
[[nodiscard]] inline OptionInfo gnss_error_option() {
  return {"error", "decoupled", "",
          "'decoupled': p - z in frame axes; 'literal': the paper's log with heading 0"};
}
[[nodiscard]] inline bool is_literal(std::string_view modeling, const Options& given) {
  constexpr std::array<std::string_view, 2> kErrors = {"decoupled", "literal"};
  return word_option(modeling, given, std::array{gnss_error_option()}, "error", kErrors) == "literal";
}

/// The literal error knows nothing of lever arms. @throws UsageError
inline void require_no_lever_arm(const GnssInput& input, const char* modeling) {
  if (input.antenna.isZero(0)) return;
  throw UsageError(std::string(modeling) +
                   ": the paper's literal error has no antenna lever arm; use error: decoupled");
}

}  // namespace waymark
