#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>

#include <fmt/format.h>

#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/common/accuracy.hpp>
#include <waymark/formats/logs/detail/csv/composed.hpp>
#include <waymark/tools/inspection/log_clock.hpp>
#include <waymark/tools/inspection/proposal/drive_proposal.hpp>

namespace waymark::inspection {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCommentColumn = 44;

/// Returns a scalar that YAML reads back unchanged; plain if that is safe.
std::string scalar(const std::string& text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const bool plain =
      !text.empty() && (letter(text[0]) || text[0] == '/' || text[0] == '.') &&
      std::all_of(
          text.begin(), text.end(),
          [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '/' || c == '.' || c == '-'; }) &&
      text != "null" && text != "Null" && text != "NULL" && text != ".";
  if (plain) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
    else
      quoted += c;
  }
  return quoted + '"';
}

/// Keeps a comment on one line.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return text;
}

/// A quantity refers to the text of its request, so the request is kept.
std::vector<formats::Quantity> quantities_of(StreamKind stream) {
  static const LogRequest kOdometry = [] {
    LogRequest request;
    request.stream = StreamKind::odometry;
    request.readings = formats::odometry_channels();
    return request;
  }();
  if (stream == StreamKind::odometry) return formats::table_quantities(kOdometry);
  LogRequest request;
  request.stream = stream;
  return formats::table_quantities(request);
}

std::vector<std::string> quantity_names(StreamKind stream) {
  std::vector<std::string> names;
  for (const formats::Quantity& quantity : quantities_of(stream)) names.emplace_back(quantity.name);
  return names;
}

class Writer {
 public:
  Writer(const DriveProposal& proposal, const std::vector<LogInspection>& logs, const std::string& path)
      : proposal_(proposal),
        logs_(logs),
        folder_(fs::absolute(path == "-" ? "x" : path).lexically_normal().parent_path()) {}

  std::string text() {
    decide_scale();
    line("# Proposed by `waymark inspect` or `waymark init` from the logs. Look at every '# CHECK';");
    line("# the keys are explained in tools/drive/README.md.");
    line("# name: Somewhere", "default: this file's name");
    line(fmt::format("time: {{scale: {}}}", to_string(scale_)), scale_reason_);
    line("# frame: {utm_zone: 32N}", "default: the zone of the first fix");
    odometry();
    gnss();
    further_odometries();
    truth();
    for (const std::size_t i : proposal_.unused)
      line(fmt::format("# not used: {}", one_line(relative(logs_[i].path))));
    return text_;
  }

 private:
  void line(const std::string& content, const std::string& comment = {}) {
    if (commented_out_) text_ += "# ";
    text_ += content;
    if (!comment.empty()) {
      text_.append(content.size() < kCommentColumn ? kCommentColumn - content.size() : 2, ' ');
      text_ += "# " + one_line(comment);
    }
    text_ += '\n';
  }

  /// Names a file relative to the common folder, or absolutely if that is only the root.
  [[nodiscard]] std::string relative(const std::string& file) const {
    const fs::path path = fs::absolute(file).lexically_normal();
    const auto first = [](const fs::path& whole) {
      const fs::path below = whole.relative_path();
      return below.empty() ? fs::path() : *below.begin();
    };
    if (first(path) != first(folder_)) return path.string();
    return path.lexically_relative(folder_).string();
  }

  void decide_scale() {
    std::vector<std::size_t> all = proposal_.odometry;
    for (const auto* more : {&proposal_.gnss, &proposal_.velocity, &proposal_.truth})
      all.insert(all.end(), more->begin(), more->end());
    for (const std::size_t i : all) {
      const LogClock& clock = logs_[i].clock;
      if (clock.of_week && !of_week_) of_week_ = i;
      if (clock.dated && !dated_) dated_ = i;
    }
    if (of_week_) {
      scale_ = TimeScale::gps;
      scale_reason_ = (logs_[*of_week_].clock.known ? "" : "CHECK: ") + logs_[*of_week_].clock.reason;
    } else if (dated_) {
      scale_ = TimeScale::utc;
      scale_reason_ = "the logs have dates; those on another scale are converted";
    } else {
      scale_ = TimeScale::unix_time;
      scale_reason_ =
          "CHECK: the stamps have no dates; it is assumed that all logs count "
          "from the same time";
    }
  }

  /// Returns the day on which another log begins; without one, a day that the user sees to be invented.
  [[nodiscard]] std::string likely_day(const LogInspection& log) const {
    for (const LogInspection& other : logs_)
      if (&other != &log && other.clock.dated && other.clock.known && other.span() != nullptr)
        return date_text(other.span()->earliest(), other.clock).substr(0, 10);
    return "2000-01-01";
  }

  /// Writes the clock of the log if it differs from that of the drive.
  void time_of(const LogInspection& log, const std::string& indent) {
    const LogClock& clock = log.clock;
    const std::string check = clock.known ? "" : "CHECK: ";
    if (clock.of_week && dated_) {
      const WeekSecond week = week_second(logs_[*dated_].span()->earliest(), logs_[*dated_].clock);
      line(fmt::format("{}time: {{scale: gps, week: {}}}", indent, week.week),
           fmt::format("{}{}; the week is that of the dated log", check, clock.reason));
    } else if (clock.of_week) {
      line(indent + "# time: {week: 2300}", "fill in the GPS week to get dates");
    } else if (log.table && clock.dated && !clock.known && clock.names_its_own) {
      line(fmt::format("{}time: {{date: {}}}", indent, likely_day(log)),
           "CHECK: the day of the first row; " + clock.reason);
    } else if (log.format == "nmea" && !clock.known) {
      line(indent + "# time: {date: 2000-01-01}", "CHECK: fill in the day of the first fix; " + clock.reason);
    } else if (!clock.dated && dated_) {
      line(indent + "# time: {offset: 0}",
           "CHECK: fill in the offset to the stamps of the other logs: " + clock.reason);
    } else if (clock.dated && !clock.names_its_own) {
      line(fmt::format("{}time: {{scale: {}}}", indent, to_string(clock.scale)), check + clock.reason);
    }
    if (log.logger_ahead_s && std::abs(*log.logger_ahead_s) > 0.001)
      line(fmt::format("{}# time: {{scale: {}, offset: {:.3f}}}", indent, to_string(clock.scale),
                       -*log.logger_ahead_s),
           "converts the logger's clock to GNSS time (median); use it for every log of this logger");
  }

  /// Writes "speed: v_mps" or "yaw_rate: {column: w, unit: deg/s}" with a remark if there is
  /// something to check.
  void column(const std::string& quantity, const ColumnSummary& from, const LogInspection& log,
              StreamKind stream, const std::string& indent) {
    const std::vector<formats::Quantity> all = quantities_of(stream);
    const formats::Quantity* known = formats::find_quantity(all, quantity);
    const ColumnProposal& how = from.proposal;
    const bool own_unit = known == nullptr || how.unit.empty() || how.unit == known->units.front().name;
    const bool own_sense = known == nullptr || how.convention.empty() || known->conventions.empty() ||
                           how.convention == known->conventions.front().name;
    std::string value = scalar(reference_of(from));
    if (!own_unit || !own_sense || how.scale != 1 || how.missing) {
      value = "{column: " + value;
      if (!own_unit) value += ", unit: " + scalar(how.unit);
      if (!own_sense) value += ", convention: " + how.convention;
      if (how.scale != 1) value += fmt::format(", scale: {:g}", how.scale);
      if (how.missing) value += fmt::format(", missing: {:g}", *how.missing);
      value += "}";
    }
    line(indent + quantity + ": " + value, checks_of(quantity, from, log, known));
  }

  static std::string checks_of(const std::string& quantity, const ColumnSummary& from,
                               const LogInspection& log, const formats::Quantity* known) {
    std::string text;
    const auto add = [&text](const std::string& what) { text += (text.empty() ? "CHECK: " : "; ") + what; };
    if (!from.proposal.remark.empty()) add(from.proposal.remark);
    const bool has_unit = known != nullptr && known->units.size() > 1;
    const bool position = quantity == "latitude" || quantity == "longitude" || quantity.starts_with("ecef_");
    if (has_unit && from.proposal.scale == 1 && !position && !from.proposal.unit_known &&
        from.proposal.unit.empty() && quantity != "time" && quantity != "quality" && quantity != "date")
      add(fmt::format("no unit is named; {} is assumed", known->units.front().name));
    const std::vector<ColumnSummary>& all = log.table ? log.table->columns : log.can->signals;
    for (const ColumnSummary& other : all) {
      if (other.proposal.remark ==
          fmt::format("also a candidate for {}; '{}' is used", from.proposal.quantity, from.name))
        add(fmt::format("'{}' is also a candidate for {}", other.name, quantity));
    }
    return text;
  }

  /// Writes file, format, companions, columns and time.
  /// @param only quantities to write besides time; empty: all
  void log_lines(const LogInspection& log, StreamKind stream, const std::string& indent, bool first_of_list,
                 const std::vector<std::string>& only = {}) {
    const std::string begin = first_of_list ? indent.substr(2) + "- " : indent;
    line(begin + "file: " + scalar(relative(log.path)));
    line(indent + "format: " + log.format, log.table ? std::string() : log.evidence);
    for (const auto& [key, paths] : log.companions) {
      std::string files;
      for (const std::string& path : paths) files += (files.empty() ? "" : ", ") + scalar(relative(path));
      line(indent + key + ": " + (paths.size() == 1 ? files : "[" + files + "]"));
    }
    if (log.table && log.table->separator != ',')
      line(fmt::format("{}separator: {}", indent,
                       log.table->separator == ';'    ? "semicolon"
                       : log.table->separator == '\t' ? "tab"
                                                      : "blank"));
    if (const ColumnSummary* column = receiver_column(log)) {
      line(fmt::format("{}where: {}", indent,
                       scalar(fmt::format("{} == {}", column->name, column->receivers.front()))),
           fmt::format("CHECK: the rows of one receiver; column '{}' also has {}", column->name,
                       joined(std::span(column->receivers).subspan(1))));
    }
    if (log.table || log.can) {
      line(indent + "columns:");
      const auto columns = proposed_columns(log, stream);
      for (const std::string& quantity : quantity_names(stream)) {  // in their own order
        const auto from = columns.find(quantity);
        const bool wanted = only.empty() || quantity == "time" || quantity == "date" ||
                            quantity == "time_fraction" ||
                            std::find(only.begin(), only.end(), quantity) != only.end();
        if (from != columns.end() && wanted) column(quantity, *from->second, log, stream, indent + "  ");
      }
    }
    time_of(log, indent);
  }

  void odometry() {
    line("\nodometry:");
    if (proposal_.odometry.empty()) {
      line("  file: FILL_IN_odometry.csv", "CHECK: no log with speed and yaw rate was found");
      line("  # columns: {time: time_s, speed: speed_mps, yaw_rate: yaw_rate_radps}");
      return;
    }
    if (proposal_.in_parts) line("  parts:");
    for (std::size_t i = 0; i < proposal_.odometry.size(); ++i)
      log_lines(logs_[proposal_.odometry[i]], StreamKind::odometry, proposal_.in_parts ? "      " : "  ",
                proposal_.in_parts, proposal_.channels[i]);
    if (!proposal_.has_yaw_rate && proposal_.has_speed) course_of_receiver();
    if (!proposal_.has_speed || !proposal_.has_yaw_rate)
      line("    # - file: FILL_IN.csv", fmt::format("CHECK: no log with a {} was found; a drive needs one",
                                                    proposal_.has_speed ? "yaw rate" : "speed"));
    vehicle();
    line("  # speed_delay: 0", "`waymark sync` estimates it, and yaw_rate_delay");
  }

  /// Writes the course of a receiver in comments, as the last source of turns there is.
  void course_of_receiver() {
    for (const std::size_t i : proposal_.gnss) {
      const auto columns = proposed_columns(logs_[i], StreamKind::gnss);
      const auto course = columns.find("course");
      if (!logs_[i].table || course == columns.end()) continue;
      const std::string& unit = course->second->proposal.unit;
      line(
          "    # the last resort is the receiver's course: it is known only while driving, and errs with the fixes");
      line(fmt::format(
          "    # - {{file: {}, columns: {{time: {}, course: {{column: {}, unit: {}, convention: cw_from_north}}}}}}",
          scalar(relative(logs_[i].path)), scalar(reference_of(*columns.at("time"))),
          scalar(reference_of(*course->second)), unit.empty() ? "deg" : unit));
      return;
    }
  }

  /// Writes further sources in comments: only the user knows whether a log is another sensor or a copy.
  void further_odometries() {
    if (proposal_.further.empty()) return;
    line("");
    commented_out_ = true;
    line("sources:", "CHECK: uncomment what is another sensor, and no copy of the odometry above");
    for (std::size_t i = 0; i < proposal_.further.size(); ++i) {
      const LogInspection& log = logs_[proposal_.further[i]];
      line("  " + source_name(log.path) + ":");
      line("    kind: odometry");
      log_lines(log, StreamKind::odometry, "    ", false, proposal_.further_channels[i]);
    }
    commented_out_ = false;
  }

  /// Returns the name of a file as the name of a source.
  static std::string source_name(const std::string& path) {
    std::string name = fs::path(path).stem().string();
    for (char& c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
    return name;
  }

  /// Writes the vehicle parameters that odometry from parts needs.
  void vehicle() {
    const auto taken = [&](std::string_view begin) {
      for (const auto& names : proposal_.channels)
        for (const std::string& name : names)
          if (name.starts_with(begin)) return true;
      return false;
    };
    const bool yaw = taken("yaw_rate");
    if (!yaw && taken("gyro")) {
      if (taken("acceleration")) {
        line("  gyro: {axis: gravity}", "CHECK: the axis that points up is found from the accelerometer");
      } else {
        line(fmt::format("  gyro: {{axis: {}}}", turning_axis()),
             "CHECK: the axis with the largest rates; with '-' if it points down");
      }
    } else if (!yaw && taken("wheel_")) {
      line("  # vehicle: {track_width: 1.55}", "CHECK: fill in; m between the rear wheels");
    } else if (!yaw && taken("steering")) {
      line("  # vehicle: {wheelbase: 2.7, steering_ratio: 15}", "CHECK: fill in");
    }
    if (taken("wheel_ticks"))
      line("  # vehicle: {metres_per_tick: 0.01}",
           "CHECK: fill in; and tick_range where counters start again");
  }

  [[nodiscard]] std::string turning_axis() const {
    std::string axis = "z";
    double largest = 0;
    for (const std::size_t i : proposal_.odometry) {
      if (!logs_[i].odometry) continue;
      for (const ChannelSummary& channel : logs_[i].odometry->channels) {
        if (!channel.name.starts_with("gyro_") || channel.percent95 <= largest) continue;
        largest = channel.percent95;
        axis = channel.name.substr(5);
      }
    }
    return axis;
  }

  void gnss() {
    line("\ngnss:");
    if (proposal_.gnss.empty()) {
      line("  file: FILL_IN_gnss.nmea", "CHECK: no log with positions was found");
      line("  format: auto");
      return;
    }
    const bool several = proposal_.gnss.size() > 1;
    const std::string indent = several ? "    " : "  ";
    for (std::size_t i = 0; i < proposal_.gnss.size(); ++i) {
      const LogInspection& log = logs_[proposal_.gnss[i]];
      log_lines(log, StreamKind::gnss, indent, several);
      accuracy(log, indent);
      if (i == 0 && !proposal_.velocity.empty()) {
        line(indent + "velocity:");
        log_lines(logs_[proposal_.velocity[0]], StreamKind::gnss, indent + "  ", false,
                  {"speed", "speed_accuracy", "course", "course_accuracy"});
      }
      line(indent + "# antenna: [0, 0]", "fill in: m forward and left of the rear axle");
      const double interval = log.fixes->stamps.median_interval_s();
      if (interval < 0.7)
        line(indent + "# period: 1", fmt::format("keeps one fix a second of {:.3g}", 1 / interval));
      if (proposal_.truth.empty()) line(indent + "# withhold_every: 10", "keeps fixes out, for evaluation");
    }
  }

  /// Returns the note of the reader about the assumed meaning of the accuracy.
  static std::string assumed_meaning(const LogInspection& log) {
    for (const std::string& note : log.notes) {
      const std::size_t end = note.find(" (not stated)");
      const std::size_t begin = end == std::string::npos ? end : note.rfind(' ', end - 1);
      if (begin == std::string::npos) continue;
      const std::string word = note.substr(begin + 1, end - begin - 1);
      if (word == "95" || word == "drms" || word == "1sigma" || word == "cep50") return word;
    }
    return {};
  }

  void accuracy(const LogInspection& log, const std::string& indent) {
    const FixSummary& fixes = *log.fixes;
    const AccuracyMeaning named = named_meaning(proposed_columns(log, StreamKind::gnss));
    const bool is_named = named != AccuracyMeaning::automatic;
    const std::string meaning = is_named ? std::string(formats::to_string(named)) : assumed_meaning(log);
    const std::size_t usual = fixes_with_usual_sigma(fixes);
    const std::size_t lacking = fixes.fixes - fixes.with_accuracy - usual;
    if (usual > 0)
      line(indent + "# accuracy: {by_quality: {fixed: 0.02, single: 3}}",
           fmt::format("CHECK: {} of {} fixes have no accuracy, so their quality stands in: {}", usual,
                       fixes.fixes, usual_sigmas(fixes)));
    if (meaning.empty() && lacking == 0) return;
    line(indent + "accuracy:");
    if (!meaning.empty())
      line(fmt::format("{}  meaning: {}", indent, meaning),
           is_named ? "" : "CHECK: assumed; 95, 1sigma, drms or cep50");
    if (lacking > 0)
      line(indent + "  default_sigma: 5",
           fmt::format("CHECK: m per axis, invented: {} of {} fixes have no accuracy", lacking, fixes.fixes));
    if (lacking > 0 && log.format == "nmea")
      line(indent + "  # range_error: 5", "m, for sigma = HDOP times this, if the log has HDOP");
  }

  void truth() {
    if (proposal_.truth.empty()) return;
    line("\ntruth:");
    log_lines(logs_[proposal_.truth[0]], StreamKind::truth, "  ", false);
    line("  # reference: [0, 0]", "fill in: m forward and left of the rear axle");
  }

  const DriveProposal& proposal_;
  const std::vector<LogInspection>& logs_;
  fs::path folder_;
  std::string text_;
  bool commented_out_ = false;
  TimeScale scale_ = TimeScale::gps;
  std::string scale_reason_;
  std::optional<std::size_t> of_week_, dated_;
};

}  // namespace

std::string drive_yaml(const DriveProposal& proposal, const std::vector<LogInspection>& logs,
                       const std::string& path) {
  return Writer(proposal, logs, path).text();
}

}  // namespace waymark::inspection
