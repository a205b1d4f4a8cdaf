#include <waymark/tools/reproduction/experiment/setting.hpp>

namespace waymark::reproduction {
namespace {

/// Sets the dogleg of g2o, and its stopping rule.
void use_g2o_dogleg(Setting& setting) {
  setting.fusion.minimization.options = {
      {"scaling", "none"}, {"radius", "absolute"}, {"initial_radius", "1e4"}};
  setting.stopping = StoppingRule::relative_gain;
}

/// G1 and G3 have the same objective. That of G2 differs by the slack of its identity edges, which
/// is far below the differences that matter here.
Setting paper_setting(const std::string& modeling) {
  Setting setting = stated_setting("paper_" + modeling, modeling);
  setting.fusion.modeling_options = {{"error", "literal"}};
  // The paper does not say where the nodes of G2 begin. If they begin at the fixes, kilometres from
  // dead reckoning, g2o's dogleg does not reach the minimum of G2, but the paper says that it did
  // in all its drives.
  if (modeling == "g2") setting.fusion.modeling_options["nodes_begin"] = "pose";
  setting.fusion.lever_arm = false;
  setting.fusion.initial_guess.method = drive::StartMethod::dead_reckoning;
  setting.fusion.odometry_options = {{"noise", "paper"}};
  use_g2o_dogleg(setting);
  setting.objective = "literal " + modeling;
  return setting;
}

Setting our_setting(const std::string& modeling) {
  Setting setting = stated_setting("ours_" + modeling, modeling);
  setting.objective = "decoupled";
  return setting;
}

/// Returns the three modelings, and g2 without the gate.
template <typename Make>
std::vector<Setting> four_settings(Make make) {
  std::vector<Setting> settings;
  for (const char* modeling : kModelings) settings.push_back(make(modeling));
  Setting open = make("g2");
  open.name += "_no_rejection";
  open.objective += " without rejection";
  open.fusion.gate.enabled = false;
  settings.push_back(open);
  return settings;
}

void use_our_radius(Setting& setting) {
  setting.fusion.minimization.options = {};
}

void use_our_error(Setting& setting) {
  setting.fusion.modeling_options["error"] = "decoupled";
  setting.objective = "decoupled " + setting.fusion.modeling;
}

void use_our_stopping(Setting& setting) {
  setting.stopping = StoppingRule::full_steps;
  setting.fusion.minimization.max_iterations = kBareIterations;
}

void use_our_start(Setting& setting) {
  setting.fusion.initial_guess.method = drive::StartMethod::anchored;
}

void apply_cause(const std::string& cause, Setting& setting) {
  if (cause == "radius" || cause == "all_but_start") use_our_radius(setting);
  if (cause == "heading" || cause == "all_but_start") use_our_error(setting);
  if (cause == "stopping" || cause == "all_but_start") use_our_stopping(setting);
  if (cause == "start") use_our_start(setting);
  if (cause == "east") setting.fusion.initial_guess.first_heading_rad = 0;
  if (cause == "nodes_at_fixes") setting.fusion.modeling_options["nodes_begin"] = "fix";
}

}  // namespace

Setting stated_setting(const std::string& name, const std::string& modeling) {
  Setting setting{.name = name};
  setting.fusion.modeling = modeling;
  setting.fusion.gate.enabled = true;
  setting.fusion.calibration = Options();
  setting.fusion.estimates_noise = false;
  return setting;
}

Setting default_setting() {
  return {.name = kDefaultModel};
}

std::vector<Setting> paper_settings() {
  return four_settings(paper_setting);
}

std::vector<Setting> our_settings() {
  return four_settings(our_setting);
}

const std::vector<Cause>& causes() {
  static const std::vector<Cause> all = {{"radius", "scaled radius"},         {"heading", "no dummy heading"},
                                         {"stopping", "full steps only"},     {"start", "anchored guess"},
                                         {"all_but_start", "first three"},    {"east", "guess to the east"},
                                         {"nodes_at_fixes", "nodes at fixes"}};
  return all;
}

std::vector<Setting> cause_settings() {
  std::vector<Setting> settings;
  for (const char* modeling : kModelings) {
    for (const Cause& cause : causes()) {
      // the others have no such nodes
      if (cause.name == "nodes_at_fixes" && modeling != std::string("g2")) continue;
      Setting setting = paper_setting(modeling);
      setting.name += "/" + cause.name;
      setting.evaluated = false;
      apply_cause(cause.name, setting);
      settings.push_back(std::move(setting));
    }
  }
  return settings;
}

std::vector<Setting> minimum_settings() {
  std::vector<Setting> settings;
  for (Setting setting : paper_settings()) {
    const std::string name = setting.name;
    setting.fusion.minimization = {.tolerance = 1e-12};
    setting.stopping = StoppingRule::full_steps;
    use_our_start(setting);
    setting.name = name + "/minimum";
    settings.push_back(setting);
    if (setting.fusion.gate.enabled == false) continue;
    setting.evaluated = false;
    use_our_error(setting);
    setting.name = name + "/heading_minimum";
    settings.push_back(setting);
  }
  return settings;
}

std::vector<Setting> convergence_settings() {
  std::vector<Setting> settings;
  for (const char* modeling : kModelings) {
    for (const std::string start : kConvergenceStarts) {
      for (const std::string algorithm : kConvergenceAlgorithms) {
        Setting setting = our_setting(modeling);
        setting.name += "/" + start + "/" + algorithm;
        drive::StartOptions& guess = setting.fusion.initial_guess;
        if (start != "anchored") guess.method = drive::StartMethod::dead_reckoning;
        if (start == "east") guess.first_heading_rad = 0;
        const std::size_t plus = algorithm.find('+');
        const bool all_starts = plus != std::string::npos || algorithm == "default";
        if (start == "east" && !all_starts) continue;
        drive::Minimization& minimization = setting.fusion.minimization;
        if (all_starts) {
          minimization.start = "auto";
        } else {
          minimization.max_iterations = kBareIterations;
          // Damping bends a first step of kilometres into a wrong winding.
          if (algorithm == "levenberg_marquardt") minimization.options = {{"initial_damping", "1e-12"}};
        }
        if (algorithm != "default") minimization.algorithm = algorithm.substr(0, plus);
        setting.evaluated = false;
        settings.push_back(setting);
      }
    }
  }
  return settings;
}

}  // namespace waymark::reproduction
