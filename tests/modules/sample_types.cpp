#include "sample_types.hpp"

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark_test::modules {
namespace {

/// The position of a pose, measured.
struct EdgeSound {
  static constexpr std::string_view kTag = "EDGE_SAMPLE";
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = waymark::VertexList<waymark::VertexSe2>;
  static constexpr auto fields() { return std::array{waymark::field<&EdgeSound::measured>("measured")}; }

  template <typename T>
  waymark::Vector2<T> error(const waymark::Pose2<T>& pose) const {
    return pose.position - waymark::constant_vector<T>(measured);
  }
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

struct EdgeTaken : EdgeSound {
  static constexpr std::string_view kTag = "EDGE_SE2";
};

struct EdgeWithWrongJacobian : EdgeSound {
  void linearize(const waymark::Pose2<double>& pose, waymark::ErrorVector<2>& e,
                 waymark::JacobianMatrix<2, 3>& by_pose) const {
    e = pose.position - measured;
    by_pose << 1, 0, 0, 0, -1, 0;  // the sign of the second row is wrong
  }
};

struct EdgeFalselyRelative : EdgeSound {
  static constexpr bool kRelative = true;  // a copied line
};

class Refusing final : public waymark::LinearSolver {
 public:
  void analyze(const waymark::BlockPattern&) override {}
  [[nodiscard]] waymark::FactorStatus factorize(std::span<const double>) override {
    return waymark::FactorStatus::not_positive_definite;
  }
  void solve(std::span<const double>, std::span<double>) override {}
  [[nodiscard]] std::int64_t factor_size() const override { return 0; }
  [[nodiscard]] std::string description() const override { return "refuses"; }
};

class Located final : public waymark::SensorModel {
 public:
  void extend(const waymark::SensorInput& input, waymark::Graph&) override {
    (void)input.context.require_geodesy().to_ecef({{0, 0}, 100});
    if (input.context.source("gnss").fixes.empty() || input.context.source("odometry").odometry.empty())
      throw waymark::UsageError("the sources are empty");
  }
};

}  // namespace

void add_located_sensor(waymark::TypeRegistry& registry) {
  registry.add_sensor_model({"located",
                             "needs a place",
                             {{"reading", "1", "", true, "any number"}},
                             {},
                             [](const waymark::CheckedOptions&) { return std::make_unique<Located>(); }});
}

void add_sound_edge(waymark::TypeRegistry& registry) {
  registry.add_edge<EdgeSound>();
}

void add_taken_edge(waymark::TypeRegistry& registry) {
  registry.add_edge<EdgeTaken>();
}

void add_edge_with_wrong_jacobian(waymark::TypeRegistry& registry) {
  registry.add_edge<EdgeWithWrongJacobian>();
}

void add_falsely_relative_edge(waymark::TypeRegistry& registry) {
  registry.add_edge<EdgeFalselyRelative>();
}

void add_refusing_solver(waymark::TypeRegistry& registry) {
  registry.add_linear_solver({"refusing", "refuses", "BSD-3-Clause",
                              [](const waymark::CheckedOptions&) { return std::make_unique<Refusing>(); }});
}

}  // namespace waymark_test::modules
