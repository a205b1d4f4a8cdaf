// The position of a GNSS antenna that sits on the vehicle at a lever arm. One function says what the error
// is; its derivatives are taken by dual numbers.
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

using namespace waymark;

struct EdgeMyAntenna {
  static constexpr std::string_view kTag = "EDGE_MY_ANTENNA";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() {
    return std::array{field<&EdgeMyAntenna::measured>("measured"), field<&EdgeMyAntenna::antenna>("antenna")};
  }
  template <typename T>
  Vector2<T> error(const Pose2<T>& pose) const {
    return pose.position + rotate(pose.heading, constant_vector<T>(antenna)) - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured{0, 0}, antenna{0, 0};  // m; in the frame's axes, in the body's
};

static void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeMyAntenna>();
}
WAYMARK_PLUGIN(gnss_lever_arm, "1.0.0", register_types);
