/// Errors that fade: states of a Gauss-Markov process along a drive, and the edges between them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/edge.hpp>
#include <waymark/core/graph/fields.hpp>
#include <waymark/core/graph/scalar_state.hpp>

namespace waymark {

namespace detail {

/// Returns a multiple of a state that is one plain number or several, as the error of an edge.
template <typename T>
[[nodiscard]] Eigen::Matrix<T, 1, 1> multiple(double factor, const T& x) {
  return Eigen::Matrix<T, 1, 1>(T(x * T(factor)));
}
template <typename T, int N>
[[nodiscard]] Eigen::Matrix<T, N, 1> multiple(double factor, const Eigen::Matrix<T, N, 1>& x) {
  return x * T(factor);
}

}  // namespace detail

/// One step of a Gauss-Markov process: e = x_to - decay x_from, decay = exp(-dt / time constant).
///   struct EdgeClockDecay : GaussMarkovDecay<EdgeClockDecay, VertexClock> {
///     static constexpr std::string_view kTag = "EDGE_CLOCK_DECAY";
///   };
/// @tparam Self the edge type that is derived from it @tparam V its states: plain numbers
template <typename Self, Vertex V>
struct GaussMarkovDecay {
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = V::kTangentSize;
  using Vertices = VertexList<V, V>;
  static constexpr auto fields() { return std::array{field<&GaussMarkovDecay::decay, Self>("decay")}; }

  template <typename T, typename State>
  Eigen::Matrix<T, kErrorDimension, 1> error(const State& from, const State& to) const {
    return detail::multiple(1, to) - detail::multiple(decay, from);
  }

  double decay = 1;
};

/// The same process at a moment between two others: e = x - (before x_earlier + after x_later). Given its
/// neighbours, such a process has no memory.
template <typename Self, Vertex V>
struct GaussMarkovBetween {
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = V::kTangentSize;
  using Vertices = VertexList<V, V, V>;
  static constexpr auto fields() {
    return std::array{field<&GaussMarkovBetween::before, Self>("before"),
                      field<&GaussMarkovBetween::after, Self>("after")};
  }

  template <typename T, typename State>
  Eigen::Matrix<T, kErrorDimension, 1> error(const State& earlier, const State& later,
                                             const State& between) const {
    return detail::multiple(1, between) - detail::multiple(before, earlier) - detail::multiple(after, later);
  }

  double before = 0.5;
  double after = 0.5;
};

/// A stationary Gauss-Markov process of first order, in n independent directions.
/// @tparam V its states: plain numbers, n of them
/// @tparam Decay a GaussMarkovDecay of them @tparam Between a GaussMarkovBetween of them
template <Vertex V, Edge Decay, Edge Between>
class GaussMarkovProcess {
 public:
  /// @param sigma of the process, in the unit of its states @param time_s its correlation time
  /// @param first_sigma of the first state, beside sigma
  GaussMarkovProcess(double sigma, double time_s, double first_sigma = 0)
      : sigma_(sigma), time_s_(time_s), first_sigma_(std::hypot(sigma, first_sigma)) {}

  /// Returns the sigma of the first state.
  [[nodiscard]] double first_sigma() const { return first_sigma_; }

  /// Returns the state at a moment; the first call for it makes the state, at its expectation. Moments may
  /// come in any order.
  [[nodiscard]] VertexIndex at(Stamp stamp, Graph& graph) {
    forget_dropped(graph);
    if (states_.empty()) return begin(stamp, graph);
    if (stamp < states_.back().stamp) return between(stamp, graph);
    const VertexIndex last = states_.back().vertex.in(graph);
    if (last < 0) {
      states_.clear();
      return begin(stamp, graph);
    }
    if (states_.back().stamp == stamp) return last;
    Decay edge;
    edge.decay = decay_to(stamp, states_.back());
    const VertexIndex next = add_state(stamp, edge.decay * value_of(last, graph), graph);
    graph.add_edge(edge, {last, next}, information_of(1 - edge.decay * edge.decay));
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
  static constexpr int kSize = V::kTangentSize;
  using Value = Eigen::Matrix<double, kSize, 1>;
  using Information = Eigen::Matrix<double, kSize, kSize>;

  struct State {
    Stamp stamp;
    KeptVertex vertex;
  };

  [[nodiscard]] VertexIndex begin(Stamp stamp, Graph& graph) {
    const VertexIndex first = add_state(stamp, Value::Zero(), graph);
    add_prior_about_zero(graph, first, first_sigma_);
    states_.push_back({stamp, {}});
    return states_.back().vertex.keep(first, graph);
  }

  /// Returns the state at a moment before the last one. The states around it stay as they are.
  [[nodiscard]] VertexIndex between(Stamp stamp, Graph& graph) {
    const auto after = first_not_before(stamp);
    const VertexIndex later = after->vertex.in(graph);
    if (after->stamp == stamp) return later;
    const bool is_first = after == states_.begin();
    const VertexIndex earlier = is_first ? -1 : std::prev(after)->vertex.in(graph);
    VertexIndex own = 0;
    if (later < 0 || (!is_first && earlier < 0)) {  // a neighbour has left the window before it
      own = add_state(stamp, Value::Zero(), graph);
      add_prior_about_zero(graph, own, sigma_);
    } else if (is_first) {
      Decay edge;
      edge.decay = decay_to(stamp, *after);
      own = add_state(stamp, edge.decay * value_of(later, graph), graph);
      graph.add_edge(edge, {later, own}, information_of(1 - edge.decay * edge.decay));
    } else {
      const double a = decay_to(stamp, *std::prev(after));
      const double b = decay_to(stamp, *after);
      const double share = 1 - a * a * b * b;
      Between edge;
      edge.before = a * (1 - b * b) / share;
      edge.after = b * (1 - a * a) / share;
      own = add_state(stamp, edge.before * value_of(earlier, graph) + edge.after * value_of(later, graph),
                      graph);
      graph.add_edge(edge, {earlier, later, own}, information_of((1 - a * a) * (1 - b * b) / share));
    }
    State state{stamp, {}};
    state.vertex.keep(own, graph);
    states_.insert(after, state);
    return own;
  }

  [[nodiscard]] static Value value_of(VertexIndex state, const Graph& graph) {
    return Eigen::Map<const Value>(graph.value(state).data());
  }
  [[nodiscard]] VertexIndex add_state(Stamp stamp, const Value& value, Graph& graph) const {
    std::array<double, V::kValueSize> numbers{};
    std::copy(value.begin(), value.end(), numbers.begin());
    const VertexIndex state = graph.add_vertex<V>(graph.free_id(), numbers);
    graph.set_stamp(state, stamp);
    return state;
  }
  /// @param share of the variance that is not known
  [[nodiscard]] Information information_of(double share) const {
    return Information::Identity() / (sigma_ * sigma_ * share);
  }

  /// Forgets states that have left the graph: the earliest ones, and none behind one that is left.
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
