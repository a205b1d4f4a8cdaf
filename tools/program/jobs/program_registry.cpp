#include <waymark/tools/program/jobs/program_registry.hpp>

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/detail/module_file.hpp>
#include <waymark/core/registry/plugin_loader.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark::program {
namespace {

namespace fs = std::filesystem;

/// Returns the folder of plugins in the prefix of this installation, wherever that is: beside the library
/// that plugins use. The program may be that of Python.
fs::path installed_folder() {
  Dl_info library{};
  if (::dladdr(reinterpret_cast<const void*>(&load_plugin), &library) == 0) return WAYMARK_PLUGIN_FOLDER;
  std::error_code unknown;
  const fs::path file = fs::canonical(library.dli_fname, unknown);
  return unknown ? fs::path(WAYMARK_PLUGIN_FOLDER) : file.parent_path() / "waymark/plugins";
}

std::vector<PluginFolder> plugin_folders() {
  std::vector<PluginFolder> folders;
  folders.push_back({installed_folder().string(), true, {}});
  const char* variable = std::getenv("WAYMARK_PLUGIN_PATH");
  std::string rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    if (colon != 0) folders.push_back({rest.substr(0, colon), false, {}});
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return folders;
}

/// Returns the shared objects of a folder by name. @param folder receives the reason if
/// there are none
std::vector<fs::path> modules_in(PluginFolder& folder) {
  std::vector<fs::path> modules;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path, missing)) {
    if (entry.path().extension() == ".so") modules.push_back(entry.path());
  }
  if (missing) folder.problem = missing.message();
  std::sort(modules.begin(), modules.end());
  return modules;
}

/// Returns why a file is no plugin of ours; empty: it is a plugin, whether it fits or not.
std::string not_ours(const fs::path& file) {
  try {
    if (ModuleFile(file).symbol("waymark_plugin")) return {};
    return file.string() + ": is no waymark plugin (no symbol 'waymark_plugin')";
  } catch (const UsageError& error) {  // unreadable, or no shared object
    return error.what();
  }
}

/// Returns a file as it is; looks up a name in the folders. @throws UsageError
fs::path find_plugin(const std::string& wanted, const std::vector<PluginFolder>& folders) {
  if (drive::is_plugin_file(wanted)) return wanted;
  std::string looked;
  for (const PluginFolder& folder : folders) {
    const fs::path file = fs::path(folder.path) / (wanted + ".so");
    std::error_code unknown;
    if (fs::exists(file, unknown)) return file;
    looked += (looked.empty() ? "" : ", ") + folder.path;
  }
  throw UsageError("no plugin '" + wanted + "': searched for " + wanted + ".so in " +
                   (looked.empty() ? "no folder" : looked) +
                   "; give the file's path, or its folder in WAYMARK_PLUGIN_PATH");
}

/// Loads modules, each file once, and keeps a record of each.
class Loader {
 public:
  explicit Loader(PluginSearch& search) : search_(search) {}

  void load_wanted(const std::string& wanted) {
    try {
      load(find_plugin(wanted, search_.folders), true);
    } catch (const UsageError& error) {
      search_.modules.push_back({wanted, true, PluginModule::State::refused, error.what()});
    }
  }

  void load_found(const fs::path& file) {
    const std::string reason = not_ours(file);
    if (reason.empty()) {
      load(file, false);
    } else {
      search_.modules.push_back({file.string(), false, PluginModule::State::no_plugin, reason});
    }
  }

 private:
  void load(const fs::path& file, bool asked_for) {
    std::error_code missing;
    const fs::path place = fs::canonical(file, missing);
    if (!missing && loaded_.contains(place)) return;
    PluginModule module{file.string(), asked_for, PluginModule::State::loaded, {}};
    try {
      load_plugin(file.string(), search_.registry);
      loaded_.insert(place);
    } catch (const UsageError& error) {
      module.state = PluginModule::State::refused;
      module.problem = error.what();
    }
    search_.modules.push_back(module);
  }

  PluginSearch& search_;
  std::set<fs::path> loaded_;
};

TypeRegistry own_registry() {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  solvers::register_solvers(registry);
  plugins::register_builtin_plugins(registry);
  formats::register_log_readers(registry);
  return registry;
}

}  // namespace

PluginSearch search_plugins(const std::vector<std::string>& wanted) {
  PluginSearch search{own_registry(), plugin_folders(), {}};
  Loader loader(search);
  for (const std::string& plugin : wanted) loader.load_wanted(plugin);
  for (PluginFolder& folder : search.folders) {
    for (const fs::path& file : modules_in(folder)) loader.load_found(file);
  }
  return search;
}

namespace {

std::map<std::string, std::string>& origins() {
  static std::map<std::string, std::string> by_tag;
  return by_tag;
}

void keep_origins(const TypeRegistry& registry) {
  for (const auto& [type, origin] : registry.vertices()) origins()[type.tag] = origin;
  for (const auto& [type, origin] : registry.edges()) origins()[type.tag] = origin;
}

}  // namespace

std::string plugin_of(const std::string& type) {
  const auto found = origins().find(type);
  return found == origins().end() || found->second == "waymark" ? "" : found->second;
}

TypeRegistry make_registry(const CommonOptions& options, const std::vector<std::string>& plugins) {
  return make_registry(options, plugins, Console(options));
}

TypeRegistry make_registry(const CommonOptions& options, const std::vector<std::string>& plugins,
                           const Console& console) {
  std::vector<std::string> wanted = options.plugins;
  wanted.insert(wanted.end(), plugins.begin(), plugins.end());
  PluginSearch search = search_plugins(wanted);
  for (const PluginModule& module : search.modules) {
    if (module.asked_for && module.state == PluginModule::State::refused) throw UsageError(module.problem);
  }
  for (const PluginFolder& folder : search.folders) {
    if (!folder.problem.empty() && !folder.installed)
      console.warning("no plugins from " + folder.path + ": " + folder.problem);
  }
  for (const PluginModule& module : search.modules) {  // other shared objects are not ours
    if (module.state == PluginModule::State::refused) console.warning("plugin left out: " + module.problem);
  }
  keep_origins(search.registry);
  return std::move(search.registry);
}

std::vector<std::string> installed_plugin_names() {
  std::vector<std::string> names;
  for (PluginFolder folder : plugin_folders()) {
    for (const fs::path& file : modules_in(folder)) {
      if (not_ours(file).empty()) names.push_back(file.stem().string());
    }
  }
  return names;
}

}  // namespace waymark::program
