#include <waymark/tools/program/jobs/plugin_list.hpp>

namespace waymark::program {
namespace {

using Json = nlohmann::ordered_json;

/// Appends the names of the entries of one table that come from a plugin.
template <typename T, typename NameOf>
void add_names(const RegistryTable<T>& table, const std::string& origin, NameOf name_of, Json& names) {
  for (const Registered<T>& entry : table) {
    if (entry.origin == origin) names.push_back(name_of(entry.type));
  }
}

}  // namespace

nlohmann::ordered_json plugins_json(const TypeRegistry& registry) {
  const auto tag_of = [](const auto& type) { return type.tag; };
  const auto name_of = [](const auto& type) { return type.name; };
  Json plugins = Json::array();
  for (const PluginRecord& plugin : registry.plugins()) {
    Json brings = Json::array();
    add_names(registry.vertices(), plugin.name, tag_of, brings);
    add_names(registry.edges(), plugin.name, tag_of, brings);
    add_names(registry.gnss_modelings(), plugin.name, name_of, brings);
    add_names(registry.odometry_models(), plugin.name, name_of, brings);
    add_names(registry.sensor_models(), plugin.name, name_of, brings);
    add_names(registry.log_readers(), plugin.name, name_of, brings);
    add_names(registry.losses(), plugin.name, name_of, brings);
    add_names(registry.linear_solvers(), plugin.name, name_of, brings);
    add_names(registry.algorithms(), plugin.name, name_of, brings);
    add_names(registry.starts(), plugin.name, name_of, brings);
    plugins.push_back(
        {{"name", plugin.name}, {"version", plugin.version}, {"place", plugin.place}, {"brings", brings}});
  }
  return plugins;
}

}  // namespace waymark::program
