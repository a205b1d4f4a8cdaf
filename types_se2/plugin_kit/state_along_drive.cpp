#include <waymark/types_se2/plugin_kit/state_along_drive.hpp>

namespace waymark {

std::vector<OptionInfo> state_options(const std::string& name, const std::string& unit,
                                      const std::string& model, const std::string& prior_sigma,
                                      const std::string& walk_sigma, const std::string& what) {
  const std::string rate = unit == "1" ? "1/sqrt(s)" : unit + "/sqrt(s)";
  return {{name, model, "", OptionWords{"off", "constant", "random_walk"},
           what + ", estimated: 'off', 'constant' or 'random_walk'"},
          {name + "_sigma", prior_sigma, unit, OptionRange{1e-9, 10}, "sigma of the prior about 0"},
          {name + "_walk", walk_sigma, rate, OptionRange{1e-12, 1}, "sigma of the change after one second"}};
}

OptionInfo calibration_period_option() {
  return {"calibration_period", "10", "s", OptionRange{0.1, 1e4}, "time between two values of a random walk"};
}

StateOptions read_state(const CheckedOptions& options, const std::string& name) {
  const std::string& model = options.word(name);
  return {.model = model == "off"        ? StateModel::off
                   : model == "constant" ? StateModel::constant
                                         : StateModel::random_walk,
          .prior_sigma = options.number(name + "_sigma"),
          .walk_sigma = options.number(name + "_walk"),
          .period_s = options.number("calibration_period")};
}

}  // namespace waymark
