#include <waymark/core/system/weakest_unknown.hpp>

#include <cmath>
#include <locale>
#include <sstream>
#include <vector>

namespace waymark {

std::int64_t weakest_unknown(const NormalEquations& equations, LinearSolver& solver) {
  constexpr double kDamping = 1e-9;
  constexpr double kFloor = 1e-15;
  constexpr int kIterations = 4;
  const Eigen::VectorXd& diagonal = equations.diagonal();
  Eigen::Index weakest = 0;
  diagonal.minCoeff(&weakest);
  const Eigen::VectorXd scale = diagonal.cwiseMax(kFloor * diagonal.maxCoeff());
  std::vector<double> damped;
  equations.add_to_diagonal(kDamping * scale, damped);
  if (solver.factorize(damped) != FactorStatus::ok) return weakest;
  const auto size = static_cast<std::size_t>(scale.size());
  Eigen::VectorXd direction(scale.size());
  // any start that has a part of every direction
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    direction[i] = (1 + 0.1 * static_cast<double>(i % 7)) / std::sqrt(scale[i]);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::VectorXd right = scale.cwiseProduct(direction);
    solver.solve({right.data(), size}, {direction.data(), size});
    const double length = std::sqrt(scale.dot(direction.cwiseAbs2()));
    if (!(length > 0) || !std::isfinite(length)) return weakest;
    direction /= length;
  }
  scale.cwiseProduct(direction.cwiseAbs2()).maxCoeff(&weakest);
  return weakest;
}

std::string describe_weakest(const Graph& graph, const NormalEquations& equations, LinearSolver& solver) {
  const std::int64_t unknown = weakest_unknown(equations, solver);
  const VertexIndex v = equations.vertex_of_unknown(unknown);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "the weakest unknown belongs to " << graph.vertex_type(v).tag << ' ' << to_string(graph.id(v))
       << " (H_ii = " << equations.diagonal()[unknown] << "): it lacks edges or information";
  return text.str();
}

}  // namespace waymark
