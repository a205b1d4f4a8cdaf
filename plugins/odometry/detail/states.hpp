/// The calibration states of a drive: the vertex that an interval uses, and the edges between
/// these vertices.
#pragma once

#include <string>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/scalar_state.hpp>

namespace waymark::plugins::odometry {

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
  StateAlongDrive(const StateOptions& options, Graph& graph) : options_(options), graph_(graph) {}

  /// Returns the vertex of the interval that begins at `stamp`. Stamps must not decrease.
  [[nodiscard]] VertexIndex at(Stamp stamp) {
    if (vertex_ < 0) {
      begin(stamp);
    } else if (options_.model == StateModel::random_walk &&
               seconds_between(since_, stamp) >= options_.period_s) {
      step(stamp);
    }
    return vertex_;
  }

 private:
  void begin(Stamp stamp) {
    vertex_ = graph_.add_vertex<V>(graph_.free_id(), {0});
    since_ = stamp;
    if (options_.model == StateModel::off) {
      graph_.set_fixed(vertex_, true);
      return;
    }
    graph_.set_stamp(vertex_, stamp);
    add_prior_about_zero(graph_, vertex_, options_.prior_sigma);
  }

  void step(Stamp stamp) {
    const VertexIndex next = graph_.add_vertex<V>(graph_.free_id(), {0});
    graph_.set_stamp(next, stamp);
    const double variance = options_.walk_sigma * options_.walk_sigma * seconds_between(since_, stamp);
    graph_.add_edge(Walk{}, {vertex_, next}, Eigen::Matrix<double, 1, 1>(1 / variance));
    vertex_ = next;
    since_ = stamp;
  }

  const StateOptions& options_;
  Graph& graph_;
  VertexIndex vertex_ = -1;  // none yet
  Stamp since_;
};

/// Returns the options of a state NAME: NAME (off, constant, random_walk), NAME_sigma, NAME_walk.
[[nodiscard]] std::vector<OptionInfo> state_options(const std::string& name, const std::string& unit,
                                                    const std::string& prior_sigma,
                                                    const std::string& walk_sigma, const std::string& what);

}  // namespace waymark::plugins::odometry
