#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/formats/graph_document.hpp>
#include <waymark/tools/program/commands.hpp>
#include <waymark/tools/program/output.hpp>
#include <waymark/tools/program/program_registry.hpp>

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

Json options_json(const std::vector<OptionInfo>& options) {
  Json json = Json::array();
  for (const OptionInfo& o : options) {
    json.push_back(
        {{"name", o.name}, {"default", o.value}, {"unit", o.unit}, {"description", o.description}});
  }
  return json;
}

/// Everything that is registered, as JSON; the text is made from the same.
Json registry_json(const TypeRegistry& registry) {
  Json json = {{"version", WAYMARK_VERSION}};
  for (const auto& [type, origin] : registry.vertices()) {
    json["vertices"].push_back(
        {{"name", type.tag},
         {"origin", origin},
         {"description", fmt::format("values {}; {} degrees of freedom", fmt::join(type.value_names, " "),
                                     type.tangent_size)}});
  }
  for (const auto& [type, origin] : registry.edges()) {
    json["edges"].push_back({{"name", type.tag}, {"origin", origin}, {"description", describe_schema(type)}});
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
  for (const auto& [type, origin] : registry.algorithms()) {
    json["algorithms"].push_back({{"name", type.name},
                                  {"origin", origin},
                                  {"description", type.description},
                                  {"options", options_json(type.options)}});
  }
  for (const auto& [type, origin] : registry.linear_solvers()) {
    json["solvers"].push_back({{"name", type.name},
                               {"origin", origin},
                               {"description", type.description + "; licence " + type.license}});
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
      {{"name", "toro"}, {"origin", "waymark"}, {"description", "TORO SE(2); read where asked for"}}};
  json["trajectory_formats"] = {
      {{"name", "csv"}, {"origin", "waymark"}, {"description", "written; every column"}},
      {{"name", "tum"}, {"origin", "waymark"}, {"description", "written, read as truth; for evo"}},
      {{"name", "geojson"}, {"origin", "waymark"}, {"description", "written; for maps"}}};
  return json;
}

std::string registry_text(const Json& json) {
  std::string text = "waymark " + json["version"].get<std::string>() + "\n";
  for (const auto& [section, entries] : json.items()) {
    if (!entries.is_array()) continue;
    text += "\n" + section + "\n";
    for (const Json& entry : entries) {
      const std::string origin = entry["origin"];
      text += fmt::format("  {:<22} {}{}\n", entry["name"].get<std::string>(),
                          entry["description"].get<std::string>(),
                          origin == "waymark" ? "" : "  [" + origin + "]");
      for (const Json& option : entry.value("options", Json::array())) {
        const std::string unit = option["unit"];
        text += fmt::format(
            "    {:<34} {:<10} {}\n", option["name"].get<std::string>(), option["default"].get<std::string>(),
            option["description"].get<std::string>() + (unit.empty() ? "" : " [" + unit + "]"));
      }
    }
  }
  return text;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("info", "Types, modelings, solvers, algorithms, formats, with their fields");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(*command, *options);
  command->footer("Example:\n  waymark info --plugin my_sensor.so");
  command->callback([options, &action] {
    action = [options] {
      const Json json = registry_json(make_registry(*options));
      Console(*options).result(options->json ? json_text(json) : registry_text(json));
      return kSuccess;
    };
  });
}

}  // namespace waymark
