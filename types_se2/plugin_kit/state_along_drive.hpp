/// The calibration states of a drive, such as biases and scales: the vertex that an interval uses,
/// and the edges between these vertices.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {

/// How a state is estimated.
enum class StateModel {
  off,         ///< held at 0
  constant,    ///< one value for the drive
  random_walk  ///< one value per period; consecutive values differ little
};

struct StateOptions {
  StateModel model = StateModel::off;
  double prior_sigma = 0;  ///< prior on the (first) value about 0, in the unit of the state
  double walk_sigma = 0;   ///< change after one second, unit / sqrt(s)
  double period_s = 10;    ///< duration of one value of a random walk
};

/// One state along a drive. Its vertices are created while the intervals are visited in order.
template <Vertex V, Edge Walk>
class StateAlongDrive {
 public:
  explicit StateAlongDrive(const StateOptions& options) : options_(options) {}

  [[nodiscard]] bool is_calibrated() const { return options_.model != StateModel::off; }

  /// Returns the vertex of the interval that begins at `stamp`. Stamps must not decrease.
  [[nodiscard]] VertexIndex at(Stamp stamp, Graph& graph) {
    const VertexIndex last = last_.in(graph);
    if (last < 0) return begin(stamp, graph);
    const bool ends =
        options_.model == StateModel::random_walk && seconds_between(since_, stamp) >= options_.period_s;
    return ends ? step(last, stamp, graph) : last;
  }

 private:
  VertexIndex begin(Stamp stamp, Graph& graph) {
    const VertexIndex first = graph.add_vertex<V>(graph.free_id(), {0});
    since_ = stamp;
    if (is_calibrated()) {
      // A constant belongs to no time, so that a sliding window keeps it.
      if (options_.model == StateModel::random_walk) graph.set_stamp(first, stamp);
      add_prior_about_zero(graph, first, options_.prior_sigma);
    } else {
      graph.set_fixed(first, true);
    }
    return last_.keep(first, graph);
  }

  VertexIndex step(VertexIndex last, Stamp stamp, Graph& graph) {
    const VertexIndex next = graph.add_vertex<V>(graph.free_id(), {0});
    graph.set_stamp(next, stamp);
    const double variance = options_.walk_sigma * options_.walk_sigma * seconds_between(since_, stamp);
    graph.add_edge(Walk{}, {last, next}, Eigen::Matrix<double, 1, 1>(1 / variance));
    since_ = stamp;
    return last_.keep(next, graph);
  }

  StateOptions options_;
  KeptVertex last_;
  Stamp since_;
};

/// Returns the options of a state NAME: NAME (off, constant, random_walk), NAME_sigma, NAME_walk.
/// @param model the default of NAME
[[nodiscard]] std::vector<OptionInfo> state_options(const std::string& name, const std::string& unit,
                                                    const std::string& model, const std::string& prior_sigma,
                                                    const std::string& walk_sigma, const std::string& what);

/// Returns the option calibration_period, which all states of a model share.
[[nodiscard]] OptionInfo calibration_period_option();

/// Reads the options of a state NAME, and calibration_period.
[[nodiscard]] StateOptions read_state(const CheckedOptions& options, const std::string& name);

}  // namespace waymark
