// An initial guess: headings along the way from each pose to the next. It is for graphs whose places are
// good and whose headings are not, such as those made of fixes alone.
#include <cmath>
#include <optional>

#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

using namespace waymark;

/// A way shorter than this has no direction.
static constexpr double kShortest_m = 0.01;

static InitialValues along_the_way(const Graph& graph) {
  InitialValues start;
  start.values = graph.values();
  std::optional<VertexIndex> last;
  std::optional<double> heading;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != VertexSe2::kTag) continue;
    if (last) {
      const Eigen::Vector2d way = graph.value<VertexSe2>(v).position - graph.value<VertexSe2>(*last).position;
      if (way.norm() > kShortest_m) heading = std::atan2(way.y(), way.x());
      const auto place = static_cast<std::size_t>(graph.offsets()[static_cast<std::size_t>(*last)]);
      if (heading && !graph.fixed(*last)) start.values[place + 2] = *heading;
    }
    last = v;
  }
  if (!heading) return {.values = {}, .note = "no two poses are apart"};  // this start is not possible
  const auto place = static_cast<std::size_t>(graph.offsets()[static_cast<std::size_t>(*last)]);
  if (!graph.fixed(*last)) start.values[place + 2] = *heading;
  return start;
}

static void register_types(TypeRegistry& registry) {
  registry.add_start({"course", "headings along the way from pose to pose", along_the_way});
}
WAYMARK_PLUGIN(course_start, "1.0.0", register_types);
