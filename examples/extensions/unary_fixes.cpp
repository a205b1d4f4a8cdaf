// A GNSS modeling: how fixes become vertices and edges. This one ties each fix to its pose by an
// edge on that pose alone. It has the minimum of g1, whose edges begin at a fixed origin.
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

using namespace waymark;

class UnaryFixes final : public GnssModeling {
 public:
  explicit UnaryFixes(double sigma_factor) : sigma_factor_(sigma_factor) {}

  /// Called with the next fixes of a drive, often all of them, with their poses in the graph already.
  /// Only accepted fixes come here.
  void extend(const GnssInput& input, Graph& graph) override {
    // What a modeling cannot take into account it refuses: the user would never know.
    if (!input.antenna.isZero(0)) throw UsageError("unary: this modeling has no antenna lever arm; use g1");
    for (const Fix& fix : input.fixes) {
      const Eigen::Matrix2d information = position_information(fix) / (sigma_factor_ * sigma_factor_);
      graph.add_edge(EdgePriorSe2Xy{fix.position}, {pose_vertex(fix, graph)}, information, input.loss);
    }
  }

 private:
  double sigma_factor_;
};

/// Options: name, default, unit, which values are allowed, and what it is. `waymark info` shows
/// them.
static std::vector<OptionInfo> options() {
  return {{"sigma_factor", "1", "", OptionRange{0.01, 100}, "factor on the sigmas of the fixes"}};
}

/// The registry has checked what the user gave: these options have allowed values.
static std::unique_ptr<GnssModeling> make(const CheckedOptions& options) {
  return std::make_unique<UnaryFixes>(options.number("sigma_factor"));
}

static void register_types(TypeRegistry& registry) {
  registry.add_gnss_modeling({"unary", "fixes are edges on one pose each", options(), make});
}
WAYMARK_PLUGIN(unary_fixes, "1.0.0", register_types);
