#include <algorithm>
#include <string_view>
#include <utility>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/core/system/detail/incidence.hpp>
#include <waymark/core/system/detail/information_unit.hpp>
#include <waymark/core/system/detail/seen_motions.hpp>
#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>

namespace waymark {
namespace {

using namespace detail;

/// One component, as the gauge judges it.
struct Judged {
  VertexIndex first = -1;
  VertexIndex holds = -1;  ///< what would be held
  bool has_pose = false;   ///< among its vertices
  int count = 0;           ///< vertices
  int motions = 3;         ///< rigid ones that change it
  int rank = 0;            ///< of those that the edges observe
  Eigen::MatrixXd unseen;  ///< the others, if the rank is neither 0 nor full: 3 x (3 - rank)
  /// the present places are special: elsewhere the edges observe more
  bool is_special = false;

  [[nodiscard]] bool is_anchored() const { return rank >= motions; }
  [[nodiscard]] bool is_partly_anchored() const { return rank > 0 && !is_anchored(); }
  /// Tells whether it still turns with a vertex held: all are points.
  [[nodiscard]] bool would_turn() const { return motions == 3 && !has_pose && rank == 0; }
};

Judged judge(const Components& components, std::size_t c, const Eigen::Matrix3d& information, double unit) {
  Judged judged;
  judged.first = components.first[c];
  judged.has_pose = components.pose[c] >= 0;
  judged.holds = judged.has_pose ? components.pose[c] : judged.first;
  judged.count = components.count[c];
  if (!judged.has_pose && judged.count == 1) judged.motions = 2;
  judged.rank = rank_of(information, unit);
  return judged;
}

/// Looks closer at the components that seem to be anchored in part.
void judge_partly_anchored(const Graph& graph, const Components& components, std::vector<Judged>& judged) {
  std::vector<char> asked(judged.size(), 0);
  for (std::size_t c = 0; c < judged.size(); ++c) asked[c] = judged[c].is_partly_anchored();
  const auto none_asked = [&] { return std::count(asked.begin(), asked.end(), 0) == std::ssize(asked); };
  if (none_asked()) return;
  const std::vector<Eigen::Matrix3d> seen = seen_directions(graph, components, asked);
  for (std::size_t c = 0; c < judged.size(); ++c) {
    if (asked[c] == 0) continue;
    judged[c].rank = rank_of(seen[c], 1);
    if (judged[c].is_anchored())
      asked[c] = 0;
    else
      judged[c].unseen = unseen_motions(seen[c], 1);
  }
  if (none_asked()) return;
  const std::vector<Eigen::Matrix3d> elsewhere = seen_elsewhere(graph, components, asked);
  for (std::size_t c = 0; c < judged.size(); ++c)
    if (asked[c] != 0) judged[c].is_special = rank_of(elsewhere[c], 1) > judged[c].rank;
}

std::vector<Judged> judge_components(const Graph& graph, const Components& components) {
  std::vector<Eigen::Matrix3d> information(components.first.size(), Eigen::Matrix3d::Zero());
  const RigidMotionView motion{components.of.data(), components.places.data(), information.data()};
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    graph.batch(b).add_rigid_information(graph.view(), motion);
  std::vector<Judged> judged;
  const double unit = information_unit(graph);
  for (std::size_t c = 0; c < components.first.size(); ++c)
    judged.push_back(judge(components, c, information[c], unit));
  judge_partly_anchored(graph, components, judged);
  return judged;
}

/// Sentences about parts that are alike. The first ones are kept; a file of many parts has as many.
class Sentences {
 public:
  /// @param others what is said of those that are not named: a noun, and what follows their number
  Sentences(std::string_view others, std::string_view end) : others_(others), end_(end) {}

  void add(std::string sentence, std::vector<std::string>& messages) {
    constexpr int kNamed = 5;
    if (++count_ <= kNamed)
      messages.push_back(std::move(sentence));
    else
      ++unnamed_;
  }
  void finish(std::vector<std::string>& messages) const {
    if (unnamed_ == 0) return;
    std::string sentence(others_);
    messages.push_back(sentence.append(": ").append(std::to_string(unnamed_)).append(end_));
  }

 private:
  std::string_view others_;
  std::string_view end_;
  int count_ = 0;
  int unnamed_ = 0;
};

std::string anchored_in_part(const Graph& graph, const Judged& judged) {
  return "vertex " + to_string(graph.id(judged.first)) +
         " and the vertices joined to it are anchored in only " + std::to_string(judged.rank) + " of " +
         std::to_string(judged.motions) + " rigid motions";
}

/// Holds the first vertex of each part of poses that are not of the plane, if only edges between vertices
/// join them: nothing else can be known about their gauge.
void hold_foreign_poses(const Graph& graph, Gauge& gauge) {
  if (find_joined_foreign_pose(graph) < 0) return;
  const std::vector<std::int32_t> root = find_components(graph);
  const std::vector<char> has_edge = vertices_with_edges(graph);
  Sentences sentences("further vertices that only edges between vertices join", ", held likewise");
  std::vector<char> anchored(graph.vertex_count(),
                             0);  // by root: by a fixed vertex, or an edge on one vertex
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    for_each_edge(graph.batch(b), [&](std::span<const VertexIndex> vertices) {
      const bool has_fixed =
          std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) { return graph.fixed(v); });
      if (vertices.size() > 1 && !has_fixed) return;
      for (const VertexIndex v : vertices) anchored[at(root[at(v)])] = 1;
    });
  }
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    const auto vertex = static_cast<VertexIndex>(v);
    if (graph.fixed(vertex) || has_edge[v] == 0 || !is_foreign_pose(graph.vertex_type(vertex))) continue;
    char& is_anchored = anchored[at(root[v])];
    if (is_anchored == 0) {
      gauge.held[v] = 1;
      sentences.add(graph.vertex_type(vertex).tag + " " + to_string(graph.id(vertex)) +
                        " is held at its present value: only edges between vertices are there",
                    gauge.messages);
    }
    is_anchored = 1;
  }
  sentences.finish(gauge.messages);
}

/// Returns the coordinates of a vertex whose keeping stops the unseen motions; 0 if there are none. A heading is
/// preferred: any turn changes it, and a place on a circle is no sure hold.
char coordinates_that_stop(const Graph& graph, const RigidMotionView::Place& place, const Judged& judged,
                           VertexIndex v) {
  constexpr double kPreference = 10;
  constexpr double kStops = 1e-3;
  const Eigen::VectorXd turn = own_turn(graph, v);
  Eigen::MatrixXd moved = motion_of(graph, v, place) * judged.unseen;  // metres and radians
  for (Eigen::Index row = 0; row < moved.rows(); ++row)
    if (turn[row] != 0) moved.row(row) *= kPreference * place.extent;
  char marks = 0;
  for (int held = 0; held < judged.motions - judged.rank; ++held) {
    Eigen::Index row = 0;
    if (!(moved.rowwise().norm().maxCoeff(&row) > kStops) || row >= kMarkedCoordinates) return 0;
    marks |= mark_of_coordinate(static_cast<int>(row));
    const Eigen::RowVectorXd stopped = moved.row(row).normalized();
    moved -= moved * stopped.transpose() * stopped;
  }
  return marks;
}

std::string words_for_coordinates(const Graph& graph, const Judged& judged, VertexIndex v, char marks) {
  const VertexType& type = graph.vertex_type(v);
  std::string names;
  int count = 0;
  for (int k = 0; k < type.tangent_size && k < kMarkedCoordinates; ++k) {
    if (!holds_coordinate(marks, k)) continue;
    names += count++ == 0 ? "" : " and ";
    names += type.value_size == type.tangent_size ? type.value_names[at(k)]
                                                  : "coordinate " + std::to_string(k) + " of the tangent";
  }
  return anchored_in_part(graph, judged) + " (typical: a single GNSS fix): " + names + " of vertex " +
         to_string(graph.id(v)) +
         (count == 1 ? " is held at its present value" : " are held at their present values");
}

/// Holds as many coordinates of one vertex as there are unseen motions.
/// @return a sentence that says it; empty where no vertex has them
std::string hold_coordinates(const Graph& graph, const Components& components, std::size_t c,
                             const Judged& judged, Gauge& gauge) {
  for (VertexIndex v = judged.holds; v >= 0; v = components.next[at(v)]) {
    const char marks = coordinates_that_stop(graph, components.places[c], judged, v);
    if (marks == 0) continue;
    gauge.held[at(v)] = marks;
    return words_for_coordinates(graph, judged, v, marks);
  }
  return {};
}

/// @throws InputError for one whose solution is not determined whatever is held
[[noreturn]] void refuse(const Graph& graph, const Judged& judged) {
  if (judged.rank > 0)
    throw InputError(
        anchored_in_part(graph, judged) +
        ", so the solution is not determined (typical: a drive with a single fix or fixes at one place, a point seen in one "
        "direction); add fixes at another place or a heading, or FIX one vertex");
  throw InputError("nothing anchors vertex " + to_string(graph.id(judged.first)) + " and the " +
                   std::to_string(judged.count - 1) +
                   " vertices joined to it, which are all points: with one of them FIXed they still turn "
                   "about it; FIX two, or add measurements of where they are");
}

std::string words_for_vertex(const Graph& graph, const Judged& judged) {
  if (judged.rank > 0)
    return anchored_in_part(graph, judged) + ": it is held at its present value until more is measured";
  return "nothing anchors vertex " + to_string(graph.id(judged.holds)) + " and the " +
         std::to_string(judged.count - 1) + " vertices joined to it: it is held at its present value";
}

}  // namespace

Gauge find_gauge(const Graph& graph, PartlyAnchored partly) {
  const Components components = describe_components(graph);
  const std::vector<Judged> all = judge_components(graph, components);
  Gauge gauge;
  gauge.held.assign(graph.vertex_count(), 0);
  Sentences loose("further parts that nothing anchors",
                  "; the first vertex of each of them is held at its present value");
  Sentences anchored_partly("further parts that are anchored in part",
                            "; what no edge sees of them is held at its present value");
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Judged& judged = all[c];
    if (judged.is_anchored()) continue;
    const bool is_part = judged.rank > 0;
    Sentences& sentences = is_part ? anchored_partly : loose;
    if (is_part) gauge.partly.push_back({judged.holds, components.places[c], judged.unseen});
    if (partly == PartlyAnchored::hold_coordinates) {
      // Only motions that stay unseen wherever the vertices go are no part of the solution. The heading of a drive,
      // which has stamps, is a result and no convention.
      const bool is_gauge =
          is_part && judged.motions == 3 && !judged.is_special && components.stamped[c] == 0;
      std::string said = is_gauge ? hold_coordinates(graph, components, c, judged, gauge) : std::string();
      if (!said.empty()) {
        sentences.add(std::move(said), gauge.messages);
        continue;
      }
      if (is_part || judged.would_turn()) refuse(graph, judged);
    }
    gauge.held[at(judged.holds)] = kWhollyHeld;
    sentences.add(words_for_vertex(graph, judged), gauge.messages);
  }
  loose.finish(gauge.messages);
  anchored_partly.finish(gauge.messages);
  hold_foreign_poses(graph, gauge);
  return gauge;
}

std::int64_t count_unknowns(const Graph& graph, const Gauge& gauge) {
  const std::vector<char> has_edge = vertices_with_edges(graph);
  std::int64_t count = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const char mark = gauge.held[at(v)];
    if (has_edge[at(v)] == 0 || graph.fixed(v) || is_wholly_held(mark)) continue;
    const int size = graph.vertex_type(v).tangent_size;
    count += size;
    for (int k = 0; k < size && k < kMarkedCoordinates; ++k) count -= holds_coordinate(mark, k) ? 1 : 0;
  }
  return count;
}

}  // namespace waymark
