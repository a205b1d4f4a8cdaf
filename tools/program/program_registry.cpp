#include <waymark/tools/program/program_registry.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <waymark/core/error.hpp>
#include <waymark/core/module_file.hpp>
#include <waymark/core/plugin_loader.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/tools/drive/config.hpp>
#include <waymark/types_se2/register.hpp>

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// Empty where the program is not to be installed.
fs::path installed_folder() {
#ifdef WAYMARK_PLUGIN_FOLDER
  return WAYMARK_PLUGIN_FOLDER;
#else
  return {};
#endif
}

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  if (!installed_folder().empty()) folders.push_back(installed_folder());
  const char* variable = std::getenv("WAYMARK_PLUGIN_PATH");
  std::string rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const auto colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return folders;
}

/// The plugins of a folder by name; other shared objects are none of ours.
std::vector<fs::path> modules_in(const fs::path& folder, const Console& console) {
  std::vector<fs::path> modules;
  std::error_code missing;
  fs::directory_iterator entries(folder, missing);
  if (missing && folder != installed_folder())
    console.note("warning: no plugins from " + folder.string() + ": " + missing.message());
  for (const fs::directory_entry& entry : entries) {
    if (entry.path().extension() != ".so") continue;
    try {
      if (ModuleFile(entry.path()).symbol("waymark_plugin")) modules.push_back(entry.path());
    } catch (const UsageError&) {  // not readable, or no shared object
    }
  }
  std::sort(modules.begin(), modules.end());
  return modules;
}

/// A file as it stands; a name is looked up in the folders. @throws UsageError
fs::path find_plugin(const std::string& wanted, const std::vector<fs::path>& folders) {
  if (is_plugin_file(wanted)) return wanted;
  std::string looked;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / (wanted + ".so");
    if (fs::exists(file)) return file;
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  throw UsageError("no plugin '" + wanted + "': looked for " + wanted + ".so in " +
                   (looked.empty() ? "no folder" : looked) +
                   "; give the file's path, or its folder in WAYMARK_PLUGIN_PATH");
}

/// Loads modules, each file once.
class Loader {
 public:
  explicit Loader(TypeRegistry& registry) : registry_(registry) {}

  void load(const fs::path& file) {
    std::error_code missing;
    const fs::path place = fs::canonical(file, missing);
    if (!missing && loaded_.contains(place)) return;
    load_plugin(file.string(), registry_);
    loaded_.insert(place);
  }

 private:
  TypeRegistry& registry_;
  std::set<fs::path> loaded_;
};

TypeRegistry own_registry() {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  register_solvers(registry);
  register_builtin_plugins(registry);
  register_log_readers(registry);
  return registry;
}

}  // namespace

TypeRegistry make_registry(const CommonOptions& options, const std::vector<std::string>& plugins) {
  TypeRegistry registry = own_registry();
  Loader loader(registry);
  const std::vector<fs::path> folders = plugin_folders();
  for (const std::vector<std::string>* list : {&options.plugins, &plugins}) {
    for (const std::string& wanted : *list) loader.load(find_plugin(wanted, folders));
  }
  const Console console(options);
  for (const fs::path& folder : folders) {
    for (const fs::path& file : modules_in(folder, console)) {
      try {
        loader.load(file);
      } catch (const UsageError& error) {
        console.note("warning: plugin left out: " + std::string(error.what()));
      }
    }
  }
  return registry;
}

TypeRegistry make_registry_for(const std::string& input, const CommonOptions& options) {
  return make_registry(options,
                       is_drive_file(input) ? load_drive_config(input).plugins : std::vector<std::string>());
}

}  // namespace waymark
