#include <cmath>

#include <waymark/tools/inspection/inspection.hpp>
#include <waymark/tools/text/json_number.hpp>

namespace waymark::inspection {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Range& range) {
  if (range.count == 0) return nullptr;
  return {{"smallest", range.smallest}, {"largest", range.largest}};
}

Json json_of(const StampSeries& stamps, const LogClock& clock) {
  Json json{{"count", stamps.count()},
            {"begin", date_text(stamps.earliest(), clock)},
            {"end", date_text(stamps.latest(), clock)},
            {"begin_s", stamps.earliest().seconds()},
            {"span_s", stamps.span_s()},
            {"median_interval_s", text::number_or_null(stamps.median_interval_s())},
            {"gaps", stamps.gaps()}};
  json["longest_gaps"] = Json::array();
  for (const LongInterval& gap : stamps.longest_gaps())
    json["longest_gaps"].push_back({{"after", date_text(gap.begin, clock)}, {"seconds", gap.seconds}});
  json["backwards"] = stamps.backwards().count;
  json["duplicates"] = stamps.duplicates().count;
  json["jumps"] = stamps.jumps().count;
  return json;
}

Json json_of(const SigmaSummary& sigma) {
  return {{"median_m", text::number_or_null(sigma.median)},
          {"percent95_m", text::number_or_null(sigma.percent95)},
          {"smallest_m", sigma.range.smallest},
          {"largest_m", sigma.range.largest}};
}

Json json_of(const FixSummary& fixes, const LogClock& clock) {
  Json json{{"fixes", fixes.fixes}};
  if (fixes.fixes == 0) return json;
  json["stamps"] = json_of(fixes.stamps, clock);
  json["latitude_deg"] = json_of(fixes.box.latitude);
  json["longitude_deg"] = json_of(fixes.box.longitude);
  json["north_m"] = fixes.box.height_m();
  json["east_m"] = fixes.box.width_m();
  json["height_m"] = json_of(fixes.height);
  json["distance_m"] = fixes.distance_m;
  for (const auto& [quality, count] : fixes.qualities)
    json["qualities"][std::string(to_string(quality))] = count;
  json["satellites"] = json_of(fixes.satellites);
  json["hdop"] = json_of(fixes.hdop);
  json["correction_age_s"] = json_of(fixes.correction_age_s);
  json["with_accuracy"] = fixes.with_accuracy;
  if (fixes.with_accuracy > 0) {
    json["sigma_east"] = json_of(fixes.east);
    json["sigma_north"] = json_of(fixes.north);
  }
  json["with_speed"] = fixes.with_speed;
  json["with_course"] = fixes.with_course;
  json["speed_factor"] = text::number_or_null(fixes.speed_factor);
  json["zero_positions"] = fixes.zero.count;
  json["far_positions"] = fixes.far.count;
  json["frozen"] = fixes.frozen.count;
  json["frozen_moving"] = fixes.frozen_moving.count;
  json["resolution_m"] = fixes.resolution_m;
  return json;
}

Json json_of(const OdometrySummary& odometry, const LogClock& clock) {
  Json json{{"stamps", json_of(odometry.stamps, clock)}};
  json["channels"] = Json::array();
  for (const ChannelSummary& channel : odometry.channels)
    json["channels"].push_back({{"name", channel.name},
                                {"unit", channel.unit},
                                {"range", json_of(channel.range)},
                                {"percent95", text::number_or_null(channel.percent95)},
                                {"stamps", json_of(channel.stamps, clock)}});
  return json;
}

Json json_of(const std::vector<ColumnSummary>& columns) {
  Json json = Json::array();
  for (const ColumnSummary& column : columns) {
    const ColumnProposal& proposal = column.proposal;
    Json entry{
        {"name", column.name}, {"values", column.values}, {"empty", column.empty}, {"words", column.words}};
    entry["range"] = json_of(column.range);
    entry["rate_hz"] = column.rate_hz > 0 ? text::number_or_null(column.rate_hz) : Json(nullptr);
    if (!column.unit.empty()) entry["unit"] = column.unit;
    if (!column.detail.empty()) entry["length"] = column.detail;
    entry["proposed"] = nullptr;
    if (!proposal.quantity.empty())
      entry["proposed"] = {{"quantity", proposal.quantity},
                           {"unit", proposal.unit},
                           {"convention", proposal.convention},
                           {"check", proposal.remark}};
    json.push_back(std::move(entry));
  }
  return json;
}

Json json_of(const RawSummary& raw) {
  Json json{{"epochs", raw.stamps.count()},
            {"interval_s", text::number_or_null(raw.stamps.median_interval_s())},
            {"satellites", Json::object()}};
  for (const auto& [name, satellite] : raw.satellites)
    json["satellites"][name] = {{"pseudoranges", satellite.pseudoranges},
                                {"dopplers", satellite.dopplers},
                                {"mean_cn0_dbhz", text::number_or_null(satellite.mean_cn0_dbhz())},
                                {"ephemerides", satellite.ephemerides}};
  return json;
}

}  // namespace

Json inspection_json(const LogInspection& log) {
  Json json{{"file", log.path},         {"bytes", log.size},      {"format", log.format},
            {"evidence", log.evidence}, {"records", log.records}, {"without_fix", log.without_fix},
            {"corrupt", log.corrupt}};
  json["corrupt_examples"] = log.corrupt_examples;
  json["kinds"] = log.kinds;
  json["clock"] = {{"scale", to_string(log.clock.scale)},
                   {"dated", log.clock.dated},
                   {"of_week", log.clock.of_week},
                   {"known", log.clock.known},
                   {"reason", log.clock.reason}};
  json["table"] = log.table ? json_of(log.table->columns) : Json(nullptr);
  json["ids"] = log.can ? json_of(log.can->ids) : Json(nullptr);
  json["signals"] = log.can ? json_of(log.can->signals) : Json(nullptr);
  json["gnss"] = log.fixes ? json_of(*log.fixes, log.clock) : Json(nullptr);
  json["odometry"] = log.odometry ? json_of(*log.odometry, log.clock) : Json(nullptr);
  json["raw"] = log.raw ? json_of(*log.raw) : Json(nullptr);
  json["logger_ahead_s"] = log.logger_ahead_s ? text::number_or_null(*log.logger_ahead_s) : Json(nullptr);
  json["troubles"] = log.troubles;
  json["notes"] = log.notes;
  json["suspicious"] = log.suspicions;
  return json;
}

}  // namespace waymark::inspection
