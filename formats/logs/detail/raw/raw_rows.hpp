/// Raw measurements of a receiver as rows of a sensor stream.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/satellites/correction.hpp>

namespace waymark::formats {

/// Turns epochs of raw measurements into rows with the columns of the plugin gnss_raw: one row for each satellite of an
/// epoch. A column of another name is NaN.
///
/// Epochs before the first one with a position wait for it. Without a navigation file the ephemerides come with the
/// measurements: then the epochs of the first minute wait too.
class RawRows {
 public:
  /// Reads the companions "navigation" of the request.
  /// @param request and data outlive this object; data gets rows, counts and notes
  /// @throws InputError for navigation files that cannot be read, and for an offset of more than 1e9 s
  RawRows(std::string path, const LogRequest& request, LogData& data);

  [[nodiscard]] bool has_navigation_files() const { return !files_.empty(); }
  [[nodiscard]] satellites::Ephemerides& ephemerides() { return ephemerides_; }
  /// Where the receiver is until an epoch tells it, ECEF, m.
  void state_place(const Eigen::Vector3d& place) {
    if (!place_) place_ = place;
  }
  void take(const satellites::RawEpoch& epoch);
  /// Adds the rows that were held back, and the notes.
  /// @throws InputError if there are measurements, and none has an ephemeris or none a position
  void finish();

 private:
  struct Waiting {
    Stamp moment;
    std::vector<satellites::PlacedMeasurement> measurements;
  };

  void take_early();
  void place(satellites::RawEpoch epoch);
  void find_cycle(const satellites::RawEpoch& epoch);
  void locate(const std::vector<satellites::PlacedMeasurement>& measurements);
  void give(const Waiting& epoch);
  void add_row(Stamp moment, const satellites::CorrectedMeasurement& measurement);
  void require_ephemerides() const;
  void add_notes();
  void note(const std::string& text) { data_.notes.push_back(path_ + ": " + text); }

  std::string path_;
  const LogRequest& request_;
  LogData& data_;
  satellites::Ephemerides ephemerides_;
  std::string files_;                       ///< navigation files, for messages
  bool is_early_ = false;                   ///< ephemerides are awaited
  std::deque<satellites::RawEpoch> early_;  ///< epochs that wait for them
  std::optional<std::int64_t> cycles_;      ///< of 1024 weeks that are added
  std::optional<Eigen::Vector3d> place_;
  std::deque<Waiting> waiting_;
  std::map<satellites::SatelliteName, std::size_t> without_ephemeris_;
  std::optional<Stamp> first_, last_;
  std::size_t placed_ = 0, low_ = 0, given_up_ = 0, given_ = 0;
};

}  // namespace waymark::formats
