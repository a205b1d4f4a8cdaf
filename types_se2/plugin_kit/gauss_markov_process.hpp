/// Errors that fade: states of a Gauss-Markov process along a drive, and the edges between them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/scalar_state.hpp>

namespace waymark {

/// A stationary Gauss-Markov process of first order, in n independent directions.
/// @tparam V its states: plain numbers, n of them
/// @tparam Decay e = to - decay from, over two states; it has a member `decay`
/// @tparam Between e = x - (before earlier + after later), over (earlier, later, x): given its neighbours,
/// such a process has no memory. It has members `before` and `after`.
template <Vertex V, Edge Decay, Edge Between>
class GaussMarkovProcess {
 public:
  /// @param sigma of the process, in the unit of its states @param time_s its correlation time
  /// @param first_sigma of the first state, beside sigma
  GaussMarkovProcess(double sigma, double time_s, double first_sigma = 0)
      : sigma_(sigma), time_s_(time_s), first_sigma_(std::hypot(sigma, first_sigma)) {}

  /// Returns the state at a moment; the first call for it makes the state. Moments may come in any order.
  [[nodiscard]] VertexIndex at(Stamp stamp, Graph& graph) {
    forget_dropped(graph);
    if (!states_.empty() && stamp < states_.back().stamp) return between(stamp, graph);
    const VertexIndex last = states_.empty() ? -1 : states_.back().vertex.in(graph);
    if (!states_.empty() && states_.back().stamp == stamp) return last;
    const VertexIndex next = graph.add_vertex<V>(graph.free_id(), kZero);
    graph.set_stamp(next, stamp);
    if (last < 0) {
      add_prior_about_zero(graph, next, first_sigma_);
    } else {
      Decay edge;
      edge.decay = decay_to(stamp, states_.back());
      graph.add_edge(edge, {last, next},
                     Information::Identity() / (sigma_ * sigma_ * (1 - edge.decay * edge.decay)));
    }
    states_.push_back({stamp, {}});
    return states_.back().vertex.keep(next, graph);
  }

  /// Adds root times what the states tell of a process in the plane at a moment.
  void add_expectation(Stamp stamp, const Graph& graph, const Eigen::Matrix2d& root,
                       ExpectedError& error) const {
    const auto after = first_not_before(stamp);
    const double a = after == states_.begin() ? 0 : decay_to(stamp, *std::prev(after));
    const double b = after == states_.end() ? 0 : decay_to(stamp, *after);
    const double share = 1 - a * a * b * b;
    if (a > 0) error.terms.push_back({std::prev(after)->vertex.in(graph), a * (1 - b * b) / share * root});
    if (b > 0) error.terms.push_back({after->vertex.in(graph), b * (1 - a * a) / share * root});
    error.rest += sigma_ * sigma_ * (1 - a * a) * (1 - b * b) / share * root * root.transpose();
  }

 private:
  using Information = Eigen::Matrix<double, V::kTangentSize, V::kTangentSize>;
  static constexpr std::array<double, V::kValueSize> kZero{};

  struct State {
    Stamp stamp;
    KeptVertex vertex;
  };
  /// Returns the state at a moment before the last one. The states around it stay as they are.
  [[nodiscard]] VertexIndex between(Stamp stamp, Graph& graph) {
    const auto after = first_not_before(stamp);
    const VertexIndex later = after->vertex.in(graph);
    if (after->stamp == stamp) return later;
    const VertexIndex own = graph.add_vertex<V>(graph.free_id(), kZero);
    graph.set_stamp(own, stamp);
    const double b = decay_to(stamp, *after);
    if (after == states_.begin()) {
      Decay edge;
      edge.decay = b;
      graph.add_edge(edge, {later, own}, Information::Identity() / (sigma_ * sigma_ * (1 - b * b)));
    } else {
      const auto before = std::prev(after);
      const double a = decay_to(stamp, *before);
      const double share = 1 - a * a * b * b;
      Between edge;
      edge.before = a * (1 - b * b) / share;
      edge.after = b * (1 - a * a) / share;
      const double variance = sigma_ * sigma_ * (1 - a * a) * (1 - b * b) / share;
      graph.add_edge(edge, {before->vertex.in(graph), later, own}, Information::Identity() / variance);
    }
    State state{stamp, {}};
    state.vertex.keep(own, graph);
    states_.insert(after, state);
    return own;
  }

  /// Forgets states that have left the graph.
  void forget_dropped(const Graph& graph) {
    std::size_t gone = 0;
    while (gone < states_.size() && states_[gone].vertex.in(graph) < 0) ++gone;
    states_.erase(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(gone));
  }

  [[nodiscard]] auto first_not_before(Stamp stamp) const {
    return std::lower_bound(states_.begin(), states_.end(), stamp,
                            [](const State& state, Stamp moment) { return state.stamp < moment; });
  }

  [[nodiscard]] double decay_to(Stamp stamp, const State& state) const {
    return std::exp(-std::abs(seconds_between(state.stamp, stamp)) / time_s_);
  }

  double sigma_;
  double time_s_;
  double first_sigma_;
  std::vector<State> states_;  ///< in order of time
};

}  // namespace waymark
