// A plugin in many variants, each wrong in one way (tests/CMakeLists.txt): compiled with other flags, linked
// with -Ofast, a tag that is taken, a registration that throws, a solver that fails, no descriptor. A sound
// one tells, by a file, when any of its code runs.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace {

/// Runs when the module is loaded, before anything of it is called.
[[maybe_unused]] const bool told = [] {
  if (const char* file = std::getenv("WAYMARK_TEST_MODULE_RAN")) {
    if (std::FILE* opened = std::fopen(file, "a")) std::fclose(opened);
  }
  return true;
}();

struct EdgeSample {
#if defined(SAMPLE_DUPLICATE)
  static constexpr std::string_view kTag = "EDGE_SE2";
#else
  static constexpr std::string_view kTag = "EDGE_SAMPLE";
#endif
  static constexpr std::string_view kForm = "position";
  static constexpr int kErrorDimension = 2;
  using Vertices = waymark::VertexList<waymark::VertexSe2>;
  static constexpr auto fields() {
    return std::array{waymark::field<&EdgeSample::measured>("measured")};
  }

  template <typename T>
  waymark::Vector2<T> error(const waymark::Pose2<T>& pose) const {
    return pose.position - waymark::constant_vector<T>(measured);
  }
#if defined(SAMPLE_WRONG_JACOBIAN)
  void linearize(const waymark::Pose2<double>& pose, waymark::ErrorVector<2>& e,
                 waymark::JacobianMatrix<2, 3>& by_pose) const {
    e = pose.position - measured;
    by_pose << 1, 0, 0, 0, -1, 0;  // the sign of the second row is wrong
  }
#endif
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

#if defined(SAMPLE_BROKEN_SOLVER)
/// Calls every matrix indefinite.
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
#endif

[[maybe_unused]] void register_types(waymark::TypeRegistry& registry) {
  registry.add_edge<EdgeSample>();
#if defined(SAMPLE_BROKEN_SOLVER)
  registry.add_linear_solver(
      {"refusing", "refuses", "BSD-3-Clause", [] { return std::make_unique<Refusing>(); }});
#endif
#if defined(SAMPLE_THROWS)
  throw std::runtime_error("the sensor is not plugged in");
#elif defined(SAMPLE_THROWS_NUMBER)
  throw 42;
#endif
}

}  // namespace

#if defined(SAMPLE_OTHER_ABI)
extern "C" __attribute__((visibility("default"))) const std::uint32_t waymark_plugin[2];
const std::uint32_t waymark_plugin[2] = {waymark::kPluginMagic, waymark::kPluginAbi - 1};
#elif !defined(SAMPLE_NO_DESCRIPTOR)
WAYMARK_PLUGIN(sample, "1.2.3", register_types);
#endif
