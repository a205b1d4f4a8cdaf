#include <waymark/core/system/weakest_unknown.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <span>
#include <sstream>
#include <vector>

#include <Eigen/Dense>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/system/detail/components.hpp>

namespace waymark {
namespace {

using detail::at;

/// The direction in which chi2 grows least, by vertices.
struct WeakMotion {
  Eigen::Index strongest = 0;  ///< the unknown that moves most
  int vertices = 0;            ///< that move noticeably
  bool is_scale = false;       ///< their places move apart from one point
};

std::span<double> span_of(Eigen::VectorXd& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// Returns the diagonal of H, which is 0 for an unknown that nothing is known of, with a floor.
Eigen::VectorXd scale_of(const NormalEquations& equations) {
  constexpr double kFloor = 1e-15;
  return equations.diagonal().cwiseMax(kFloor * equations.diagonal().maxCoeff());
}

/// Returns how the places of all vertices move apart from the origin, and along x and y: one row per unknown.
Eigen::MatrixX3d growth_of(const Graph& graph, const NormalEquations& equations) {
  const BlockPattern& pattern = equations.pattern();
  Eigen::MatrixX3d growth = Eigen::MatrixX3d::Zero(pattern.dimension(), 3);
  for (int column = 0; column < pattern.columns(); ++column) {
    const VertexIndex v = equations.vertex_of_unknown(pattern.start[at(column)]);
    const VertexType& type = graph.vertex_type(v);
    if (type.position == nullptr || type.rigid_motion == nullptr) continue;
    const Eigen::Vector2d place = type.position(graph.value(v).data());
    const Eigen::MatrixXd motion = detail::motion_of(graph, v, {Eigen::Vector2d::Zero(), 1.0});
    auto rows = growth.middleRows(pattern.start[at(column)], pattern.size[at(column)]);
    rows.col(0) = motion.leftCols(2) * place;
    rows.rightCols(2) = motion.leftCols(2);
  }
  return growth;
}

/// Tells whether a direction is a growth about some point, up to a thousandth.
bool is_growth(const Eigen::VectorXd& direction, const Eigen::VectorXd& scale,
               const Eigen::MatrixX3d& growth) {
  constexpr double kOther = 1e-3;
  const Eigen::MatrixX3d weighted = scale.cwiseSqrt().asDiagonal() * growth;
  const Eigen::VectorXd wanted = scale.cwiseSqrt().cwiseProduct(direction);
  const Eigen::Vector3d found = weighted.colPivHouseholderQr().solve(wanted);
  return (weighted * found - wanted).squaredNorm() <= kOther * wanted.squaredNorm();
}

WeakMotion describe(const Graph& graph, const NormalEquations& equations, const Eigen::VectorXd& direction) {
  constexpr double kNoticeable = 1e-4;  // of the vertex that moves most: a hundredth of its way
  constexpr int kFewest = 3;            // two vertices in the plane grow however they move
  const BlockPattern& pattern = equations.pattern();
  const Eigen::VectorXd scale = scale_of(equations);
  Eigen::VectorXd weight = scale.cwiseProduct(direction.cwiseAbs2());
  if (!(weight.maxCoeff() > 0)) weight = direction.cwiseAbs2();  // H is 0
  WeakMotion found;
  weight.maxCoeff(&found.strongest);
  std::vector<double> of_vertex;
  for (int column = 0; column < pattern.columns(); ++column)
    of_vertex.push_back(weight.segment(pattern.start[at(column)], pattern.size[at(column)]).sum());
  const double most = *std::max_element(of_vertex.begin(), of_vertex.end());
  found.vertices = static_cast<int>(std::count_if(of_vertex.begin(), of_vertex.end(),
                                                  [&](double own) { return own >= kNoticeable * most; }));
  found.is_scale = found.vertices >= kFewest && is_growth(direction, scale, growth_of(graph, equations));
  return found;
}

/// The solution d of H d = r for a right side r that has a part of each direction. The weakest of these is divided by
/// next to nothing, so that d is that one if the equations are nearly singular.
struct Response {
  Eigen::VectorXd direction;
  double curvature = 0;          ///< d^T H d, by the factor
  bool is_on_the_verge = false;  ///< that is near its rounding
};

/// Relative errors of eps on the diagonal give d^T H d the standard deviation eps sqrt(sum (d_i^2 H_ii)^2), whatever the
/// units are.
Response faintest_response(const NormalEquations& equations, LinearSolver& solver) {
  constexpr double kNear = 1e3;
  const Eigen::VectorXd& diagonal = equations.diagonal();
  Response response;
  if (diagonal.size() == 0) return response;
  Eigen::VectorXd right = diagonal.cwiseMax(0).cwiseSqrt();
  for (Eigen::Index i = 0; i < right.size(); ++i) right[i] *= 1 + 0.1 * static_cast<double>(i % 7);
  response.direction.resize(right.size());
  solver.solve(span_of(right), span_of(response.direction));
  response.curvature = response.direction.dot(right);
  const double rounding =
      std::numeric_limits<double>::epsilon() * diagonal.cwiseProduct(response.direction.cwiseAbs2()).norm();
  response.is_on_the_verge = !(response.curvature > kNear * rounding);
  return response;
}

/// Returns sum w |J d|^2_Omega. Where the edges see nothing of d, J d cancels edge by edge to eps and its square to eps^2,
/// while d^T H d cancels to eps.
double curvature_of_edges(const Graph& graph, const std::vector<double>& values,
                          const NormalEquations& equations, const Eigen::VectorXd& direction) {
  const BlockPattern& pattern = equations.pattern();
  std::vector<std::int64_t> start(graph.vertex_count(), -1);
  for (int column = 0; column < pattern.columns(); ++column)
    start[at(equations.vertex_of_unknown(pattern.start[at(column)]))] = pattern.start[at(column)];
  const ValueView view{values.data(), graph.offsets().data()};
  double sum = 0;
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      batch.linearize_edge(e, view, error, jacobians);
      Eigen::VectorXd moved = Eigen::VectorXd::Zero(error.size());
      const std::span<const VertexIndex> vertices = batch.vertices(e);
      for (std::size_t k = 0; k < vertices.size(); ++k)
        if (const std::int64_t from = start[at(vertices[k])]; from >= 0)
          moved += jacobians[k] * direction.segment(from, jacobians[k].cols());
      const Eigen::MatrixXd information = batch.information(e);
      const Loss* loss = batch.loss(e);
      const double weight = loss == nullptr ? 1 : loss->at(error.dot(information * error)).weight;
      sum += weight * moved.dot(information * moved);
    }
  }
  return sum;
}

}  // namespace

bool is_on_the_verge(const NormalEquations& equations, LinearSolver& solver) {
  return faintest_response(equations, solver).is_on_the_verge;
}

bool is_lost_in_rounding(const Graph& graph, const std::vector<double>& values,
                         const NormalEquations& equations, LinearSolver& solver) {
  constexpr double kShare = 0.1;
  const Response response = faintest_response(equations, solver);
  return response.is_on_the_verge &&
         !(curvature_of_edges(graph, values, equations, response.direction) >= kShare * response.curvature);
}

Eigen::VectorXd weakest_direction(const NormalEquations& equations, LinearSolver& solver) {
  constexpr double kDamping = 1e-9;
  constexpr int kIterations = 4;
  const Eigen::VectorXd& diagonal = equations.diagonal();
  Eigen::Index weakest = 0;
  diagonal.minCoeff(&weakest);
  const Eigen::VectorXd alone = Eigen::VectorXd::Unit(diagonal.size(), weakest);
  const Eigen::VectorXd scale = scale_of(equations);
  std::vector<double> damped;
  equations.add_to_diagonal(kDamping * scale, damped);
  if (solver.factorize(damped) != FactorStatus::ok) return alone;
  Eigen::VectorXd direction(scale.size());
  // any start that has a part of every direction
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    direction[i] = (1 + 0.1 * static_cast<double>(i % 7)) / std::sqrt(scale[i]);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::VectorXd right = scale.cwiseProduct(direction);
    solver.solve(span_of(right), span_of(direction));
    const double length = std::sqrt(scale.dot(direction.cwiseAbs2()));
    if (!(length > 0) || !std::isfinite(length)) return alone;
    direction /= length;
  }
  return direction;
}

std::string describe_weakest(const Graph& graph, const NormalEquations& equations, LinearSolver& solver) {
  const WeakMotion motion = describe(graph, equations, weakest_direction(equations, solver));
  const VertexIndex v = equations.vertex_of_unknown(motion.strongest);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  const std::string vertex = graph.vertex_type(v).tag + ' ' + to_string(graph.id(v));
  if (motion.vertices <= 2) {
    text << "the weakest unknown belongs to " << vertex
         << " (H_ii = " << equations.diagonal()[motion.strongest] << "): it lacks edges or information";
  } else if (motion.is_scale) {
    text << "the scale of " << motion.vertices << " vertices is not determined (" << vertex
         << " moves most): they lack a distance";
  } else {
    text << "a combination of " << motion.vertices
         << " vertices is not determined (the weakest unknown belongs to " << vertex
         << "): they lack edges or information";
  }
  return text.str();
}

}  // namespace waymark
