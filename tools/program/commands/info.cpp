#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/registry/plugin.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/plugin_list.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

using Json = nlohmann::ordered_json;

Json options_json(const std::vector<OptionInfo>& options) {
  Json json = Json::array();
  for (const OptionInfo& o : options) {
    json.push_back(
        {{"name", o.name}, {"default", o.value}, {"unit", o.unit}, {"description", o.description()}});
    if (!o.prior) continue;
    json.back()["prior"] = {{"mean", o.prior->mean},
                            {"deviation", o.prior->deviation},
                            {"of", o.prior->linear ? "value" : "logarithm"}};
  }
  return json;
}

Json sensor_json(const SensorModelType& type, const std::string& origin) {
  Json columns = Json::array();
  for (const SensorColumn& c : type.columns) {
    columns.push_back({{"name", c.name},
                       {"unit", c.unit},
                       {"sense", c.sense},
                       {"required", c.required},
                       {"description", c.description}});
  }
  return {{"name", type.name},  {"origin", origin},  {"description", type.description},
          {"columns", columns}, {"loss", type.loss}, {"options", options_json(type.options)}};
}

std::string plugins_text(const Json& plugins, const text::TextLook& look) {
  const BuildTraits traits = build_traits();
  std::string text = fmt::format("plugin ABI {}, Eigen {} with alignment {}, layout {:08x}\n", kPluginAbi,
                                 traits.eigen_version, traits.eigen_max_align, traits.layout);
  for (const Json& plugin : plugins) {
    text += fmt::format("{} {}, {}\n",
                        text::painted(plugin["name"].get<std::string>(), text::Tone::heading, look),
                        plugin["version"].get<std::string>(), plugin["place"].get<std::string>());
    for (const Json& name : plugin["brings"]) text += "  " + name.get<std::string>() + "\n";
  }
  return text;
}

/// Returns everything that is registered, as JSON. The text is made from it.
Json registry_json(const TypeRegistry& registry) {
  Json json = {{"program_version", WAYMARK_VERSION}};
  for (const auto& [type, origin] : registry.vertices()) {
    json["vertices"].push_back(
        {{"name", type.tag},
         {"origin", origin},
         {"description", fmt::format("values {}; {} degrees of freedom", fmt::join(type.value_names, " "),
                                     type.tangent_size)}});
  }
  for (const auto& [type, origin] : registry.edges()) {
    json["edges"].push_back(
        {{"name", type.tag}, {"origin", origin}, {"description", formats::describe_schema(type)}});
  }
  for (const auto& [type, origin] : registry.gnss_modelings()) {
    json["modelings"].push_back({{"name", type.name},
                                 {"origin", origin},
                                 {"description", type.description},
                                 {"options", options_json(type.options)}});
  }
  for (const auto& [type, origin] : registry.odometry_models()) {
    json["odometry_models"].push_back({{"name", type.name},
                                       {"origin", origin},
                                       {"description", type.description},
                                       {"options", options_json(type.options)}});
  }
  for (const auto& [type, origin] : registry.sensor_models())
    json["sensors"].push_back(sensor_json(type, origin));
  for (const auto& [type, origin] : registry.algorithms()) {
    json["algorithms"].push_back({{"name", type.name},
                                  {"origin", origin},
                                  {"description", type.description},
                                  {"options", options_json(type.options)}});
  }
  for (const auto& [type, origin] : registry.linear_solvers()) {
    json["solvers"].push_back(
        {{"name", type.name},
         {"origin", origin},
         {"description",
          type.license.empty() ? type.description : type.description + "; licence " + type.license},
         {"options", options_json(type.options)}});
  }
  for (const auto& [type, origin] : registry.starts()) {
    json["starts"].push_back({{"name", type.name}, {"origin", origin}, {"description", type.description}});
  }
  for (const auto& [type, origin] : registry.losses()) {
    json["losses"].push_back(
        {{"name", type.name}, {"origin", origin}, {"description", "rho(s) = " + type.formula}});
  }
  for (const auto& [type, origin] : registry.log_readers()) {
    json["log_formats"].push_back(
        {{"name", type.name}, {"origin", origin}, {"description", type.description}});
  }
  json["graph_formats"] = {
      {{"name", "graph"}, {"origin", "waymark"}, {"description", "GRAPH 1; read and written"}},
      {{"name", "g2o"}, {"origin", "waymark"}, {"description", "g2o SE(2); read and written"}},
      {{"name", "toro"}, {"origin", "waymark"}, {"description", "TORO SE(2); read and written on request"}},
      {{"name", "covariance"},
       {"origin", "waymark"},
       {"description", "GTSAM's covariance .graph; read and written on request"}}};
  json["trajectory_formats"] = {
      {{"name", "csv"}, {"origin", "waymark"}, {"description", "written; every column"}},
      {{"name", "tum"}, {"origin", "waymark"}, {"description", "written, read as truth; for evo"}},
      {{"name", "geojson"},
       {"origin", "waymark"},
       {"description", "written; for maps, with a style for QGIS"}},
      {{"name", "kml"}, {"origin", "waymark"}, {"description", "written; for Google Earth and QGIS"}},
      {{"name", "gpx"}, {"origin", "waymark"}, {"description", "written; for receivers' software"}}};
  return json;
}

/// Returns the width of the longest text of the entries under a key.
std::size_t width_of(const Json& entries, const char* key) {
  std::size_t width = 0;
  for (const Json& entry : entries) width = std::max(width, entry.at(key).get<std::string>().size());
  return width;
}

std::string registry_text(const Json& json, const text::TextLook& look) {
  std::string text = "waymark " + json["program_version"].get<std::string>() + "\n";
  for (const auto& [section, entries] : json.items()) {
    if (!entries.is_array()) continue;
    text += "\n" + text::painted(section, text::Tone::heading, look) + "\n";
    const std::size_t names = width_of(entries, "name");
    for (const Json& entry : entries) {
      const std::string origin = entry["origin"];
      text += fmt::format("  {:<{}}  {}{}\n", entry["name"].get<std::string>(), names,
                          entry["description"].get<std::string>(),
                          origin == "waymark" ? "" : "  [" + origin + "]");
      const Json columns = entry.value("columns", Json::array());
      for (const Json& column : columns) {
        text += fmt::format("    column {:<{}}  {:<{}}  {}{}\n", column["name"].get<std::string>(),
                            width_of(columns, "name"), column["unit"].get<std::string>(),
                            width_of(columns, "unit"), column["description"].get<std::string>(),
                            column["required"].get<bool>() ? "" : " (optional)");
      }
      if (entry.contains("loss")) text += "    loss " + entry["loss"].get<std::string>() + "\n";
      const Json options = entry.value("options", Json::array());
      for (const Json& option : options) {
        const std::string unit = option["unit"];
        text += fmt::format(
            "    {:<{}}  {:<{}}  {}\n", option["name"].get<std::string>(), width_of(options, "name"),
            option["default"].get<std::string>(), width_of(options, "default"),
            option["description"].get<std::string>() + (unit.empty() ? "" : " [" + unit + "]") +
                (option.contains("prior") ? "; a noise parameter, estimated on demand" : ""));
      }
    }
  }
  return text;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  struct InfoOptions {
    CommonOptions common;
    bool plugins = false;
  };
  auto* command = app.add_subcommand(
      "info",
      "List types, modelings, solvers, algorithms and formats\n\n"
      "Lists every name that the command line or a drive.yaml can use, plugins included, with "
      "fields, options and defaults.");
  const auto options = std::make_shared<InfoOptions>();
  command->add_flag("--plugins", options->plugins,
                    "List only the plugins: the file of each and the names that it registers");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark info --plugins --plugin ./my_sensor.so");
  command->callback([options, &action] {
    action = [options] {
      const TypeRegistry registry = make_registry(options->common);
      const Console console(options->common);
      if (options->plugins) {
        const Json plugins = plugins_json(registry);
        console.result(console.json() ? json_document("plugins", {{"plugins", plugins}})
                                      : plugins_text(plugins, console.look()));
      } else {
        const Json json = registry_json(registry);
        console.result(console.json() ? json_document("info", json) : registry_text(json, console.look()));
      }
      return kSuccess;
    };
  });
}

}  // namespace waymark::program
