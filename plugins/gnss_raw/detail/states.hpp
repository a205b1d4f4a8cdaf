/// The states that raw measurements need beside the poses, as the epochs of a drive come in.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/plugins/gnss_raw/gnss_raw.hpp>
#include <waymark/types_se2/plugin_kit/state_along_drive.hpp>

namespace waymark::plugins::gnss_raw {

/// The errors of satellites that last: for each satellite a first-order Gauss-Markov process of
/// variance 1.
class LastingErrors {
 public:
  struct Parameters {
    bool present = true;
    double time_s = 1;    ///< correlation time
    double period_s = 1;  ///< between two values
  };

  explicit LastingErrors(const Parameters& parameters) : parameters_(parameters) {}

  /// Returns the error of a satellite at a moment: one value for each period, 0 if there is none.
  [[nodiscard]] VertexIndex of(int system, int satellite, Stamp stamp, Graph& graph);

 private:
  struct OfSatellite {
    KeptVertex vertex;
    Stamp since;
  };

  Parameters parameters_;
  std::map<std::pair<int, int>, OfSatellite> satellites_;
  KeptVertex no_error_;
};

class States {
 public:
  struct Parameters {
    StateOptions height{};
    double clock_walk = 1;  ///< m / sqrt(s)
    double drift_walk = 1;  ///< m/s / sqrt(s)
    double system_bias_sigma_m = 1;
    LastingErrors::Parameters multipath{};
    LastingErrors::Parameters slow{};
  };

  explicit States(const Parameters& parameters)
      : parameters_(parameters),
        height_(parameters.height),
        multipath_(parameters.multipath),
        slow_(parameters.slow) {}

  [[nodiscard]] VertexIndex height(Stamp stamp, Graph& graph) { return height_.at(stamp, graph); }

  /// Makes the clock of the next epoch. Steps by whole milliseconds are absorbed.
  /// @param offset_m about the clock; NaN: not known
  [[nodiscard]] VertexIndex clock(Stamp stamp, double offset_m, Graph& graph);
  /// Whole milliseconds of light that are taken off the pseudoranges of the epoch, m.
  [[nodiscard]] double absorbed_m() const { return absorbed_m_; }

  /// Returns the bias of a system. That of the first one that is asked for is held at 0.
  [[nodiscard]] VertexIndex system(int system, Graph& graph);

  [[nodiscard]] LastingErrors& multipath() { return multipath_; }
  [[nodiscard]] LastingErrors& slow() { return slow_; }

 private:
  void absorb_steps(Stamp stamp, double offset_m);

  Parameters parameters_;
  StateAlongDrive<VertexGnssHeight, EdgeGnssHeightWalk> height_;
  KeptVertex clock_;
  Stamp clock_stamp_;
  double absorbed_m_ = 0;
  std::optional<std::pair<Stamp, double>> last_offset_;  ///< without what is absorbed
  double drift_mps_ = 0;                                 ///< of the offsets
  std::map<int, KeptVertex> systems_;
  LastingErrors multipath_;
  LastingErrors slow_;
};

[[nodiscard]] std::vector<OptionInfo> drive_state_options();
[[nodiscard]] States::Parameters read_states(const CheckedOptions& options);

}  // namespace waymark::plugins::gnss_raw
