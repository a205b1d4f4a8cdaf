/// The epochs of RINEX observation files of versions 2 and 3, from their lines.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/logs/detail/rinex/rinex_fields.hpp>
#include <waymark/formats/satellites/correction.hpp>

namespace waymark::formats {

/// The places of what is read among the observations of a system: pseudorange, Doppler shift and C/N0 of its first
/// frequency. Empty: not observed.
struct RinexColumns {
  std::optional<std::size_t> pseudorange, doppler, cn0;
};

/// Reads lines and gives epochs. Epochs with event flags 2 to 6 are no measurements: their lines are skipped, but a header
/// line among them that changes the observations is obeyed.
class RinexObservations {
 public:
  struct Listener {
    std::function<void(const satellites::RawEpoch&)> epoch;
    /// an epoch that cannot be used: line, column (1-based), what
    std::function<void(std::size_t, std::size_t, const std::string&)> corrupt;
  };

  RinexObservations(std::string path, Listener listener)
      : path_(std::move(path)), listener_(std::move(listener)) {}

  /// @param number 1-based
  /// @throws InputError "rover.obs:1: ..." for a file that is no observation file, or of another version
  void take_line(std::string_view line, std::size_t number);
  /// @throws InputError if the file ended in its header
  void finish();

  /// Where the header says that the receiver is, ECEF, m; empty if it does not, or says 0.
  [[nodiscard]] const std::optional<Eigen::Vector3d>& stated_place() const { return stated_place_; }
  /// Satellites of systems that are not used, and lines without a pseudorange.
  [[nodiscard]] std::size_t unused() const { return unused_; }
  /// Event records that were skipped.
  [[nodiscard]] std::size_t events() const { return events_; }

 private:
  enum class Part { first_line, header, between, names, satellites, event };

  [[noreturn]] void fail(const std::string& what) const;
  void complain(std::size_t column, const std::string& what);
  void take_first_line();
  void take_header_line();
  void take_types_2();
  void take_types_3();
  void choose_columns();
  void take_epoch_line();
  void begin_epoch(int flag, int count, const std::optional<Stamp>& stamp);
  void take_names();
  /// Tells whether the line among those of satellites is the first of the next epoch.
  [[nodiscard]] bool begins_epoch() const;
  void take_satellite_line();
  void take_measurement(std::string_view line);
  void end_satellite();
  void lose_epoch(const std::string& what);
  [[nodiscard]] std::optional<Stamp> on_gps(const RinexDate& date) const;
  [[nodiscard]] std::size_t lines_per_satellite() const;

  std::string path_;
  Listener listener_;
  std::string_view line_;
  std::size_t number_ = 0;
  Part part_ = Part::first_line;
  RinexVersion version_;
  std::string time_system_ = "GPS";
  std::optional<Eigen::Vector3d> stated_place_;

  std::map<char, std::vector<std::string>> types_;  ///< by the letter of a system; ' ': all, as in version 2
  std::map<char, std::size_t> announced_;           ///< how many types the header announces
  std::map<char, RinexColumns> columns_;
  char types_of_ = ' ';

  satellites::RawEpoch epoch_;
  std::size_t epoch_line_ = 0;
  std::size_t expected_ = 0;  ///< satellites, or lines of an event
  std::vector<std::string> names_;
  std::size_t seen_ = 0;
  std::string observations_;  ///< lines of one satellite of version 2, each of 80 columns
  std::size_t lines_ = 0;
  bool counts_ = true;  ///< false: records of cycle slips
  bool is_dated_ = true;
  std::size_t unused_ = 0, events_ = 0;
};

}  // namespace waymark::formats
