#include <array>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

namespace waymark::plugins::gnss_g3 {
namespace {

/// The paper's G3: a fix is a fixed node. An identity edge ties it to the pose and carries the
/// information of the fix.
class GnssG3 final : public GnssModeling {
 public:
  GnssG3(bool literal, double time_offset_sigma_s)
      : literal_(literal), time_offset_sigma_s_(time_offset_sigma_s) {}

  void extend(const GnssInput& input, Graph& graph) override {
    if (literal_) require_no_lever_arm(input, "g3");
    PositionEdges positions(input, time_offset_sigma_s_, offset_, graph);
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      const Fix& fix = input.fixes[i];
      const VertexIndex pose = pose_vertex(fix, graph);
      // With heading 0 the error of the identity edge is p - z in frame axes.
      const VertexIndex node =
          graph.add_vertex<VertexSe2>(graph.free_id(), {fix.position[0], fix.position[1], 0});
      graph.set_fixed(node, true);
      if (literal_) {
        graph.add_edge(EdgeSe2Log{}, {node, pose}, pose_information(fix), input.loss);
      } else {
        positions.add(i, {0, 0}, positions.antenna(i), {node, pose});
      }
    }
  }

 private:
  bool literal_;
  double time_offset_sigma_s_;
  KeptVertex offset_;
};

std::unique_ptr<GnssModeling> make(const CheckedOptions& options) {
  return std::make_unique<GnssG3>(is_literal(options), time_offset_sigma(options));
}

void register_types(TypeRegistry& registry) {
  registry.add_gnss_modeling(
      {"g3", "fixes are fixed nodes, tied to the poses by identity edges", gnss_options(), make});
}

}  // namespace
}  // namespace waymark::plugins::gnss_g3

WAYMARK_PLUGIN(gnss_g3, "0.1.0", waymark::plugins::gnss_g3::register_types);
