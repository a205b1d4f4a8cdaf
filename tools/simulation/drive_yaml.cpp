#include <waymark/tools/simulation/drive_yaml.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace waymark::simulation {
namespace {

double yaw_walk(const OdometryRecipe& odometry) {
  return odometry.yaw_rate_noise_radps / std::sqrt(odometry.rate_hz);
}

std::string commented(const std::string& indent, const std::string& keys, const std::string& comment) {
  return fmt::format("{}{:<{}}# {}\n", indent, keys, 34 - indent.size(), comment);
}

std::string odometry_keys(const OdometryRecipe& odometry, const std::string& indent) {
  return commented(indent, "file: " + log_file(odometry), "time_s: GPS seconds since 1980") + indent +
         "columns: {time: time_s, speed: speed_mps, yaw_rate: yaw_rate_radps}\n";
}

std::string gnss_keys(const GnssRecipe& gnss, const std::string& indent) {
  std::string text = indent + "file: " + log_file(gnss) + "\n" + indent + "format: gpsd_json\n";
  if (!gnss.antenna_m.isZero(0))
    text += fmt::format("{}antenna: [{:g}, {:g}]\n", indent, gnss.antenna_m[0], gnss.antenna_m[1]);
  return text + commented(indent, "accuracy: {meaning: 95}", "epx and epy");
}

/// Returns the kinds of its roads, each once: "urban, rural".
std::string environment(const SimulationRecipe& recipe) {
  std::vector<std::string> kinds;
  for (const RoadRecipe& road : recipe.roads)
    if (std::find(kinds.begin(), kinds.end(), road.kind) == kinds.end()) kinds.push_back(road.kind);
  return fmt::format("{}", fmt::join(kinds, ", "));
}

std::string one_of_each(const SimulationRecipe& recipe) {
  return fmt::format(
      "# Errors: fixes {:.2f} s late, of {:g} m over {:.0f} s; yaw rate {:.2g} rad/sqrt(s); "
      "odometry of {:g} Hz.\n",
      recipe.gnss.delay_s, recipe.gnss.fast_sigma_m, recipe.gnss.fast_tau_s, yaw_walk(recipe.odometry),
      recipe.odometry.rate_hz);
}

std::string sections(const SimulationRecipe& recipe) {
  return "odometry:\n" + odometry_keys(recipe.odometry, "  ") + "\ngnss:\n" + gnss_keys(recipe.gnss, "  ");
}

std::string source_text(const OdometryRecipe& odometry) {
  const std::string comment = fmt::format("{:g} Hz; yaw rate {:.2g} rad/sqrt(s); silent {:g} % of the time",
                                          odometry.rate_hz, yaw_walk(odometry), 100 * odometry.silent_share);
  return commented("  ", odometry.name + ":", comment) + "    kind: odometry\n" +
         odometry_keys(odometry, "    ");
}

/// @param shares_with the first receiver with a common_share
std::string source_text(const GnssRecipe& gnss, const std::string& shares_with) {
  const std::string comment =
      fmt::format("{:g} Hz; errors of {:.2f} m over {:.0f} s; {} epochs missing", gnss.rate_hz,
                  gnss.fast_sigma_m, gnss.fast_tau_s, gnss.missing_epochs);
  std::string text = commented("  ", gnss.name + ":", comment) + "    kind: gnss\n" + gnss_keys(gnss, "    ");
  if (gnss.common_share > 0 && gnss.name != shares_with) text += "    common: " + shares_with + "\n";
  return text;
}

std::string sources(const SimulationRecipe& recipe) {
  std::string text = "sources:\n";
  for (const OdometryRecipe& odometry : recipe.all_odometry()) text += source_text(odometry);
  std::string shares_with;
  for (const GnssRecipe& gnss : recipe.all_gnss()) {
    if (gnss.common_share > 0 && shares_with.empty()) shares_with = gnss.name;
    text += source_text(gnss, shares_with);
  }
  return text;
}

}  // namespace

std::string log_file(const OdometryRecipe& odometry) {
  return odometry.name + ".csv";
}

std::string log_file(const GnssRecipe& gnss) {
  return gnss.name + ".json";
}

std::string drive_yaml(const SimulatedDrive& drive) {
  const SimulationRecipe& recipe = drive.recipe;
  return fmt::format(
      "# Simulated drive: no vehicle drove this. Made by `waymark simulate`, recipe {}, seed {}; the models "
      "are\n"
      "# explained in tools/simulation/README.md, the keys in tools/drive/README.md.\n"
      "{}"
      "name: \"{}\"\n"
      "environment: \"{}\"\n"
      "time: {{scale: gps}}              # gpsd's log counts UTC and is converted\n"
      "\n"
      "{}"
      "\n"
      "truth:\n"
      "  file: truth.csv\n"
      "  columns: {{time: time_s, latitude: latitude_deg, longitude: longitude_deg, height: height_m, "
      "heading: "
      "heading_rad}}\n",
      recipe.name, drive.seed, recipe.has_several() ? "" : one_of_each(recipe), drive.name,
      environment(recipe), recipe.has_several() ? sources(recipe) : sections(recipe));
}

}  // namespace waymark::simulation
