#include <waymark/types_se2/start/detail/bodies.hpp>

#include <algorithm>
#include <optional>
#include <queue>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/types_se2/start/detail/points.hpp>
#include <waymark/types_se2/start/detail/rigid_alignment.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {
namespace {

using detail::at;

class Joining {
 public:
  Joining(const Graph& graph, const std::vector<int>& bodies, const std::vector<double>& values)
      : bodies_(bodies),
        points_(at(std::max(*std::max_element(bodies.begin(), bodies.end()), kWorldBody) + 1)),
        shared_(points_.size(), 0),
        joined_(points_.size(), 0),
        motions_(points_.size()),
        seen_from_(graph.vertex_count()),
        places_(graph.vertex_count()) {
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      if (!graph.fixed(v) || graph.vertex_type(v).tag != VertexXy::kTag) continue;
      const double* value = values.data() + graph.offsets()[at(v)];
      points_[kWorldBody].push_back({v, {value[0], value[1]}});
    }
  }

  /// Reckons the points of each body in the axes of its poses.
  void find_points(const Graph& graph, std::vector<Sighting> sightings, const std::vector<double>& values) {
    std::erase_if(sightings, [&](const Sighting& seen) { return bodies_[at(seen.from)] == kNoBody; });
    std::stable_sort(sightings.begin(), sightings.end(), [&](const Sighting& a, const Sighting& b) {
      return bodies_[at(a.from)] < bodies_[at(b.from)];
    });
    for (auto first = sightings.begin(); first != sightings.end();) {
      const int body = bodies_[at(first->from)];
      const auto last = std::find_if(first, sightings.end(),
                                     [&](const Sighting& seen) { return bodies_[at(seen.from)] != body; });
      for (const SeenPoint& point : seen_points(graph, {first, last}, values)) {
        points_[at(body)].push_back(point);
        seen_from_[at(point.point)].push_back(body);
      }
      first = last;
    }
  }

  void join_all() {
    join(kWorldBody, Pose2<double>());
    for (int body = 0; body < static_cast<int>(points_.size()); ++body) {
      join_waiting();
      if (joined_[at(body)] == 0) join(body, Pose2<double>());
    }
    join_waiting();
  }

  /// Returns how a body moves; nothing: it stays.
  [[nodiscard]] const std::optional<Pose2<double>>& motion(int body) const { return motions_[at(body)]; }

 private:
  /// Gives the points of a body their places in the frame, and tells the bodies that see them too.
  void join(int body, const Pose2<double>& motion) {
    joined_[at(body)] = 1;
    for (const SeenPoint& point : points_[at(body)]) {
      if (places_[at(point.point)]) continue;
      places_[at(point.point)] = moved(motion, point.place);
      for (const int other : seen_from_[at(point.point)]) {
        if (joined_[at(other)] == 0 && ++shared_[at(other)] > 1) waiting_.emplace(shared_[at(other)], -other);
      }
    }
  }

  void join_waiting() {
    while (!waiting_.empty()) {
      const auto [shared, negative] = waiting_.top();
      waiting_.pop();
      const int body = -negative;
      if (joined_[at(body)] != 0 || shared < shared_[at(body)]) continue;
      const auto motion = rigid_alignment(pairs(body));
      if (!motion) continue;
      motions_[at(body)] = motion;
      join(body, *motion);
    }
  }

  [[nodiscard]] std::vector<PointPair> pairs(int body) const {
    std::vector<PointPair> pairs;
    for (const SeenPoint& point : points_[at(body)]) {
      if (const auto& place = places_[at(point.point)]) pairs.push_back({point.place, *place});
    }
    return pairs;
  }

  const std::vector<int>& bodies_;
  std::vector<std::vector<SeenPoint>> points_;  // per body, in its axes
  std::vector<int> shared_;                     // per body: its points that have their place
  std::vector<char> joined_;                    // per body
  std::vector<std::optional<Pose2<double>>> motions_;
  std::vector<std::vector<int>> seen_from_;             // per point: bodies
  std::vector<std::optional<Eigen::Vector2d>> places_;  // per point, in the frame
  std::priority_queue<std::pair<int, int>> waiting_;    // most points first, then the lowest number
};

}  // namespace

bool has_several(const Graph& graph, const std::vector<int>& bodies) {
  int most = kNoBody;
  bool world = false;
  for (std::size_t v = 0; v < bodies.size(); ++v) {
    most = std::max(most, bodies[v]);
    world = world || bodies[v] == kWorldBody || graph.fixed(static_cast<VertexIndex>(v));
  }
  return most > (world ? kWorldBody : kWorldBody + 1);
}

std::vector<char> join_bodies(const Graph& graph, std::vector<Sighting> sightings,
                              const std::vector<int>& bodies, std::vector<double>& values) {
  std::vector<char> is_moved(bodies.size(), 0);
  if (bodies.empty() || sightings.empty()) return is_moved;
  Joining joining(graph, bodies, values);
  joining.find_points(graph, std::move(sightings), values);
  joining.join_all();
  for (std::size_t v = 0; v < bodies.size(); ++v) {
    if (bodies[v] == kNoBody || !joining.motion(bodies[v])) continue;
    double* value = values.data() + graph.offsets()[v];
    const Pose2<double> pose =
        compose(*joining.motion(bodies[v]), Pose2<double>(value[0], value[1], value[2]));
    value[0] = pose.position[0];
    value[1] = pose.position[1];
    value[2] = wrap_angle(pose.heading);
    is_moved[v] = 1;
  }
  return is_moved;
}

}  // namespace waymark
