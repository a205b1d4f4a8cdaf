#include <waymark/tools/drive/model/start_search.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr int kHeadings = 12;
constexpr int kMostIterations = 50;

std::vector<Eigen::Vector3d> reckoned(const Timeline& timeline, const Eigen::Vector3d& first,
                                      double standstill_mps) {
  std::vector<Eigen::Vector3d> poses = dead_reckon(timeline, first, standstill_mps);
  for (Eigen::Vector3d& pose : poses) pose[2] = wrap_angle(pose[2]);
  return poses;
}

/// Marks the vertices whose place is known before the drive: fixed ones, and those with a prior of their own.
std::vector<char> known_places(const Graph& graph) {
  std::vector<char> known(graph.vertex_count(), 0);
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    known[static_cast<std::size_t>(v)] = graph.fixed(v);
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag != GaussianPriorBatch::kTag) continue;
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e)
      if (const auto of = graph.batch(b).vertices(e); of.size() == 1)
        known[static_cast<std::size_t>(of[0])] = 1;
  }
  return known;
}

/// Returns the middle of the places that are known, such as the landmarks of a map.
std::optional<Eigen::Vector2d> middle_of_known_places(const Graph& graph) {
  const std::vector<char> known = known_places(graph);
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const VertexType& type = graph.vertex_type(v);
    if (known[static_cast<std::size_t>(v)] == 0 || type.value_size < 2 || type.position == nullptr) continue;
    sum += Eigen::Vector2d(graph.value(v)[0], graph.value(v)[1]);
    ++count;
  }
  return count == 0 ? std::nullopt : std::optional<Eigen::Vector2d>(sum / count);
}

/// Finds minima of a coarse drive from several first poses.
class StartSearch {
 public:
  StartSearch(CoarseDrive coarse, const FusionSettings& settings, const TypeRegistry& registry)
      : coarse_(std::move(coarse)), settings_(settings), registry_(registry) {}

  [[nodiscard]] Graph graph_from(const Eigen::Vector3d& first) {
    PlacedDrive& drive = coarse_.drive;
    drive.start.poses = reckoned(drive.timeline, first, drive.standstill_mps);
    return build_graph(drive, coarse_.sensors, settings_, registry_).graph;
  }

  void try_from(const Eigen::Vector3d& first) {
    Graph graph = graph_from(first);
    BlockCholesky cholesky;
    OptimizerOptions options;
    options.max_iterations = kMostIterations;
    (void)optimize(graph, *registry_.make_algorithm("dogleg"), cholesky, options);
    const double chi2 = graph.chi2();
    if (!(chi2 < lowest_)) return;
    lowest_ = chi2;
    poses_.clear();
    for (std::size_t node = 0; node < coarse_.drive.timeline.stamps.size(); ++node) {
      const auto value = graph.value(static_cast<VertexIndex>(node));
      poses_.emplace_back(value[0], value[1], value[2]);
    }
  }

  /// Returns the poses of all nodes at the lowest minimum. Between coarse nodes the odometry says them.
  [[nodiscard]] std::vector<Eigen::Vector3d> poses(const Timeline& timeline, double standstill_mps) const {
    if (poses_.empty()) throw InputError("no start of the drive has a minimum; state 'first_pose'");
    const std::vector<Eigen::Vector3d> way = reckoned(timeline, Eigen::Vector3d::Zero(), standstill_mps);
    std::vector<Eigen::Vector3d> result;
    std::size_t last = 0;      // coarse node
    std::size_t last_all = 0;  // the same one among all nodes
    for (std::size_t i = 0; i < timeline.stamps.size(); ++i) {
      if (last + 1 < poses_.size() && coarse_.drive.timeline.stamps[last + 1] <= timeline.stamps[i]) {
        ++last;
        last_all = i;
      }
      const auto pose = [](const Eigen::Vector3d& p) { return Pose2<double>(p[0], p[1], p[2]); };
      result.push_back(compose(pose(poses_[last]), between(pose(way[last_all]), pose(way[i]))).vector());
    }
    return result;
  }

 private:
  CoarseDrive coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  double lowest_ = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Vector3d> poses_;
};

/// @throws InputError if the graph may be moved or turned as a whole
void require_anchor(const Graph& graph) {
  std::string missing;
  try {
    if (find_gauge(graph).messages.empty()) return;
  } catch (const InputError& error) {
    missing = std::string(" (") + error.what() + ")";
  }
  throw InputError("no source says where the vehicle is" + missing +
                   "; add a receiver ('gnss'), a sensor that sees known places, or state 'first_pose'");
}

}  // namespace

void search_start(std::span<const PreparedSensor> sensors, const FusionSettings& settings,
                  const TypeRegistry& registry, PlacedDrive& placed) {
  const std::optional<FirstPose>& stated = placed.first_pose;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  if (stated && stated->position) first.head<2>() = *stated->position;
  if (stated && stated->heading_rad) first[2] = *stated->heading_rad;
  placed.start = {};
  placed.start.poses = reckoned(placed.timeline, first, placed.standstill_mps);
  StartSearch search(coarsen(placed, sensors), settings, registry);
  const Graph graph = search.graph_from(first);
  require_anchor(graph);
  if (stated && stated->position && stated->heading_rad) return;
  if (!stated || !stated->position)
    first.head<2>() = middle_of_known_places(graph).value_or(Eigen::Vector2d(0, 0));
  const bool known_heading = stated && stated->heading_rad;
  for (int i = 0; i < (known_heading ? 1 : kHeadings); ++i) {
    search.try_from(first);
    first[2] = wrap_angle(first[2] + 2 * std::numbers::pi / kHeadings);
  }
  placed.start.poses = search.poses(placed.timeline, placed.standstill_mps);
  placed.start.note = "no receiver: of several first poses, the one with the lowest minimum is the start";
}

}  // namespace waymark::drive
