#include <waymark/tools/program/jobs/model_report.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/text/text_table.hpp>

namespace waymark::program {

std::string describe_model(const drive::ModeledDrive& modeled, const text::TextLook& look) {
  std::string text;
  const drive::GateSummary& gate = modeled.gate;
  std::string reasons;
  for (const auto& [reason, count] : gate.reasons) reasons += fmt::format(" {} {}", reason, count);
  if (modeled.config.gate.enabled) {
    text += fmt::format("gate        {} of {} fixes rejected ({:.1f} %):{}\n", gate.rejected,
                        gate.accepted + gate.rejected, gate.rejected_percent(), reasons);
  } else {
    text += fmt::format("gate        off: all {} fixes are used\n", gate.accepted);
  }
  if (modeled.noise.parameters.empty()) return text;
  text::TextTable table({"estimated noise", "unit", "value", "68 % between", "and", "known before"});
  for (const drive::NoiseParameter& p : modeled.noise.parameters) {
    const bool linear = p.prior.linear;
    const auto moved = [&](double by) { return linear ? p.value + by : p.value * std::exp(by); };
    table.add({p.option, p.unit, fmt::format("{:.3g}", p.value), fmt::format("{:.3g}", moved(-p.deviation)),
               fmt::format("{:.3g}", moved(p.deviation)),
               p.observed() ? fmt::format("{:.3g}", p.prior.mean) : "not observed"});
  }
  return text + table.text(look);
}

nlohmann::ordered_json noise_json(const drive::NoiseEstimate& noise) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const drive::NoiseParameter& p : noise.parameters) {
    json.push_back({{"owner", p.owner},
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
