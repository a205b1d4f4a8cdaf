#include <dlfcn.h>

#include <algorithm>
#include <cfenv>
#include <cstring>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/detail/module_file.hpp>
#include <waymark/core/registry/detail/module_trial.hpp>
#include <waymark/core/registry/plugin_loader.hpp>

namespace waymark {
namespace {

constexpr const char* kRebuild = "build the plugin with waymark_add_plugin() of this waymark";

[[noreturn]] void refuse(const std::string& place, const std::string& what, const std::string& remedy) {
  throw UsageError(place + ": " + what + "; " + remedy);
}

void require_equal(std::uint32_t plugin, std::uint32_t ours, const std::string& place, const char* what,
                   const char* remedy = kRebuild) {
  if (plugin == ours) return;
  refuse(place,
         std::string(what) + " differs (plugin " + std::to_string(plugin) + ", waymark " +
             std::to_string(ours) + ")",
         remedy);
}

void check_descriptor(const PluginDescriptor& descriptor, const std::string& place) {
  if (descriptor.magic != kPluginMagic)
    refuse(place, "is no waymark plugin (its symbol 'waymark_plugin' is something else)",
           "define it with WAYMARK_PLUGIN");
  require_equal(descriptor.abi, kPluginAbi, place, "plugin ABI number",
                "build the plugin again with the headers of this waymark");
  const BuildTraits ours = build_traits();
  const BuildTraits& theirs = descriptor.traits;
  require_equal(theirs.compiler, ours.compiler, place, "compiler family (1 GCC, 2 Clang)");
  require_equal(theirs.standard_library, ours.standard_library, place, "standard library");
  require_equal(theirs.eigen_version, ours.eigen_version, place, "Eigen version");
  require_equal(theirs.eigen_max_align, ours.eigen_max_align, place, "Eigen maximal alignment",
                "build the plugin without -march=native, -mavx and the like");
  require_equal(theirs.fast_math, ours.fast_math, place, "-ffast-math",
                "build the plugin without -ffast-math and -Ofast");
  require_equal(theirs.debug_stl, ours.debug_stl, place, "_GLIBCXX_DEBUG");
  require_equal(theirs.layout, ours.layout, place, "size of types that cross the boundary",
                "build the plugin again with the headers of this waymark");
}

/// Returns the descriptor as it is in the file.
PluginDescriptor read_descriptor(const std::string& file) {
  const ModuleFile module(file);
  const auto bytes = module.symbol("waymark_plugin");
  if (!bytes)
    refuse(file, "is no waymark plugin (no symbol 'waymark_plugin')", "define it with WAYMARK_PLUGIN");
  // Other versions may have shorter or longer descriptors. The members that are checked first are
  // at the front of all.
  PluginDescriptor descriptor{};
  descriptor.magic = 0;
  std::memcpy(&descriptor, bytes->data(), std::min(bytes->size(), sizeof descriptor));
  descriptor.name[sizeof descriptor.name - 1] = 0;
  descriptor.version[sizeof descriptor.version - 1] = 0;
  check_descriptor(descriptor, file);
  if (module.sets_flush_to_zero())
    refuse(file,
           "was linked with -ffast-math or -Ofast: loading it would flush small numbers to zero everywhere",
           "link the plugin without these flags");
  return descriptor;
}

}  // namespace

void enter_plugin(const PluginDescriptor& descriptor, PluginEntry enter, const std::string& place,
                  TypeRegistry& registry) {
  check_descriptor(descriptor, place);
  // The types are first registered in a copy, so that a registration that fails half-way leaves no
  // types behind.
  TypeRegistry extended = registry;
  extended.set_origin(descriptor.name);
  extended.add_plugin({descriptor.name, descriptor.version, place});
  const std::string who = place + ": plugin '" + descriptor.name + "' could not be registered: ";
  try {
    enter(extended);
  } catch (const std::exception& error) {
    throw UsageError(who + error.what());
  } catch (...) {
    throw UsageError(who + "it threw something that is no std::exception");
  }
  extended.set_origin("waymark");
  registry = std::move(extended);
}

namespace {

void load_module(const std::string& file, const PluginDescriptor& descriptor, TypeRegistry& registry) {
  // The system would search a bare name in its library folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  std::fenv_t environment;
  std::fegetenv(&environment);
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::fesetenv(&environment);  // undoes whatever its start-up code did
  if (handle == nullptr) throw UsageError("cannot load plugin: " + std::string(dlerror()));
  const auto enter = reinterpret_cast<PluginEntry>(dlsym(handle, "waymark_plugin_enter"));
  if (enter == nullptr)
    refuse(file, "is no waymark plugin (no symbol 'waymark_plugin_enter')", "define it with WAYMARK_PLUGIN");
  enter_plugin(descriptor, enter, file, registry);
}

}  // namespace

void load_plugin(const std::string& file, TypeRegistry& registry) {
  const PluginDescriptor descriptor = read_descriptor(file);
  try_in_child(file, [&] {
    TypeRegistry copy = registry;
    load_module(file, descriptor, copy);
  });
  load_module(file, descriptor, registry);
}

}  // namespace waymark
