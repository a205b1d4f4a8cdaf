#include <array>

#include <waymark/core/options.hpp>
#include <waymark/core/plugin.hpp>
#include <waymark/types_se2/gnss_edges.hpp>

namespace waymark {
namespace {

/// The paper's G1: a fix is a measurement, an edge from the fixed origin to the pose.
class GnssG1 final : public GnssModeling {
 public:
  explicit GnssG1(bool literal) : literal_(literal) {}

  void build(const GnssInput& input, Graph& graph) const override {
    if (literal_) require_no_lever_arm(input, "g1");
    const VertexIndex origin = add_origin(input.first_free_id, graph);
    for (const Fix& fix : input.fixes) {
      const std::array<VertexIndex, 2> vertices = {origin, pose_vertex(fix, graph)};
      if (literal_) {
        graph.add_edge(EdgeSe2Log{{fix.position[0], fix.position[1], 0}}, vertices, pose_information(fix));
      } else {
        graph.add_edge(EdgeGnssPosition{fix.position, input.antenna}, vertices, position_information(fix));
      }
    }
  }

 private:
  bool literal_;
};

std::vector<OptionInfo> options() {
  return {gnss_error_option()};
}

std::unique_ptr<GnssModeling> make(const Options& given) {
  const std::vector<OptionInfo> known = options();
  check_option_names("g1", given, known);
  return std::make_unique<GnssG1>(is_literal("g1", given));
}

void register_types(TypeRegistry& registry) {
  registry.add_gnss_modeling({"g1", "fixes are measurements: edges from the fixed origin", options(), make});
}

}  // namespace
}  // namespace waymark

WAYMARK_PLUGIN(gnss_g1, "0.1.0", waymark::register_types);
