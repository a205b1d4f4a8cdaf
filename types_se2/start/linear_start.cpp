#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <waymark/core/base/detail/disjoint_sets.hpp>
#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/system/foreign_poses.hpp>
#include <waymark/core/system/structure.hpp>
#include <waymark/types_se2/start/detail/bodies.hpp>
#include <waymark/types_se2/start/detail/least_squares.hpp>
#include <waymark/types_se2/start/detail/points.hpp>
#include <waymark/types_se2/start/detail/relations.hpp>
#include <waymark/types_se2/start/detail/starts.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {
namespace {

using namespace linear_start_detail;
using detail::at;

Complex complex(const Eigen::Vector2d& v) {
  return {v[0], v[1]};
}

/// One aspect of the graph, headings or positions: the free vertices that its relations join, and
/// the anchors they are joined to.
struct Aspect {
  explicit Aspect(std::size_t vertices) : parts(vertices), related(vertices, 0), anchored(vertices, 0) {}
  detail::DisjointSets parts;  ///< of vertices that relations join
  std::vector<char> related;   ///< per vertex: some relation contains it
  /// per first vertex of a part: a relation ties the part to a known value
  std::vector<char> anchored;
};

class LinearStart {
 public:
  explicit LinearStart(const Graph& graph)
      : graph_(graph),
        relations_(planar_relations(graph)),
        headings_(graph.vertex_count()),
        positions_(graph.vertex_count()),
        bones_(graph.vertex_count()),
        turned_(graph.vertex_count(), 0),
        fixed_by_places_(graph.vertex_count(), 0),
        c_(graph.vertex_count()),
        p_(graph.vertex_count()) {}

  InitialValues make() {
    InitialValues start;
    if (const VertexIndex foreign = find_joined_foreign_pose(graph_); foreign >= 0) {
      start.note = foreign_note(graph_, foreign);
      return start;
    }
    find_parts();
    find_order();
    centre_ = find_centre();
    read_values();
    if (!solve_headings()) {
      start.note = "the edges do not determine all headings";
      return start;
    }
    join_by_points();
    if (!solve_positions(positions_)) {
      start.note = "the edges do not determine all positions";
    } else {
      start.values = values();
    }
    return start;
  }

 private:
  [[nodiscard]] bool known(VertexIndex v) const { return v == Relation::kWorld || graph_.fixed(v); }
  [[nodiscard]] bool is_pose(VertexIndex v) const { return graph_.vertex_type(v).tag == VertexSe2::kTag; }

  [[nodiscard]] bool is_point(VertexIndex v) const {
    return v != Relation::kWorld && graph_.vertex_type(v).tag == VertexXy::kTag;
  }
  /// Tells whether a relation ties positions, and none of them is that of a point.
  [[nodiscard]] bool is_bone(const Relation& relation) const {
    return relation.position_weight > 0 && !is_point(relation.from) && !is_point(relation.to);
  }

  void note(Aspect& aspect, const Relation& relation) {
    for (const VertexIndex v : {relation.from, relation.to}) {
      if (!known(v)) aspect.related[at(v)] = 1;
    }
    if (!known(relation.from) && !known(relation.to)) aspect.parts.join(relation.from, relation.to);
  }

  void anchor(Aspect& aspect, const Relation& relation) {
    if (known(relation.from) == known(relation.to)) return;
    aspect.anchored[at(aspect.parts.of(known(relation.from) ? relation.to : relation.from))] = 1;
  }

  void find_parts() {
    for (const Relation& relation : relations_) {
      if (relation.heading_weight > 0) note(headings_, relation);
      if (relation.position_weight > 0) note(positions_, relation);
      if (is_bone(relation)) note(bones_, relation);
    }
    for (const Relation& relation : relations_) {
      if (relation.heading_weight > 0) anchor(headings_, relation);
      if (relation.position_weight > 0) anchor(positions_, relation);
      if (is_bone(relation)) anchor(bones_, relation);
    }
    // A place without a heading: the positions must give the headings of its part.
    for (const Relation& relation : relations_) {
      if (relation.heading_weight > 0 || !(relation.position_weight > 0)) continue;
      if (known(relation.from) == known(relation.to)) continue;
      fixed_by_places_[at(positions_.parts.of(known(relation.from) ? relation.to : relation.from))] = 1;
    }
  }

  /// One elimination order of the free vertices, for both systems.
  void find_order() {
    std::vector<std::vector<int>> above(
        c_.size());  // per vertex its neighbours before it: the upper triangle
    for (const Relation& relation : relations_) {
      if (known(relation.from) || known(relation.to)) continue;
      const VertexIndex first = std::min(relation.from, relation.to);
      above[at(std::max(relation.from, relation.to))].push_back(first);
    }
    std::vector<std::int64_t> begin{0};
    std::vector<int> rows;
    for (std::vector<int>& column : above) {
      std::sort(column.begin(), column.end());
      column.erase(std::unique(column.begin(), column.end()), column.end());
      rows.insert(rows.end(), column.begin(), column.end());
      begin.push_back(static_cast<std::int64_t>(rows.size()));
    }
    const std::vector<char> dense(c_.size(), 0);
    order_ = order_blocks(begin, rows, dense).order;
  }

  [[nodiscard]] bool in_places(VertexIndex v) {
    return !known(v) && fixed_by_places_[at(positions_.parts.of(v))] != 0;
  }

  /// Returns some known place. Numbers relative to it keep their digits if the origin of the frame
  /// is far away.
  [[nodiscard]] Complex find_centre() const {
    for (const Relation& relation : relations_) {
      if (!(relation.position_weight > 0) || !known(relation.from)) continue;
      if (relation.from == Relation::kWorld) return complex(relation.translation);
      const auto pose = graph_.value(relation.from);
      return complex(Eigen::Vector2d(pose[0], pose[1]) + rotate(pose[2], relation.translation));
    }
    return 0;
  }

  void read_values() {
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(c_.size()); ++v) {
      const auto value = graph_.value(v);
      if (graph_.vertex_type(v).position == nullptr) continue;
      p_[at(v)].value = Complex(value[0], value[1]) - centre_;
      if (is_pose(v)) c_[at(v)].value = std::polar(1.0, value[2]);
    }
  }

  [[nodiscard]] Quantity c(VertexIndex v) const {
    return v == Relation::kWorld ? Quantity{-1, 1} : c_[at(v)];
  }
  [[nodiscard]] Quantity p(VertexIndex v) const {
    return v == Relation::kWorld ? Quantity{-1, -centre_} : p_[at(v)];
  }

  bool solve_headings() {
    LeastSquares system;
    // Parts whose headings are visible in the positions, at least partly.
    std::vector<char> seen(c_.size(), 0);
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(c_.size()); ++v) {
      if (headings_.related[at(v)] && in_places(v)) seen[at(headings_.parts.of(v))] = 1;
    }
    for (const VertexIndex v : order_) {
      if (in_places(v) && positions_.related[at(v)]) p_[at(v)].index = system.add_unknown();
      if (!headings_.related[at(v)]) continue;
      const VertexIndex part = headings_.parts.of(v);
      const bool held = v == part && !headings_.anchored[at(part)] && !seen[at(part)];
      if (!held) c_[at(v)].index = system.add_unknown();
    }
    for (const Relation& r : relations_) {
      if (r.heading_weight > 0) {
        system.add_equation<2>(r.heading_weight, {1, -std::polar(1.0, r.turn)}, {c(r.to), c(r.from)});
      }
      const bool placed = in_places(r.to) || (r.from != Relation::kWorld && in_places(r.from));
      if (r.position_weight > 0 && placed) {
        system.add_equation<4>(r.position_weight, {1, complex(r.lever), -1, -complex(r.translation)},
                               {p(r.to), c(r.to), p(r.from), c(r.from)});
      }
    }
    const auto solution = system.solve();
    if (!solution) return false;
    std::vector<char> open(c_.size(), 0);
    // Turns are rounded too, and headings that are known have length 1.
    const double shortest = kDistinct * std::max(solution->rounding, std::numeric_limits<double>::epsilon());
    for (std::size_t v = 0; v < c_.size(); ++v) {
      if (c_[v].index < 0) continue;
      const Complex relaxed = solution->unknowns[at(c_[v].index)];
      const double length = std::abs(relaxed);
      open[v] = length > shortest ? 0 : 1;
      c_[v] = {-1, open[v] != 0 ? 0 : relaxed / length};
    }
    for (Quantity& p : p_) p.index = -1;
    return close_gaps(std::move(open));
  }

  /// Gives a heading that vanishes in rounding (contradictory edges shorten relaxed headings) the direction that
  /// an edge to a neighbour says, along the fewest edges. @returns false: some have none
  bool close_gaps(std::vector<char> open) {
    if (std::find(open.begin(), open.end(), 1) == open.end()) return true;
    std::vector<std::vector<const Relation*>> edges(open.size());
    std::vector<VertexIndex> queue;
    const auto close = [&](VertexIndex v, Complex heading) {
      open[at(v)] = 0;
      c_[at(v)].value = heading;
      queue.push_back(v);
    };
    for (const Relation& r : relations_) {
      if (!(r.heading_weight > 0)) continue;
      edges[at(r.to)].push_back(&r);
      if (r.from != Relation::kWorld)
        edges[at(r.from)].push_back(&r);
      else if (open[at(r.to)] != 0)
        close(r.to, std::polar(1.0, r.turn));
    }
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(open.size()); ++v)
      if (open[at(v)] == 0 && !edges[at(v)].empty()) queue.push_back(v);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const VertexIndex v = queue[next];
      const Complex heading = c_[at(v)].value;
      for (const Relation* r : edges[at(v)]) {
        if (r->from == v && open[at(r->to)] != 0) close(r->to, heading * std::polar(1.0, r->turn));
        if (r->to == v && r->from != Relation::kWorld && open[at(r->from)] != 0)
          close(r->from, heading * std::polar(1.0, -r->turn));
      }
    }
    return std::find(open.begin(), open.end(), 1) == open.end();
  }

  /// Returns the number of each pose's body: poses that relations join in their headings and positions alike. What the
  /// joint system of headings and positions has turned already is no body, unless it has its place without points.
  [[nodiscard]] std::vector<int> find_bodies() {
    const auto count = static_cast<VertexIndex>(c_.size());
    std::vector<VertexIndex> bone_of(c_.size(), -1);     // per first vertex of a heading part
    std::vector<VertexIndex> heading_of(c_.size(), -1);  // per first vertex of a part of bones
    std::vector<char> torn(c_.size(), 0);                // per first vertex of either
    for (VertexIndex v = 0; v < count; ++v) {
      if (!is_pose(v) || known(v)) continue;
      const VertexIndex heading = headings_.parts.of(v);
      const VertexIndex bone = bones_.parts.of(v);
      if (bone_of[at(heading)] < 0) bone_of[at(heading)] = bone;
      if (heading_of[at(bone)] < 0) heading_of[at(bone)] = heading;
      if (bone_of[at(heading)] != bone || heading_of[at(bone)] != heading)
        torn[at(heading)] = torn[at(bone)] = 1;
    }
    std::vector<int> bodies(c_.size(), kNoBody);
    std::vector<int> number(c_.size(), kNoBody);  // per first vertex of a part of bones
    int next = kWorldBody;
    for (VertexIndex v = 0; v < count; ++v) {
      if (!is_pose(v)) continue;
      const VertexIndex bone = bones_.parts.of(v);
      if (known(v) || bones_.anchored[at(bone)]) {
        bodies[at(v)] = kWorldBody;
      } else if (!in_places(v) && !headings_.anchored[at(headings_.parts.of(v))] && torn[at(bone)] == 0) {
        if (number[at(bone)] == kNoBody) number[at(bone)] = ++next;
        bodies[at(v)] = number[at(bone)];
      }
    }
    return bodies;
  }

  /// Turns and moves parts of which the edges say nothing but the points that they share with others.
  void join_by_points() {
    const std::vector<int> bodies = find_bodies();
    if (!has_several(graph_, bodies)) return;
    std::vector<Sighting> sightings = planar_sightings(graph_);
    if (sightings.empty()) return;
    const std::vector<Quantity> before = p_;
    if (!solve_positions(bones_)) {
      p_ = before;
      return;
    }
    std::vector<double> values = graph_.values();
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(p_.size()); ++v) {
      if (graph_.vertex_type(v).position == nullptr) continue;
      double* value = values.data() + graph_.offsets()[at(v)];
      value[0] = p_[at(v)].value.real();
      value[1] = p_[at(v)].value.imag();
      if (is_pose(v)) value[2] = std::arg(c_[at(v)].value);
    }
    turned_ = join_bodies(graph_, std::move(sightings), bodies, values);
    for (std::size_t v = 0; v < p_.size(); ++v) {
      if (turned_[v] == 0) continue;
      const double* value = values.data() + graph_.offsets()[v];
      p_[v].value = {value[0], value[1]};
      c_[v].value = std::polar(1.0, value[2]);
    }
  }

  /// @param aspect all positions or bones
  bool solve_positions(Aspect& aspect) {
    LeastSquares system;
    for (const VertexIndex v : order_) {
      if (!aspect.related[at(v)]) continue;
      const VertexIndex part = aspect.parts.of(v);
      if (v != part || aspect.anchored[at(part)]) p_[at(v)].index = system.add_unknown();
    }
    for (const Relation& r : relations_) {
      if (!(r.position_weight > 0) || (&aspect == &bones_ && !is_bone(r))) continue;
      const Complex offset = c(r.from).value * complex(r.translation) - c(r.to).value * complex(r.lever);
      system.add_equation<2>(r.position_weight, {1, -1}, {p(r.to), p(r.from)}, offset);
    }
    const auto solution = system.solve();
    if (!solution) return false;
    for (Quantity& p : p_) {
      if (p.index >= 0) p = {-1, solution->unknowns[at(p.index)]};
    }
    return true;
  }

  /// Tells per vertex whether the linear systems have placed it. Points that are seen without a range are not.
  [[nodiscard]] std::vector<char> placed() const {
    std::vector<char> placed(p_.size());
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(p_.size()); ++v)
      placed[at(v)] = graph_.fixed(v) || positions_.related[at(v)] != 0 ? 1 : 0;
    return placed;
  }

  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> values = graph_.values();
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(p_.size()); ++v) {
      double* value = values.data() + graph_.offsets()[at(v)];
      if (!graph_.fixed(v) && (positions_.related[at(v)] != 0 || turned_[at(v)] != 0)) {
        value[0] = (p_[at(v)].value + centre_).real();
        value[1] = (p_[at(v)].value + centre_).imag();
      }
      if (!graph_.fixed(v) && (headings_.related[at(v)] != 0 || turned_[at(v)] != 0))
        value[2] = std::arg(c_[at(v)].value);
    }
    place_points(graph_, planar_sightings(graph_), placed(), values);
    return values;
  }

  /// A relaxed heading has a direction if it is so many times longer than the errors of rounding. In graphs of
  /// much noise short ones have one as well.
  static constexpr double kDistinct = 100;

  const Graph& graph_;
  std::vector<Relation> relations_;
  Aspect headings_;
  Aspect positions_;
  Aspect bones_;                       // positions without those of points
  std::vector<char> turned_;           // per vertex: the points that it shares have told its heading
  std::vector<char> fixed_by_places_;  // per position part's first vertex
  std::vector<VertexIndex> order_;
  Complex centre_ = 0;
  std::vector<Quantity> c_;  // per vertex
  std::vector<Quantity> p_;  // per vertex, relative to centre_
};

}  // namespace

StartType linear_start() {
  return {"linear", "headings from a linear system (anchored by positions, if there are any), then positions",
          [](const Graph& graph) { return LinearStart(graph).make(); }};
}

}  // namespace waymark
