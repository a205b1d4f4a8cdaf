#include <waymark/tools/program/jobs/evaluation/lasting_innovations.hpp>

#include <cmath>
#include <span>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::program {
namespace {

constexpr std::size_t kMostFixes = 100;

/// Returns places of withheld fixes, evenly.
std::vector<std::size_t> some_withheld(const std::vector<Fix>& fixes) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (fixes[i].status == FixStatus::withheld) all.push_back(i);
  const std::size_t stride = (all.size() + kMostFixes - 1) / kMostFixes;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// Returns the covariance of what a fix shows. @param heading_rad of the pose
Eigen::Matrix2d innovation_covariance(const Fix& fix, VertexIndex pose, double heading_rad,
                                      const ExpectedError& error, const Marginals& marginals) {
  std::vector<VertexIndex> vertices{pose};
  Eigen::MatrixXd jacobian(2, 3 + 2 * static_cast<Eigen::Index>(error.terms.size()));
  const Eigen::Vector2d lever = rotate(heading_rad, fix.antenna_seen_m());
  jacobian.leftCols<2>().setIdentity();
  jacobian.col(2) << -lever.y(), lever.x();
  Eigen::Index column = 3;
  for (const ExpectedError::Term& term : error.terms) {
    vertices.push_back(term.vertex);
    jacobian.middleCols<2>(column) = term.factor;
    column += 2;
  }
  return jacobian * marginals.joint(vertices) * jacobian.transpose() + error.rest;
}

}  // namespace

std::optional<LastingInnovations> lasting_innovations(
    const formats::GraphDocument& document,
    const std::vector<std::shared_ptr<const GnssModeling>>& modelings) {
  const std::vector<std::size_t> places = some_withheld(document.fixes);
  if (places.empty()) return std::nullopt;
  const std::vector<Eigen::Vector3d> poses = drive::poses_of_fixes(document);
  std::optional<Marginals> marginals;
  std::vector<double> nu;
  double promised = 0;
  for (const std::size_t i : places) {
    const Fix& fix = document.fixes[i];
    const auto pose = document.graph.find(fix.vertex);
    const auto& modeling = *modelings.at(static_cast<std::size_t>(fix.source));
    const std::vector<ExpectedError> errors = modeling.lasting_errors(std::span(&fix, 1), document.graph);
    if (errors.empty() || !pose) continue;
    if (!marginals) marginals.emplace(document.graph);
    const double heading_rad = poses[i][2];
    const Eigen::Matrix2d covariance =
        innovation_covariance(fix, *pose, heading_rad, errors.front(), *marginals);
    const Eigen::Vector2d innovation = fix.position - poses[i].head<2>() -
                                       rotate(heading_rad, fix.antenna_seen_m()) -
                                       errors.front().mean(document.graph);
    nu.push_back(evaluation::normalised_innovation_squared(innovation, covariance));
    promised += covariance.trace();
  }
  if (nu.empty()) return std::nullopt;
  return LastingInnovations{evaluation::innovation_statistics(evaluation::ResidualKind::prediction, nu),
                            std::sqrt(promised / static_cast<double>(nu.size()))};
}

}  // namespace waymark::program
