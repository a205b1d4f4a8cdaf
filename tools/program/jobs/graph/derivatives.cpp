#include <waymark/tools/program/jobs/graph/derivatives.hpp>

#include <fmt/format.h>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/graph/checks/vertex_type_check.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
std::string problem_of(const EdgeTypeCheck& check, const std::string& tag, const std::string& origin) {
  if (check.worst.error > kGradientTolerance) {
    return fmt::format("{} of {}, scenario '{}': {}", tag, origin, check.scenario,
                       describe(check.graph, 0, check.worst));
  }
  if (check.relative.error > kRelativeTolerance)
    return fmt::format("{} of {}: {}", tag, origin, describe(check.relative));
  if (check.normal_error > kNormalTolerance) {
    return fmt::format(
        "{} of {}: its normal equations differ from those of its Jacobians by {:.1e}: carry() of its vertex "
        "type is wrong",
        tag, origin, check.normal_error);
  }
  if (check.sight_error > kSightTolerance) {
    return fmt::format(
        "{} of {}: its error is {:.1e} where its sight says that it is zero: sight() and error() disagree about "
        "where the point is seen (core/base/sight.hpp)",
        tag, origin, check.sight_error);
  }
  if (check.not_finite == 0) {
    return fmt::format(
        "{} of {}: no trial has usable differences of the error; make the error smooth "
        "and compute it in double",
        tag, origin);
  }
  return fmt::format("{} of {}: error or Jacobian is not finite in {} of {} trials; keep the error finite",
                     tag, origin, check.not_finite, check.trials);
}

namespace {

/// Adds what vertex types and losses promise and do not keep.
void check_promises(const TypeRegistry& registry, DerivativeReport& report) {
  const auto add = [&](const std::string& name, const std::string& origin,
                       const std::vector<std::string>& broken) {
    for (const std::string& promise : broken)
      report.problems.push_back(fmt::format("{} of {}: {}", name, origin, promise));
  };
  for (const auto& [type, origin] : registry.vertices()) add(type.tag, origin, broken_promises(type));
  for (const auto& [type, origin] : registry.losses())
    add("loss " + type.name, origin, broken_promises(type));
}

}  // namespace

DerivativeReport check_derivatives(const TypeRegistry& registry, const text::TextLook& look) {
  DerivativeReport report;
  report.text = "Jacobians against differences of the error\n";
  report.json = nlohmann::ordered_json::array();
  text::Table table{.columns = {"edge type", "from", "trials", "off by", ""}};
  for (const auto& [type, origin] : registry.edges()) {
    const EdgeTypeCheck check = check_edge_type(registry, type);
    table.rows.push_back({type.tag, origin, std::to_string(check.trials),
                          fmt::format("{:.1e}", check.worst.error), check.sound() ? "" : "WRONG"});
    if (!check.sound()) table.tones[{table.rows.size() - 1, 4}] = text::Tone::error;
    report.json.push_back({{"type", type.tag},
                           {"origin", origin},
                           {"trials", check.trials},
                           {"not_finite", check.not_finite},
                           {"jacobian_error", check.worst.error},
                           {"relative_error", check.relative.error},
                           {"normal_error", check.normal_error},
                           {"sight_error", check.sight_error},
                           {"sound", check.sound()}});
    if (!check.sound()) report.problems.push_back(problem_of(check, type.tag, origin));
  }
  check_promises(registry, report);
  if (!table.rows.empty()) report.text += text::table_text(table, look);
  return report;
}

}  // namespace waymark::program
