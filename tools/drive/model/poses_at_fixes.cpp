#include <waymark/tools/drive/model/poses_at_fixes.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/nodes/timeline.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// Returns all poses with a stamp, by time; one for each stamp.
std::vector<StampedPose> stamped_poses(const Graph& graph) {
  std::vector<StampedPose> poses;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const auto pose = stamped_pose(graph, v)) poses.push_back(*pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  const auto same = [](const auto& a, const auto& b) { return a.stamp == b.stamp; };
  poses.erase(std::unique(poses.begin(), poses.end(), same), poses.end());
  return poses;
}

Pose2<double> as_pose(const StampedPose& pose) {
  return {pose.pose[0], pose.pose[1], pose.pose[2]};
}

/// Returns the pose `later_s` seconds after a stamp, on the twist between the two adjacent poses.
/// Beyond the ends the twist of the last two continues. @param nodes at least two
Eigen::Vector3d pose_at(const std::vector<StampedPose>& nodes, Stamp stamp, double later_s) {
  const Stamp moment = stamp.later(later_s);
  auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, moment,
                                [](Stamp time, const StampedPose& pose) { return time < pose.stamp; });
  const StampedPose& before = *(after - 1);
  const double part = seconds_between(before.stamp, moment) / seconds_between(before.stamp, after->stamp);
  const Vector3<double> twist = se2_log(between(as_pose(before), as_pose(*after)));
  return compose(as_pose(before), se2_exp<double>(part * twist)).vector();
}

}  // namespace

namespace {

/// Returns the covariance of each evaluated vertex; null where the document has none.
std::vector<const formats::VertexCovariance*> evaluated_blocks(const formats::GraphDocument& document) {
  std::vector<const formats::VertexCovariance*> of_vertex(document.graph.vertex_count(), nullptr);
  for (const formats::VertexCovariance& block : document.covariances)
    of_vertex[static_cast<std::size_t>(block.vertex)] = &block;
  std::vector<const formats::VertexCovariance*> blocks;
  for (const VertexIndex v : evaluated_vertices(document))
    blocks.push_back(v >= 0 ? of_vertex[static_cast<std::size_t>(v)] : nullptr);
  return blocks;
}

/// Returns how late the fixes of each source are; empty if no offset is estimated.
std::vector<double> delays_of(const formats::GraphDocument& document) {
  const Graph& graph = document.graph;
  const std::vector<formats::DocumentSource> receivers = formats::receivers_of(document);
  std::vector<double> delays_s(std::max<std::size_t>(receivers.size(), 1), 0.0);
  bool any = false;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != VertexTimeOffset::kTag || graph.fixed(v)) continue;
    for (std::size_t i = 0; i < delays_s.size(); ++i)
      if (receivers.empty() || formats::has_vertex(receivers[i], graph.id(v)))
        delays_s[i] = graph.value(v)[0];
    any = true;
  }
  return any ? delays_s : std::vector<double>();
}

}  // namespace

std::vector<Eigen::Vector3d> poses_when_measured(const formats::GraphDocument& document) {
  const std::vector<double> delays_s = delays_of(document);
  if (delays_s.empty()) return {};
  const std::vector<StampedPose> nodes = stamped_poses(document.graph);
  if (nodes.size() < 2)
    throw InputError("a time offset is estimated, but fewer than two poses have stamps of their own");
  std::vector<Eigen::Vector3d> poses;
  for (const Fix& fix : document.fixes) {
    const auto source = std::min(static_cast<std::size_t>(fix.source), delays_s.size() - 1);
    poses.push_back(pose_at(nodes, fix.stamp, -delays_s[source]));
  }
  return poses;
}

std::vector<StampedPose> poses_at_fixes(const formats::GraphDocument& document) {
  std::vector<StampedPose> poses;
  poses.reserve(document.fixes.size());
  for (const Fix& fix : document.fixes) {
    const auto vertex = document.graph.find(fix.vertex);
    if (!vertex || document.graph.vertex_type(*vertex).tag != VertexSe2::kTag ||
        !document.graph.stamp(*vertex)) {
      throw InputError("fix of epoch " + std::to_string(fix.epoch) + ": its vertex " + to_string(fix.vertex) +
                       " is no pose with a stamp");
    }
    const Stamp stamp = *document.graph.stamp(*vertex);
    if (std::abs(seconds_between(fix.stamp, stamp)) > kLargestSnap) {
      throw InputError("fix of epoch " + std::to_string(fix.epoch) +
                       ": its stamp is not that of its vertex " + to_string(fix.vertex));
    }
    const auto value = document.graph.value(*vertex);
    poses.push_back({stamp, {value[0], value[1], value[2]}});
  }
  return poses;
}

std::vector<VertexIndex> evaluated_vertices(const formats::GraphDocument& document) {
  constexpr double kApart_s = 0.2;
  const Graph& graph = document.graph;
  std::vector<VertexIndex> vertices;
  for (const Fix& fix : document.fixes) vertices.push_back(graph.find(fix.vertex).value_or(-1));
  if (!vertices.empty()) return vertices;
  std::optional<Stamp> last;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const std::optional<Stamp> stamp = graph.stamp(v);
    if (!stamp || graph.vertex_type(v).tag != VertexSe2::kTag) continue;
    if (last && seconds_between(*last, *stamp) < kApart_s - 1e-9) continue;
    vertices.push_back(v);
    last = stamp;
  }
  return vertices;
}

std::vector<StampedPose> evaluated_poses(const formats::GraphDocument& document) {
  if (!document.fixes.empty()) return poses_at_fixes(document);
  std::vector<StampedPose> poses;
  for (const VertexIndex v : evaluated_vertices(document)) {
    const auto value = document.graph.value(v);
    poses.push_back({*document.graph.stamp(v), {value[0], value[1], value[2]}});
  }
  return poses;
}

std::vector<double> evaluated_heights(const formats::GraphDocument& document) {
  const Graph& graph = document.graph;
  std::vector<std::pair<Stamp, double>> states;
  std::string source;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const std::optional<Stamp> stamp = graph.stamp(v);
    if (!stamp || !graph.vertex_type(v).height) continue;
    const std::string own = formats::source_of(graph.id(v), document);
    if (states.empty()) source = own;
    if (own == source) states.emplace_back(*stamp, graph.value(v)[0]);
  }
  std::vector<double> heights;
  if (states.empty()) return heights;
  std::sort(states.begin(), states.end());
  for (const StampedPose& pose : evaluated_poses(document)) {
    const auto after = std::upper_bound(states.begin(), states.end(), pose.stamp,
                                        [](Stamp stamp, const auto& state) { return stamp < state.first; });
    heights.push_back((after == states.begin() ? after : std::prev(after))->second);
  }
  return heights;
}

std::vector<std::optional<Eigen::Matrix2d>> evaluated_covariances(const formats::GraphDocument& document) {
  std::vector<std::optional<Eigen::Matrix2d>> covariances;
  for (const formats::VertexCovariance* block : evaluated_blocks(document)) {
    covariances.emplace_back();
    if (block != nullptr) covariances.back() = block->covariance.topLeftCorner<2, 2>();
  }
  return covariances;
}

std::vector<std::optional<double>> evaluated_heading_sigmas(const formats::GraphDocument& document) {
  std::vector<std::optional<double>> sigmas;
  for (const formats::VertexCovariance* block : evaluated_blocks(document)) {
    sigmas.emplace_back();
    if (block != nullptr && block->covariance.rows() > 2) sigmas.back() = std::sqrt(block->covariance(2, 2));
  }
  return sigmas;
}

std::vector<Eigen::Vector3d> poses_of_fixes(const formats::GraphDocument& document) {
  std::vector<Eigen::Vector3d> poses = poses_when_measured(document);
  if (poses.empty())
    for (const StampedPose& at : poses_at_fixes(document)) poses.push_back(at.pose);
  return poses;
}

}  // namespace waymark::drive
