#include <waymark/tools/inspection/proposal/drive_proposal.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include <waymark/core/base/suggest.hpp>

namespace waymark::inspection {
namespace {

using Names = std::vector<std::string>;

std::string file_name(const LogInspection& log) {
  const std::filesystem::path path(log.path);
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

bool has_positions(const LogInspection& log) {
  return log.fixes && log.fixes->fixes > 0;
}

std::set<std::string> channels_of(const LogInspection& log) {
  std::set<std::string> channels;
  if (log.table || log.can) {
    for (const auto& [quantity, column] : proposed_columns(log, StreamKind::odometry))
      channels.insert(quantity);
    channels.erase("time");
    channels.erase("time_fraction");
  } else if (log.odometry) {
    for (const ChannelSummary& channel : log.odometry->channels) channels.insert(channel.name);
  }
  return channels;
}

/// Returns why positions are those of a reference; empty: they are those of a receiver.
std::string sign_of_truth(const LogInspection& log) {
  for (const std::string& word : words_of(file_name(log))) {
    if (word == "truth" || word == "reference" || word == "groundtruth" || word == "ref")
      return fmt::format("its name says '{}'", word);
  }
  if (!log.table) return {};
  for (const ColumnSummary& column : log.table->columns) {
    if (column.proposal.convention == "ccw_from_east")
      return fmt::format("column '{}' is a heading counter-clockwise from east, which no receiver writes",
                         column.name);
  }
  return {};
}

/// Tells whether the log holds only the velocity of a receiver.
bool is_velocity(const LogInspection& log) {
  if (!log.table || has_positions(log)) return false;
  const auto columns = proposed_columns(log, StreamKind::gnss);
  return columns.contains("speed") && !channels_of(log).contains("yaw_rate") &&
         (columns.contains("course") || columns.contains("course_accuracy") ||
          columns.contains("speed_accuracy"));
}

bool has_all(const std::set<std::string>& channels, const Names& wanted) {
  return std::all_of(wanted.begin(), wanted.end(),
                     [&](const std::string& name) { return channels.contains(name); });
}

/// Returns the channels from which speed can be computed, the best way first; empty: it cannot
/// be computed.
Names speed_channels(const std::set<std::string>& channels) {
  for (const Names& way : {Names{"speed"}, Names{"wheel_speed_rear_left", "wheel_speed_rear_right"},
                           Names{"wheel_speed_front_left", "wheel_speed_front_right"},
                           Names{"wheel_ticks_rear_left", "wheel_ticks_rear_right"},
                           Names{"wheel_ticks_front_left", "wheel_ticks_front_right"}, Names{"wheel_ticks"},
                           Names{"distance"}, Names{"velocity_east", "velocity_north"}}) {
    if (!has_all(channels, way)) continue;
    Names taken = way;
    if (channels.contains("reverse")) taken.emplace_back("reverse");
    return taken;
  }
  return {};
}

Names yaw_rate_channels(const std::set<std::string>& channels) {
  if (channels.contains("yaw_rate")) return {"yaw_rate"};
  Names taken;
  for (const char* axis : {"gyro_x", "gyro_y", "gyro_z"})
    if (channels.contains(axis)) taken.emplace_back(axis);
  const Names gravity{"acceleration_x", "acceleration_y", "acceleration_z"};
  if (taken.size() == 3 && has_all(channels, gravity))
    taken.insert(taken.end(), gravity.begin(), gravity.end());
  if (!taken.empty()) return taken;
  for (const Names& way : {Names{"wheel_speed_rear_left", "wheel_speed_rear_right"},
                           Names{"wheel_ticks_rear_left", "wheel_ticks_rear_right"}, Names{"steering_angle"},
                           Names{"heading"}}) {
    if (has_all(channels, way)) return way;
  }
  return {};
}

/// Tells whether two logs have the same fixes: one may be extracted from the other.
bool same_fixes(const LogInspection& a, const LogInspection& b) {
  const auto near = [](double x, double y) { return std::abs(x - y) < 2e-6; };
  const BoundingBox& p = a.fixes->box;
  const BoundingBox& q = b.fixes->box;
  return a.fixes->fixes == b.fixes->fixes && near(p.latitude.smallest, q.latitude.smallest) &&
         near(p.latitude.largest, q.latitude.largest) && near(p.longitude.smallest, q.longitude.smallest) &&
         near(p.longitude.largest, q.longitude.largest);
}

/// Why a log without positions or motion is not used; the remark on its metres says what can be stated.
std::string without_channels(const LogInspection& log) {
  std::string reason = "it has no channel that a drive needs";
  if (!log.table) return reason;
  for (const ColumnSummary& column : log.table->columns)
    if (column.proposal.quantity.empty() && column.proposal.remark.starts_with("may be metres"))
      return fmt::format("{}; column '{}' {}", reason, column.name, column.proposal.remark);
  return reason;
}

/// Tells whether a drive could use a log if no other one were there.
bool is_useful(const LogInspection& log) {
  const std::set<std::string> channels = channels_of(log);
  return has_positions(log) || !speed_channels(channels).empty() || !yaw_rate_channels(channels).empty();
}

class Deciding {
 public:
  explicit Deciding(const std::vector<LogInspection>& logs) : logs_(logs), used_(logs.size(), false) {}

  DriveProposal run() {
    decide_positions();
    decide_velocity();
    decide_odometry();
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (used_[i]) continue;
      proposal_.unused.push_back(i);
      if (!told_.contains(i))
        say(i, fmt::format("not used: {}", is_useful(logs_[i]) ? "other logs have the same channels"
                                                               : without_channels(logs_[i])));
    }
    if (proposal_.gnss.empty())
      proposal_.decisions.emplace_back("no log with positions was found: fill in gnss");
    if (proposal_.odometry.empty())
      proposal_.decisions.emplace_back("no log with odometry was found: fill in odometry");
    else if (!proposal_.has_speed)
      proposal_.decisions.emplace_back("no log with a speed was found: add one to the parts of odometry");
    else if (!proposal_.has_yaw_rate)
      proposal_.decisions.emplace_back("no log with a yaw rate was found: add one to the parts of odometry");
    return std::move(proposal_);
  }

 private:
  void say(std::size_t log, const std::string& what) {
    proposal_.decisions.push_back(logs_[log].path + ": " + what);
    told_.insert(log);
  }

  void decide_positions() {
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (!has_positions(logs_[i]) || !sign_of_truth(logs_[i]).empty()) continue;
      const auto known = std::find_if(proposal_.gnss.begin(), proposal_.gnss.end(),
                                      [&](std::size_t other) { return same_fixes(logs_[i], logs_[other]); });
      if (known != proposal_.gnss.end()) {
        say(i, "not used: it holds the same fixes as " + logs_[*known].path);
        continue;
      }
      proposal_.gnss.push_back(i);
      used_[i] = true;
      say(i, fmt::format("gnss: it holds {} fixes", logs_[i].fixes->fixes));
    }
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (!has_positions(logs_[i])) continue;
      const std::string sign = sign_of_truth(logs_[i]);
      if (sign.empty()) continue;
      if (proposal_.gnss.empty()) {
        proposal_.gnss.push_back(i);
        say(i, "gnss, because no other log has positions, although it looks like a reference: " + sign);
      } else if (proposal_.truth.empty()) {
        proposal_.truth.push_back(i);
        say(i, "truth: " + sign);
      } else {
        say(i, "not used: a drive has one truth, " + logs_[proposal_.truth[0]].path);
        continue;
      }
      used_[i] = true;
    }
  }

  void decide_velocity() {
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (used_[i] || !is_velocity(logs_[i])) continue;
      if (proposal_.gnss.empty() || !proposal_.velocity.empty()) continue;
      used_[i] = true;
      const FixSummary& fixes = *logs_[proposal_.gnss[0]].fixes;
      if (fixes.with_speed > 0 && fixes.with_course > 0) {
        say(i, "not used: the log of the positions already has the receiver's speed and course");
        continue;
      }
      proposal_.velocity.push_back(i);
      say(i, "gnss.velocity: a receiver's speed and course, without positions");
    }
  }

  void decide_odometry() {
    for (const bool of_receivers : {false, true}) {
      if (take_whole(of_receivers)) return;
      take_parts(of_receivers);
      if (proposal_.has_speed && proposal_.has_yaw_rate) return;
    }
  }

  [[nodiscard]] bool may_give(std::size_t i, bool of_receivers) const {
    const bool receiver = std::find(proposal_.gnss.begin(), proposal_.gnss.end(), i) != proposal_.gnss.end();
    return of_receivers ? receiver && sign_of_truth(logs_[i]).empty() : !used_[i] && !has_positions(logs_[i]);
  }

  /// Returns the channels of a complete odometry; empty if the log has none.
  [[nodiscard]] Names whole_channels(std::size_t i) const {
    const std::set<std::string> channels = channels_of(logs_[i]);
    Names taken = speed_channels(channels);
    const Names yaw = yaw_rate_channels(channels);
    if (taken.empty() || yaw.empty()) return {};
    for (const std::string& name : yaw)
      if (std::find(taken.begin(), taken.end(), name) == taken.end()) taken.push_back(name);
    return taken;
  }

  bool take_whole(bool of_receivers) {
    if (proposal_.has_speed || proposal_.has_yaw_rate) return false;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (!may_give(i, of_receivers)) continue;
      const Names taken = whole_channels(i);
      if (taken.empty()) continue;
      if (proposal_.has_speed) {
        add_further(i, taken);
        continue;
      }
      add_odometry(i, taken);
      proposal_.has_speed = proposal_.has_yaw_rate = true;
    }
    return proposal_.has_speed;
  }

  void add_further(std::size_t i, const Names& taken) {
    proposal_.further.push_back(i);
    proposal_.further_channels.push_back(taken);
    used_[i] = true;
    say(i, "a further odometry: " + joined(taken) +
               "; below 'sources' in comments, to be used if it is another sensor and no copy");
  }

  void take_parts(bool of_receivers) {
    proposal_.in_parts = true;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      if (!may_give(i, of_receivers)) continue;
      const std::set<std::string> channels = channels_of(logs_[i]);
      const Names speed = proposal_.has_speed ? Names{} : speed_channels(channels);
      const Names yaw = proposal_.has_yaw_rate ? Names{} : yaw_rate_channels(channels);
      if (!speed.empty()) {
        proposal_.has_speed = true;
        add_odometry(i, speed);
      } else if (!yaw.empty()) {
        proposal_.has_yaw_rate = true;
        add_odometry(i, yaw);
      }
    }
  }

  void add_odometry(std::size_t i, const Names& taken) {
    proposal_.odometry.push_back(i);
    proposal_.channels.push_back(taken);
    used_[i] = true;
    Names left;
    for (const std::string& name : channels_of(logs_[i]))
      if (std::find(taken.begin(), taken.end(), name) == taken.end()) left.push_back(name);
    say(i, fmt::format("odometry{}: {}{}", proposal_.in_parts ? " part" : "", joined(taken),
                       left.empty() ? "" : "; not used: " + joined(left)));
  }

  const std::vector<LogInspection>& logs_;
  std::vector<bool> used_;
  std::set<std::size_t> told_;
  DriveProposal proposal_;
};

}  // namespace

DriveProposal propose_drive(const std::vector<LogInspection>& logs) {
  return Deciding(logs).run();
}

}  // namespace waymark::inspection
