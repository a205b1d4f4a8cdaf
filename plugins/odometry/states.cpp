#include <waymark/plugins/odometry/detail/states.hpp>

namespace waymark::plugins::odometry {

std::vector<OptionInfo> state_options(const std::string& name, const std::string& unit,
                                      const std::string& prior_sigma, const std::string& walk_sigma,
                                      const std::string& what) {
  const std::string rate = unit == "1" ? "1/sqrt(s)" : unit + "/sqrt(s)";
  return {{name, "off", "", OptionWords{"off", "constant", "random_walk"},
           what + ", estimated: 'off', 'constant' or 'random_walk'"},
          {name + "_sigma", prior_sigma, unit, OptionRange{1e-9, 10}, "sigma of the prior about 0"},
          {name + "_walk", walk_sigma, rate, OptionRange{1e-12, 1}, "sigma of the change after one second"}};
}

}  // namespace waymark::plugins::odometry
