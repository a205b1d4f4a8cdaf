#include <waymark/tools/program/jobs/drive/drive_text.hpp>

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

/// Returns the distance by the odometry.
double distance_by(const std::vector<OdometrySample>& odometry) {
  double distance = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    distance += 0.5 * (std::abs(odometry[i].speed_mps) + std::abs(odometry[i - 1].speed_mps)) *
                seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
  }
  return distance;
}

}  // namespace

namespace {

std::string describe_gate(const drive::ModeledDrive& modeled) {
  if (modeled.placed.fixes.empty()) return "";
  const drive::GateSummary& gate = modeled.placed.gate;
  std::string reasons;
  for (const auto& [reason, count] : gate.reasons)
    if (reason != "off") reasons += fmt::format(" {} {}", reason, count);
  if (*modeled.settings.gate.enabled)
    return fmt::format("gate        {} of {} fixes rejected ({:.1f} %):{}\n", gate.rejected,
                       gate.accepted + gate.rejected, gate.rejected_percent(), reasons);
  if (gate.rejected > 0)
    return fmt::format("gate        off: {} of {} fixes are used:{}\n", gate.accepted,
                       gate.accepted + gate.rejected, reasons);
  return fmt::format("gate        off: all {} fixes are used\n", gate.accepted);
}

}  // namespace

text::Table noise_table(const drive::NoiseEstimate& noise) {
  text::Table table{.columns = {"estimated noise", "unit", "value", "68 % between", "and", "known before"}};
  for (const drive::NoiseParameter& p : noise.parameters) {
    const bool linear = p.prior.linear;
    const auto moved = [&](double by) { return linear ? p.value + by : p.value * std::exp(by); };
    table.rows.push_back({p.name(), p.unit, fmt::format("{:.3g}", p.value),
                          fmt::format("{:.3g}", moved(-p.deviation)),
                          fmt::format("{:.3g}", moved(p.deviation)),
                          p.observed() ? fmt::format("{:.3g}", p.prior.mean) : "not observed"});
  }
  return table;
}

std::string describe_model(const drive::ModeledDrive& modeled, const text::TextLook& look) {
  const std::string text = describe_gate(modeled);
  if (modeled.noise.parameters.empty()) return text;
  return text + text::table_text(noise_table(modeled.noise), look);
}

std::string left_out(const drive::PreparedDrive& drive) {
  const drive::PrepareReport& report = drive.report;
  return fmt::format("{} fixes outside the odometry, {} by thinning, {} withheld",
                     report.fixes_outside_odometry, report.fixes_thinned, report.fixes_withheld);
}

std::string odometry_in_words(const drive::PreparedDrive& drive) {
  return fmt::format("{:.0f} m in {} samples", distance_by(drive.odometry), drive.odometry.size());
}

std::string describe_drive(const drive::PreparedDrive& drive) {
  std::string text;
  const auto& odometry = drive.odometry;
  text += fmt::format("drive       {}: {:.0f} s, {:.0f} m by odometry, {} odometry samples, {} fixes\n",
                      drive.name, seconds_between(odometry.front().stamp, odometry.back().stamp),
                      distance_by(odometry), odometry.size(), drive.fixes.size());
  if (!drive.fixes.empty()) text += "left out    " + left_out(drive) + "\n";
  return text;
}

nlohmann::ordered_json noise_json(const drive::NoiseEstimate& noise) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const drive::NoiseParameter& p : noise.parameters) {
    json.push_back({{"source", p.source},
                    {"owner", p.owner},
                    {"option", p.option},
                    {"unit", p.unit},
                    {"value", p.value},
                    {"deviation", p.deviation},
                    {"of", p.prior.linear ? "value" : "logarithm"},
                    {"observed", p.observed()}});
  }
  return json;
}

}  // namespace waymark::program
