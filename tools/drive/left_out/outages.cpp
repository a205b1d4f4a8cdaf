#include <waymark/tools/drive/left_out/outages.hpp>

#include <algorithm>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::drive {
namespace {

/// The odometry edges of a graph as a chain from each pose to the next.
class OdometryChain {
 public:
  explicit OdometryChain(const Graph& graph)
      : graph_(graph), next_(graph.vertex_count()), zeros_(graph.values().size(), 0.0) {
    for (std::size_t b = 0; b < graph.batch_count(); ++b) {
      const EdgeType& type = graph.edge_type(b);
      if (!type.relative || type.form != "log") continue;
      const EdgeBatchBase& batch = graph.batch(b);
      for (std::size_t e = 0; e < batch.size(); ++e) {
        const auto vertices = batch.vertices(e);
        if (vertices.size() < 2 || batch.error_dimension(e) != 3) continue;
        if (later(vertices[0], vertices[1])) add(vertices[0], {vertices[1], &batch, e});
      }
    }
  }

  /// Returns the pose at a vertex, by odometry from another one at or before it. Empty if the chain
  /// is interrupted.
  [[nodiscard]] std::optional<Pose2<double>> follow(VertexIndex from, Pose2<double> pose,
                                                    VertexIndex to) const {
    while (from != to) {
      const Link& link = next_[static_cast<std::size_t>(from)];
      if (link.batch == nullptr || later(to, link.to)) return std::nullopt;
      pose = compose(pose, motion(link));
      from = link.to;
    }
    return pose;
  }

  /// Returns the poses from a vertex to the end of its chain.
  [[nodiscard]] std::vector<StampedPose> track(VertexIndex from, Pose2<double> pose) const {
    std::vector<StampedPose> poses = {{*graph_.stamp(from), pose.vector()}};
    for (const Link* link = &next_[static_cast<std::size_t>(from)]; link->batch != nullptr;
         link = &next_[static_cast<std::size_t>(link->to)]) {
      pose = compose(pose, motion(*link));
      poses.push_back({*graph_.stamp(link->to), pose.vector()});
    }
    return poses;
  }

 private:
  struct Link {
    VertexIndex to = -1;
    const EdgeBatchBase* batch = nullptr;
    std::size_t edge = 0;
  };

  [[nodiscard]] bool is_pose(VertexIndex v) const {
    return graph_.vertex_type(v).tag == VertexSe2::kTag && graph_.stamp(v).has_value();
  }
  /// Tells whether both are poses and the second one is later.
  [[nodiscard]] bool later(VertexIndex first, VertexIndex second) const {
    return is_pose(first) && is_pose(second) && *graph_.stamp(first) < *graph_.stamp(second);
  }
  /// Adds a link. An edge that skips poses (a loop closure) is replaced by the edge to
  /// the next pose.
  void add(VertexIndex from, const Link& link) {
    Link& known = next_[static_cast<std::size_t>(from)];
    if (known.batch == nullptr || later(link.to, known.to)) known = link;
  }
  /// e = log(Z^-1 I), so Z = exp(-e).
  [[nodiscard]] Pose2<double> motion(const Link& link) const {
    Eigen::VectorXd error;
    std::vector<Eigen::MatrixXd> jacobians;
    link.batch->linearize_edge(link.edge, {zeros_.data(), graph_.offsets().data()}, error, jacobians);
    return se2_exp<double>(Vector3<double>(-error));
  }

  const Graph& graph_;
  std::vector<Link> next_;
  std::vector<double> zeros_;
};

void require_fixes_of(const PreparedDrive& drive, const formats::GraphDocument& document) {
  const auto same = [](const Fix& a, const Fix& b) { return a.stamp == b.stamp && a.source == b.source; };
  if (!std::equal(drive.fixes.begin(), drive.fixes.end(), document.fixes.begin(), document.fixes.end(), same))
    throw UsageError("causal estimate: the fused document has not the fixes of the drive");
}

}  // namespace

PosesAtWithheld dead_reckoned_at_withheld(const formats::GraphDocument& document) {
  PosesAtWithheld result;
  result.poses.resize(document.fixes.size());
  const OdometryChain chain(document.graph);
  std::optional<std::pair<VertexIndex, Pose2<double>>> reached;
  for (std::size_t i = 0; i < document.fixes.size(); ++i) {
    const Fix& fix = document.fixes[i];
    const auto vertex = document.graph.find(fix.vertex);
    if (!vertex || fix.status == FixStatus::rejected) continue;
    if (fix.status == FixStatus::accepted) {
      const auto value = document.graph.value(*vertex);
      reached.emplace(*vertex, Pose2<double>(value[0], value[1], value[2]));
    } else if (reached) {
      const auto pose = chain.follow(reached->first, reached->second, *vertex);
      if (!pose) continue;
      result.poses[i] = pose->vector();
      reached.emplace(*vertex, *pose);
    }
  }
  return result;
}

std::vector<StampedPose> dead_reckoned(const formats::GraphDocument& document) {
  const Graph& graph = document.graph;
  std::optional<VertexIndex> begin;
  for (const Fix& fix : document.fixes) {
    if (!begin && fix.status == FixStatus::accepted) begin = graph.find(fix.vertex);
  }
  for (VertexIndex v = 0; !begin && v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (stamped_pose(graph, v)) begin = v;
  }
  if (!begin || !stamped_pose(graph, *begin)) return {};
  const auto value = graph.value(*begin);
  std::vector<StampedPose> poses =
      OdometryChain(graph).track(*begin, Pose2<double>(value[0], value[1], value[2]));
  return poses.size() > 1 ? poses : std::vector<StampedPose>();
}

PosesAtWithheld with_lasting_errors(const formats::GraphDocument& document,
                                    const std::vector<std::shared_ptr<const GnssModeling>>& modelings) {
  PosesAtWithheld result;
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t source = 0; source < modelings.size(); ++source) {
    std::vector<Fix> withheld;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < document.fixes.size(); ++i) {
      const Fix& fix = document.fixes[i];
      if (fix.status != FixStatus::withheld || fix.source != static_cast<int>(source)) continue;
      withheld.push_back(fix);
      places.push_back(i);
    }
    const std::vector<ExpectedError> errors = modelings[source]->lasting_errors(withheld, document.graph);
    if (errors.empty()) continue;
    if (poses.empty()) poses = poses_of_fixes(document);
    result.poses.resize(document.fixes.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      result.poses[places[k]] = poses[places[k]];
      result.poses[places[k]]->head<2>() += errors[k].mean(document.graph);
    }
  }
  return result;
}

std::vector<WithheldRun> withheld_runs(std::span<const Fix> fixes) {
  std::vector<WithheldRun> runs;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::withheld) continue;
    const bool goes_on = !runs.empty() && runs.back().end == i;
    if (!goes_on) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

PreparedDrive known_until(const PreparedDrive& drive, std::size_t end) {
  PreparedDrive known = drive;
  known.truth.clear();
  known.fixes.resize(end);
  const Stamp last_fix = known.fixes.back().stamp;
  const auto cut = [&](std::vector<OdometrySample>& samples) {
    const auto last = std::find_if(samples.begin(), samples.end(),
                                   [&](const OdometrySample& sample) { return sample.stamp >= last_fix; });
    if (last != samples.end()) samples.erase(last + 1, samples.end());
  };
  cut(known.odometry);
  for (PreparedOdometry& source : known.relative) cut(source.samples);
  for (PreparedSensor& prepared : known.sensors) {
    SensorTable& sensor = prepared.readings;
    const auto first_later = std::upper_bound(sensor.stamps.begin(), sensor.stamps.end(), last_fix);
    sensor.stamps.erase(first_later, sensor.stamps.end());
    sensor.values.resize(sensor.stamps.size() * sensor.columns);
  }
  return known;
}

PosesAtWithheld causal_at_withheld(const PreparedDrive& drive, const FuseDrive& fuse) {
  PosesAtWithheld result;
  result.poses.resize(drive.fixes.size());
  result.position_covariances.resize(drive.fixes.size());
  for (const WithheldRun& run : withheld_runs(drive.fixes)) {
    if (run.begin == 0) continue;
    const PreparedDrive known = known_until(drive, run.end);
    const std::optional<formats::GraphDocument> document = fuse(known);
    if (!document) continue;
    require_fixes_of(known, *document);
    const std::vector<Eigen::Vector3d> poses = poses_of_fixes(*document);
    const auto covariances = evaluated_covariances(*document);
    for (std::size_t i = run.begin; i < run.end; ++i) {
      result.poses[i] = poses[i];
      result.position_covariances[i] = covariances[i];
    }
  }
  return result;
}

}  // namespace waymark::drive
