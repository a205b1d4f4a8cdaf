#include <dlfcn.h>

#include <cfenv>

#include <waymark/core/error.hpp>
#include <waymark/core/plugin_loader.hpp>

namespace waymark {
namespace {

void require(bool same, const std::string& place, const std::string& what, const std::string& remedy) {
  if (!same) throw UsageError(place + ": " + what + "; " + remedy);
}

void require_equal(std::uint32_t plugin, std::uint32_t ours, const std::string& place, const char* what) {
  require(plugin == ours, place,
          std::string(what) + " differs (plugin " + std::to_string(plugin) + ", waymark " +
              std::to_string(ours) + ")",
          "build the plugin with the compiler and flags of this waymark");
}

void check_descriptor(const PluginDescriptor& descriptor, const std::string& place) {
  require(descriptor.magic == kPluginMagic, place,
          "is no waymark plugin (its symbol 'waymark_plugin' is something else)",
          "define it with WAYMARK_PLUGIN");
  require_equal(descriptor.abi, kPluginAbi, place, "plugin ABI number");
  const BuildTraits ours = build_traits();
  const BuildTraits& theirs = descriptor.traits;
  require_equal(theirs.compiler, ours.compiler, place, "compiler family (1 GCC, 2 Clang)");
  require_equal(theirs.standard_library, ours.standard_library, place, "standard library");
  require_equal(theirs.eigen_version, ours.eigen_version, place, "Eigen version");
  require_equal(theirs.eigen_max_align, ours.eigen_max_align, place,
                "Eigen maximal alignment (-mavx and the like)");
  require_equal(theirs.fast_math, ours.fast_math, place, "-ffast-math");
  require_equal(theirs.debug_stl, ours.debug_stl, place, "_GLIBCXX_DEBUG");
}

}  // namespace

void enter_plugin(const PluginDescriptor& descriptor, const std::string& place, TypeRegistry& registry) {
  check_descriptor(descriptor, place);
  // Into a copy first: a registration that fails half-way leaves no types behind.
  TypeRegistry extended = registry;
  extended.set_origin(descriptor.name);
  try {
    descriptor.enter(extended);
  } catch (const std::exception& error) {
    throw UsageError(place + ": plugin '" + descriptor.name + "' could not be registered: " + error.what());
  }
  extended.set_origin("waymark");
  registry = std::move(extended);
}

void load_plugin(const std::string& file, TypeRegistry& registry) {
  std::fenv_t environment;
  std::fegetenv(&environment);
  // A bare name would be searched in the system's library folders instead of here.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::fesetenv(&environment);
  if (handle == nullptr) throw UsageError("cannot load plugin: " + std::string(dlerror()));
  const auto* descriptor = static_cast<const PluginDescriptor*>(dlsym(handle, "waymark_plugin"));
  if (descriptor == nullptr) {
    throw UsageError(file +
                     ": is no waymark plugin (no symbol 'waymark_plugin'); define it with WAYMARK_PLUGIN");
  }
  enter_plugin(*descriptor, file, registry);
}

}  // namespace waymark
