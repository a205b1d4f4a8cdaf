#include <array>

#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

namespace waymark::plugins::gnss_g2 {
namespace {

/// The paper's G2: a fix is a free node. It is measured from the origin as in G1, and a stiff
/// identity edge ties it to the pose. The node is the antenna with the heading of the vehicle. If
/// there is a lever arm, the edge carries it in place of the identity.
class GnssG2 final : public GnssModeling {
 public:
  struct Configuration {
    bool literal = false;
    bool begin_at_pose = false;  ///< false: begin at the fix
    double identity_information = 1e6;
    double time_offset_sigma_s = 0;
  };
  explicit GnssG2(const Configuration& given)
      : literal_(given.literal),
        begin_at_pose_(given.begin_at_pose),
        identity_(given.identity_information),
        time_offset_sigma_s_(given.time_offset_sigma_s) {}

  void extend(const GnssInput& input, Graph& graph) override {
    if (literal_) require_no_lever_arm(input, "g2");
    const VertexIndex origin = origin_.in_or(graph, [&] { return add_origin(graph); });
    const Eigen::Matrix3d identity = identity_ * Eigen::Matrix3d::Identity();
    PositionEdges positions(input, time_offset_sigma_s_, offset_, graph);
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      const Fix& fix = input.fixes[i];
      const VertexIndex pose = pose_vertex(fix, graph);
      const auto start = graph.value(pose);
      const Eigen::Vector2d place = begin_at_pose_ ? Eigen::Vector2d(start[0], start[1]) : fix.position;
      const VertexIndex node = graph.add_vertex<VertexSe2>(graph.free_id(), {place[0], place[1], start[2]});
      if (literal_) {
        graph.add_edge(EdgeSe2Log{{fix.position[0], fix.position[1], 0}}, {origin, node},
                       pose_information(fix), input.loss);
        graph.add_edge(EdgeSe2Log{}, {node, pose}, identity);
      } else {
        const Eigen::Vector2d& antenna = positions.antenna(i);
        positions.add(i, fix.position, {0, 0}, {origin, node});
        graph.add_edge(EdgeSe2{{-antenna[0], -antenna[1], 0}}, {node, pose}, identity);
      }
    }
  }

 private:
  bool literal_;
  bool begin_at_pose_;
  double identity_;
  double time_offset_sigma_s_;
  KeptVertex origin_;
  KeptVertex offset_;
};

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = gnss_options();
  all.push_back({"identity_information", "1e6", "1/m^2, 1/rad^2", OptionRange{1, 1e12},
                 "information of the (virtual) identity edges"});
  all.push_back(
      {"nodes_begin", "fix", "", OptionWords{"fix", "pose"},
       "initial guess of the free nodes: the 'fix', or the 'pose' of the vehicle; the minimum is the same"});
  return all;
}

std::unique_ptr<GnssModeling> make(const CheckedOptions& options) {
  return std::make_unique<GnssG2>(
      GnssG2::Configuration{.literal = is_literal(options),
                            .begin_at_pose = options.word("nodes_begin") == "pose",
                            .identity_information = options.number("identity_information"),
                            .time_offset_sigma_s = time_offset_sigma(options)});
}

void register_types(TypeRegistry& registry) {
  registry.add_gnss_modeling(
      {"g2", "fixes are free nodes, tied to the poses by stiff identity edges", options(), make});
}

}  // namespace
}  // namespace waymark::plugins::gnss_g2

WAYMARK_PLUGIN(gnss_g2, "0.1.0", waymark::plugins::gnss_g2::register_types);
