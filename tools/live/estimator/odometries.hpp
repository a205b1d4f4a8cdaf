/// Several odometries while they come: which one the nodes are from, and what the others measured between
/// nodes.
///
/// The first odometry gives the nodes. While it is silent the next one that is not takes its place, and
/// hands back when the first one has samples on both sides of a node again. Another one joins the nodes
/// nearest to its own samples, so that no reading counts twice, as in a batch run.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>

namespace waymark::live {

/// What an odometry measured between two nodes that it joins.
struct MeasuredWay {
  std::size_t source = 0;
  Stamp from;
  Stamp to;
  Interval interval;
};

class Odometries {
 public:
  /// @param gap_s an odometry is silent after this time, and after 2.5 of its usual intervals
  Odometries(std::size_t count, double gap_s) : sources_(count), gap_s_(gap_s) {}

  /// Takes a sample of a source. @returns whether it is later than those before
  [[nodiscard]] bool take(std::size_t source, const OdometrySample& sample);
  /// Tells whether a source beside this one has had a sample lately.
  [[nodiscard]] bool another_speaks(std::size_t source, Stamp now) const;
  /// Returns the samples of a source, which has just had one, that are to be nodes; none if the nodes are
  /// another one's. @param last node; empty: there is none
  [[nodiscard]] std::vector<OdometrySample> nodes(std::size_t source, std::optional<Stamp> last) const;
  /// Tells that a node was made of a sample.
  void made_node(std::size_t source, Stamp stamp);
  /// Returns what those which do not give the nodes have measured since the last call.
  /// @param nodes stamps @param giver the source of the last node @param grid_scale of their speeds
  [[nodiscard]] std::vector<MeasuredWay> ways(std::span<const Stamp> nodes, std::size_t giver,
                                              double grid_scale);
  /// Returns the mean motion of a source. It is constant beyond its samples.
  [[nodiscard]] Interval between(std::size_t source, Stamp from, Stamp to, double grid_scale) const;
  void clear();

 private:
  struct Source {
    std::deque<OdometrySample> samples;  // the last seconds
    Stamp begin;                         // of its samples without a silence
    double silence_s = 0;                // a longer one is a silence
    std::optional<Stamp> joined;         // the last node that it joins
    std::optional<Stamp> asked;          // the last sample whose node was looked for
    /// Tells whether it has had a sample lately.
    [[nodiscard]] bool speaks(Stamp now) const {
      return !samples.empty() && seconds_between(samples.back().stamp, now) <= silence_s;
    }
  };
  [[nodiscard]] bool covers(const Source& source, Stamp last, Stamp moment) const;
  void find_ways(std::size_t index, std::span<const Stamp> nodes, double grid_scale,
                 std::vector<MeasuredWay>& ways);

  std::vector<Source> sources_;
  double gap_s_;
};

/// Puts the odometry first that is stated to give the nodes.
void put_nodes_first(drive::DriveDescription& description);

}  // namespace waymark::live
