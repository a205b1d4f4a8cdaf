// The minima that Ceres reaches from the wrong initial guesses of types_se2/start/MEASUREMENTS.md: hidden,
// because it takes minutes.
//   WAYMARK_KEY_WORKLOAD=DIR waymark_peer_tests "[.table]"
#include <catch2/catch.hpp>

#ifdef WAYMARK_HAVE_CERES

#include <cstdio>

#include <ceres/ceres.h>

#include "support/key_workload.hpp"
#include "support/registry.hpp"
#include "support/spoiling.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

/// EDGE_SE2 with a diagonal information matrix.
struct RelativePose {
  Eigen::Vector3d measured;
  Eigen::Vector3d root;  ///< square roots of the information

  template <typename T>
  bool operator()(const T* from, const T* to, T* residual) const {
    const T dx = to[0] - from[0];
    const T dy = to[1] - from[1];
    const T x = cos(from[2]) * dx + sin(from[2]) * dy - measured[0];
    const T y = cos(from[2]) * dy - sin(from[2]) * dx - measured[1];
    const T turn = to[2] - from[2] - measured[2];
    residual[0] = root[0] * (cos(measured[2]) * x + sin(measured[2]) * y);
    residual[1] = root[1] * (cos(measured[2]) * y - sin(measured[2]) * x);
    residual[2] = root[2] * (turn - 2 * std::numbers::pi *
                                        ceres::floor((turn + std::numbers::pi) / (2 * std::numbers::pi)));
    return true;
  }
};

ceres::Solver::Summary solve(const Graph& graph, ceres::TrustRegionStrategyType strategy) {
  std::vector<double> poses = graph.values();
  ceres::Problem problem;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    REQUIRE(graph.edge_type(b).tag == "EDGE_SE2");
    for (std::size_t e = 0; e < batch.size(); ++e) {
      std::vector<double> fields;
      batch.fields(e, fields);
      const auto v = batch.vertices(e);
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<RelativePose, 3, 3, 3>(new RelativePose{
              Eigen::Vector3d(fields[0], fields[1], fields[2]), batch.information(e).diagonal().cwiseSqrt()}),
          nullptr, poses.data() + 3 * v[0], poses.data() + 3 * v[1]);
    }
  }
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.fixed(v)) problem.SetParameterBlockConstant(poses.data() + 3 * v);
  }
  ceres::Solver::Options options;
  options.trust_region_strategy_type = strategy;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace

TEST_CASE("peer: convergence table of the key workload in Ceres", "[.table]") {
  for (const std::string modeling : {"G1", "G2", "G3"}) {
    const auto graph = key_workload(modeling, full_registry());
    if (!graph) return;
    for (const Spoiling& how : kSpoilings) {
      const Graph spoilt = spoil(*graph, how, [&](VertexIndex v) { return graph->id(v) >= kFirstGnssNode; });
      std::printf("| %s | %s |", modeling.c_str(), how.name);
      for (const auto strategy : {ceres::LEVENBERG_MARQUARDT, ceres::DOGLEG}) {
        const ceres::Solver::Summary summary = solve(spoilt, strategy);
        std::printf(" %.6g in %d |", 2 * summary.final_cost,
                    summary.num_successful_steps + summary.num_unsuccessful_steps);
        std::fflush(stdout);
      }
      std::printf("\n");
    }
  }
}

#endif
