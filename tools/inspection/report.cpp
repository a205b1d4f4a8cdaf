#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/formats/logs/fix_quality.hpp>
#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::inspection {
namespace {

constexpr std::size_t kMostRows = 40;  // of ids and message kinds; further ones are summed up

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000) return fmt::format("{} bytes", bytes);
  const double size = static_cast<double>(bytes);
  return size < 1e6 ? fmt::format("{:.1f} kB", size / 1e3) : fmt::format("{:.1f} MB", size / 1e6);
}

/// Prints Hz from 1 Hz on, and else the interval in seconds.
std::string rate_text(double hz) {
  if (!(hz > 0) || !std::isfinite(hz)) return "-";
  return hz >= 0.995 ? fmt::format("{:.4g} Hz", hz) : fmt::format("every {:.3g} s", 1 / hz);
}

double rate_of(const StampSeries& stamps) {
  return 1 / stamps.median_interval_s();
}

/// Names and comments come from the log, so characters that control a terminal are replaced.
std::string harmless(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      '?');
  return text;
}

class Text {
 public:
  Text(std::string title, const text::TextLook& look) : look_(look) {
    text_ = text::painted(harmless(std::move(title)), text::Tone::heading, look) + "\n";
    if (look_.columns > kTableIndent) look_.columns -= kTableIndent;
  }
  void line(const std::string& label, const std::string& value) {
    text_ += fmt::format("  {:<14} {}\n", harmless(label), harmless(value));
  }
  void table(const text::Table& table) {
    text_ += text::indented(text::table_text(table, look_), kTableIndent);
  }
  /// Prints one sentence per line.
  void list(const std::string& label, const std::vector<std::string>& sentences) {
    for (std::size_t i = 0; i < sentences.size(); ++i) line(i == 0 ? label : "", sentences[i]);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kTableIndent = 4;
  std::string text_;
  text::TextLook look_;  ///< look of the tables
};

std::string percent(std::size_t part, std::size_t all) {
  return fmt::format("{:.0f} %",
                     all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all));
}

void add_gaps(Text& text, const StampSeries& stamps, const LogClock& clock) {
  const std::size_t gaps = stamps.gaps();
  if (gaps == 0) {
    text.line("  gaps", "none above 2.5 usual intervals");
    return;
  }
  text.line("  gaps", fmt::format("{} above 2.5 usual intervals, the longest:", gaps));
  for (const LongInterval& gap : stamps.longest_gaps())
    text.line("", fmt::format("{:.3f} s after {}", gap.seconds, date_text(gap.begin, clock)));
}

void add_quality(Text& text, const FixSummary& fixes) {
  text.line("  quality", formats::quality_counts(fixes.qualities));
  std::string told;
  const auto add = [&](const char* name, const Range& range, const char* unit) {
    if (range.count == 0) return;
    told += fmt::format("{}{} {:.3g} .. {:.3g}{}", told.empty() ? "" : ", ", name, range.smallest,
                        range.largest, unit);
  };
  add("satellites", fixes.satellites, "");
  add("HDOP", fixes.hdop, "");
  add("age of corrections", fixes.correction_age_s, " s");
  if (!told.empty()) text.line("", told);
}

void add_accuracy(Text& text, const FixSummary& fixes) {
  const std::size_t lacking = fixes.fixes - fixes.with_accuracy;
  std::string title = "  accuracy";
  const auto line = [&](const std::string& what) {
    text.line(title, what);
    title.clear();
  };
  const std::size_t usual = fixes_with_usual_sigma(fixes);
  if (lacking > usual)
    line(
        lacking - usual == fixes.fixes
            ? "the log has none: state 'accuracy: {default_sigma: ...}' (or, with HDOP, a 'range_error') to use it as gnss"
            : fmt::format("{} of {} fixes have none: state 'accuracy: {{default_sigma: ...}}' for them",
                          lacking - usual, fixes.fixes));
  if (usual > 0)
    line(fmt::format("{} of {} fixes have none, their quality stands in: {}", usual, fixes.fixes,
                     usual_sigmas(fixes)));
  if (fixes.with_accuracy == 0) return;
  const auto axis = [](const char* name, const SigmaSummary& sigma) {
    return fmt::format("sigma {}: median {:.3g} m, 95 % below {:.3g} m, {:.3g} .. {:.3g} m", name,
                       sigma.median, sigma.percent95, sigma.range.smallest, sigma.range.largest);
  };
  line(axis("east", fixes.east));
  line(axis("north", fixes.north));
}

void add_fixes(Text& text, const LogInspection& log) {
  const FixSummary& fixes = *log.fixes;
  if (fixes.fixes == 0) {
    if (log.records == 0) return text.line("gnss", "no position in the log");
    text.line("gnss",
              fmt::format("no fix in {} records ({} marked as without a fix)", log.records, log.without_fix));
    return;
  }
  text.line("gnss", fmt::format("{} fixes, {}; {} records without a fix", fixes.fixes,
                                rate_text(rate_of(fixes.stamps)), log.without_fix));
  add_gaps(text, fixes.stamps, log.clock);
  const BoundingBox& box = fixes.box;
  if (box.latitude.count > 0)
    text.line("  area",
              fmt::format("latitude {:.7g} .. {:.7g}, longitude {:.7g} .. {:.7g} deg: {:.0f} m to the "
                          "north, {:.0f} m to the east",
                          box.latitude.smallest, box.latitude.largest, box.longitude.smallest,
                          box.longitude.largest, box.height_m(), box.width_m()));
  text.line("  way", fmt::format("{:.0f} m from fix to fix, noise included", fixes.distance_m));
  text.line("  height", fixes.height.count == 0
                            ? "none"
                            : fmt::format("{:.1f} .. {:.1f} m", fixes.height.smallest, fixes.height.largest));
  add_quality(text, fixes);
  add_accuracy(text, fixes);
  text.line("  velocity",
            fmt::format("speed in {} of the fixes{}, course in {}", percent(fixes.with_speed, fixes.fixes),
                        fixes.with_speed == 0 ? "" : fmt::format(" (up to {:.1f} m/s)", fixes.speed.largest),
                        percent(fixes.with_course, fixes.fixes)));
}

void add_odometry(Text& text, const LogInspection& log) {
  const OdometrySummary& odometry = *log.odometry;
  text.line("odometry", fmt::format("{} rows", odometry.stamps.count()));
  text::Table table{
      .columns = {"channel", "values", "rate", "unit", "smallest", "largest", "gaps", "longest gap [s]"}};
  for (const ChannelSummary& channel : odometry.channels) {
    const auto gaps = channel.stamps.longest_gaps();
    table.rows.push_back({harmless(channel.name), std::to_string(channel.range.count),
                          rate_text(rate_of(channel.stamps)), harmless(channel.unit),
                          fmt::format("{:.5g}", channel.range.smallest),
                          fmt::format("{:.5g}", channel.range.largest), std::to_string(channel.stamps.gaps()),
                          gaps.empty() ? "-" : fmt::format("{:.3g}", gaps[0].seconds)});
  }
  text.table(table);
}

/// Returns "speed, km/h", "yaw_rate (CHECK: ...)".
std::string proposal_text(const ColumnProposal& proposal) {
  if (proposal.quantity.empty()) return proposal.remark.empty() ? "-" : "- (" + proposal.remark + ")";
  std::string text = proposal.quantity;
  if (!proposal.unit.empty()) text += ", " + proposal.unit;
  if (!proposal.convention.empty()) text += ", " + proposal.convention;
  if (proposal.scale != 1) text += fmt::format(", times {:g}", proposal.scale);
  if (!proposal.remark.empty()) text += " (check: " + proposal.remark + ")";
  return text;
}

void add_columns(Text& text, const std::vector<ColumnSummary>& columns, bool of_bus) {
  text::Table table{.columns = {of_bus ? "signal" : "column", "values", of_bus ? "rate" : "empty", "smallest",
                                "largest", "unit", "proposed as"}};
  for (const ColumnSummary& column : columns) {
    const Range& range = column.range;
    const auto bound = [&](double value) { return range.count == 0 ? "-" : fmt::format("{:.10g}", value); };
    std::string proposal = proposal_text(column.proposal);
    if (range.count == 0 && column.words > 0) proposal += " (words)";
    if (!of_bus && column.rate_hz > 0 && !column.proposal.quantity.empty())
      proposal += ", " + rate_text(column.rate_hz);
    table.rows.push_back({harmless(column.name), std::to_string(column.values),
                          of_bus ? rate_text(column.rate_hz) : std::to_string(column.empty),
                          bound(range.smallest), bound(range.largest), harmless(column.unit),
                          harmless(proposal)});
  }
  text.table(table);
}

void add_ids(Text& text, const LogInspection& log) {
  text.line("frames", fmt::format("{} on {}", log.can->frames, log.can->interfaces));
  if (!log.companions.contains("dbc"))
    text.line("", "only messages of OBD-II and J1939 are known without a DBC (--dbc FILE)");
  text::Table table{.columns = {"id", "frames", "rate", "length"}};
  std::size_t rest = 0;
  for (std::size_t i = 0; i < log.can->ids.size(); ++i) {
    const ColumnSummary& id = log.can->ids[i];
    if (i < kMostRows)
      table.rows.push_back({harmless(id.name), std::to_string(id.values), rate_text(id.rate_hz), id.detail});
    else
      rest += id.values;
  }
  if (rest > 0)
    table.rows.push_back({fmt::format("{} more ids", log.can->ids.size() - kMostRows), std::to_string(rest)});
  text.table(table);
  if (log.can->signals.empty()) return;
  add_columns(text, log.can->signals, true);
}

void add_kinds(Text& text, const LogInspection& log) {
  if (log.kinds.empty() || log.can) return;
  const double seconds = log.span() == nullptr ? 0 : log.span()->span_s();
  text::Table table{.columns = {"message", "count", "rate"}};
  std::size_t rows = 0;
  for (const auto& [kind, count] : log.kinds) {
    if (++rows > kMostRows) continue;
    table.rows.push_back({harmless(kind), std::to_string(count),
                          seconds > 0 ? rate_text(static_cast<double>(count) / seconds) : "-"});
  }
  if (rows > kMostRows) table.rows.push_back({fmt::format("{} more kinds", rows - kMostRows)});
  text.line("messages", fmt::format("{} kind{}", log.kinds.size(), log.kinds.size() == 1 ? "" : "s"));
  text.table(table);
}

void add_raw(Text& text, const RawSummary& raw) {
  text.line("epochs", fmt::format("{} at {}, with {} to {} satellites", raw.stamps.count(),
                                  rate_text(rate_of(raw.stamps)), raw.fewest, raw.most));
  text.line("systems", raw.systems());
  text::Table table{.columns = {"satellite", "pseudoranges", "Doppler shifts", "mean C/N0 [dB-Hz]"}};
  if (raw.holds_ephemerides) table.columns.emplace_back("ephemerides");
  for (const auto& [name, satellite] : raw.satellites) {
    table.rows.push_back({name, std::to_string(satellite.pseudoranges), std::to_string(satellite.dopplers),
                          satellite.with_cn0 == 0 ? "-" : fmt::format("{:.1f}", satellite.mean_cn0_dbhz())});
    if (raw.holds_ephemerides) table.rows.back().push_back(std::to_string(satellite.ephemerides));
  }
  text.table(table);
}

}  // namespace

std::string inspection_text(const LogInspection& log, const text::TextLook& look) {
  Text text(log.path, look);
  text.line("size", size_text(log.size));
  text.line("format", log.format + (log.evidence.empty() ? " (stated)" : ": " + log.evidence));
  for (const auto& [key, paths] : log.companions)
    for (const std::string& path : paths) text.line(key, path);
  if (const StampSeries* span = log.span())
    text.line("span", fmt::format("{} .. {}, {:.3f} s", date_text(span->earliest(), log.clock),
                                  date_text(span->latest(), log.clock), span->span_s()));
  text.line("clock", fmt::format("{}: {}",
                                 log.clock.of_week ? "gps, seconds of a week"
                                                   : std::string(to_string(log.clock.scale)),
                                 log.clock.reason));
  if (log.table) {
    text.line("table", fmt::format("{} rows, {} columns", log.table->rows, log.table->columns.size()));
    if (!log.table->first_line.empty()) text.line("comment", log.table->first_line.substr(0, 300));
    add_columns(text, log.table->columns, false);
  }
  if (log.can) add_ids(text, log);
  add_kinds(text, log);
  if (log.fixes) add_fixes(text, log);
  if (log.odometry) add_odometry(text, log);
  if (log.raw) add_raw(text, *log.raw);
  if (!log.fixes && !log.odometry && !log.can && !log.raw)
    text.line("streams", "neither fixes nor odometry were found");
  if (log.corrupt > 0) {
    text.line("corrupt", fmt::format("{} of {} records, the first:", log.corrupt, log.records));
    text.list("", log.corrupt_examples);
  }
  text.list("trouble", log.troubles);
  std::vector<std::string> notes = log.notes;
  for (std::string& note : notes)
    if (note.starts_with(log.path + ": ")) note.erase(0, log.path.size() + 2);
  text.list("notes", notes);
  text.list("suspicious", log.suspicions.empty() ? std::vector<std::string>{"nothing"} : log.suspicions);
  return text.text();
}

}  // namespace waymark::inspection
