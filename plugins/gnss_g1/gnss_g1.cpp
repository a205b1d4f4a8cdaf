#include <array>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

namespace waymark::plugins::gnss_g1 {
namespace {

/// The paper's G1: a fix is a measurement, so it is an edge from the fixed origin to the pose.
class GnssG1 final : public GnssModeling {
 public:
  GnssG1(bool literal, double time_offset_sigma_s)
      : literal_(literal), time_offset_sigma_s_(time_offset_sigma_s) {}

  void extend(const GnssInput& input, Graph& graph) override {
    if (literal_) require_no_lever_arm(input, "g1");
    const VertexIndex origin = origin_.in_or(graph, [&] { return add_origin(graph); });
    PositionEdges positions(input, time_offset_sigma_s_, offset_, graph);
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      const Fix& fix = input.fixes[i];
      const std::array<VertexIndex, 2> vertices = {origin, pose_vertex(fix, graph)};
      if (literal_) {
        graph.add_edge(EdgeSe2Log{{fix.position[0], fix.position[1], 0}}, vertices, pose_information(fix),
                       input.loss);
      } else {
        positions.add(i, fix.position, positions.antenna(i), vertices);
      }
    }
  }

 private:
  bool literal_;
  double time_offset_sigma_s_;
  KeptVertex origin_;
  KeptVertex offset_;
};

std::unique_ptr<GnssModeling> make(const CheckedOptions& options) {
  return std::make_unique<GnssG1>(is_literal(options), time_offset_sigma(options));
}

void register_types(TypeRegistry& registry) {
  registry.add_gnss_modeling(
      {"g1", "fixes are measurements: edges from the fixed origin", gnss_options(), make});
}

}  // namespace
}  // namespace waymark::plugins::gnss_g1

WAYMARK_PLUGIN(gnss_g1, "0.1.0", waymark::plugins::gnss_g1::register_types);
