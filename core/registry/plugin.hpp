/// The plugin boundary. Each plugin has one constant data symbol, which is read from its file
/// before any of its code runs. plugins/README.md, "ABI and versions", explains the policy behind
/// the numbers.
///
/// The host calls the entry function once for each registry, in one thread. Everything that it
/// registers must stay valid until the process ends: function pointers, LogReader objects, captured
/// data. An entry function may throw waymark::Error; the registry then stays as it was. A plugin
/// must not keep a reference to the registry.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace WAYMARK_EXPORT waymark {

/// Raised if a type that crosses the boundary changes its layout or meaning.
inline constexpr std::uint32_t kPluginAbi = 27;
inline constexpr std::uint32_t kPluginMagic = 0x57415950;  // "WAYP"

/// The properties of a build that decide whether two binaries may share types.
struct BuildTraits {
  std::uint32_t compiler = 0;          ///< 1 GCC family, 2 Clang
  std::uint32_t standard_library = 0;  ///< 1 libstdc++ (new ABI), 2 libstdc++ (old ABI), 3 libc++
  std::uint32_t eigen_version = 0;     ///< world * 10000 + major * 100 + minor
  std::uint32_t eigen_max_align = 0;   ///< bytes; -mavx changes them
  std::uint32_t fast_math = 0;
  std::uint32_t debug_stl = 0;
  /// sizes of the types that cross the boundary, combined into one number
  std::uint32_t layout = 0;
};

/// Returns a number that depends on the size of every type that both sides of the boundary use. It
/// detects headers of another Waymark if somebody forgot to raise kPluginAbi.
constexpr std::uint32_t layout_fingerprint() {
  std::uint32_t mixed = 2166136261u;  // FNV-1a
  for (const std::size_t size : {sizeof(TypeRegistry),
                                 sizeof(Graph),
                                 sizeof(VertexType),
                                 sizeof(EdgeType),
                                 sizeof(EdgeBatchBase),
                                 sizeof(Loss),
                                 sizeof(LossType),
                                 sizeof(Scatter),
                                 sizeof(LinearSolverType),
                                 sizeof(OptionInfo),
                                 sizeof(CheckedOptions),
                                 sizeof(AlgorithmType),
                                 sizeof(Step),
                                 sizeof(NormalEquations),
                                 sizeof(BlockPattern),
                                 sizeof(OdometryModelType),
                                 sizeof(GnssModelingType),
                                 sizeof(GnssInput),
                                 sizeof(OdometryInput),
                                 sizeof(DriveContext),
                                 sizeof(DriveSource),
                                 sizeof(OptionValue),
                                 sizeof(SensorModelType),
                                 sizeof(SensorInput),
                                 sizeof(MeasurementGroups),
                                 sizeof(Fix),
                                 sizeof(Interval),
                                 sizeof(LogReaderType),
                                 sizeof(LogRequest),
                                 sizeof(LogData),
                                 sizeof(StartType),
                                 sizeof(InitialValues)}) {
    mixed = (mixed ^ static_cast<std::uint32_t>(size)) * 16777619u;
  }
  return mixed;
}

/// Returns the traits of the binary that this is compiled into.
constexpr BuildTraits build_traits() {
  BuildTraits traits;
#if defined(__clang__)
  traits.compiler = 2;
#else
  traits.compiler = 1;
#endif
#if defined(_LIBCPP_VERSION)
  traits.standard_library = 3;
#elif defined(_GLIBCXX_USE_CXX11_ABI) && _GLIBCXX_USE_CXX11_ABI
  traits.standard_library = 1;
#else
  traits.standard_library = 2;
#endif
  traits.eigen_version = EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION;
  traits.eigen_max_align = EIGEN_MAX_ALIGN_BYTES;
#if defined(__FAST_MATH__)
  traits.fast_math = 1;
#endif
#if defined(_GLIBCXX_DEBUG)
  traits.debug_stl = 1;
#endif
  traits.layout = layout_fingerprint();
  return traits;
}

/// The content of the symbol `waymark_plugin` of a module. It has no pointers, so it can be read
/// from the file without loading it.
struct PluginDescriptor {
  std::uint32_t magic = kPluginMagic;
  std::uint32_t abi = kPluginAbi;
  BuildTraits traits = build_traits();
  char name[64] = {};
  char version[32] = {};
};

/// Registers the types of a plugin: the symbol `waymark_plugin_enter` of a module. It may throw
/// waymark::Error.
using PluginEntry = void (*)(TypeRegistry& registry);

/// Returns a descriptor of this build. @throws at compile time: a name or version that does not fit
consteval PluginDescriptor describe_plugin(const char* name, const char* version) {
  PluginDescriptor descriptor;
  for (int i = 0; name[i] != 0; ++i) descriptor.name[i] = name[i];
  for (int i = 0; version[i] != 0; ++i) descriptor.version[i] = version[i];
  return descriptor;
}

}  // namespace waymark

/// Defines a plugin: WAYMARK_PLUGIN(gnss_g1, "0.1.0", register_types). In a module
/// (WAYMARK_PLUGIN_MODULE is defined) the symbols are `waymark_plugin` and `waymark_plugin_enter`.
/// In a built-in plugin they end in _NAME, so that one program can hold many.
#if defined(WAYMARK_PLUGIN_MODULE)
#define WAYMARK_PLUGIN_SYMBOL(name) waymark_plugin
#define WAYMARK_PLUGIN_ENTER_SYMBOL(name) waymark_plugin_enter
#else
#define WAYMARK_PLUGIN_SYMBOL(name) waymark_plugin_##name
#define WAYMARK_PLUGIN_ENTER_SYMBOL(name) waymark_plugin_enter_##name
#endif
#define WAYMARK_PLUGIN(name, version, enter)                                                \
  extern "C" __attribute__((visibility("default")))                                         \
  const waymark::PluginDescriptor WAYMARK_PLUGIN_SYMBOL(name);                              \
  constexpr waymark::PluginDescriptor WAYMARK_PLUGIN_SYMBOL(name) =                         \
      waymark::describe_plugin(#name, version);                                             \
  extern "C" __attribute__((visibility("default"))) void WAYMARK_PLUGIN_ENTER_SYMBOL(name)( \
      waymark::TypeRegistry & registry) {                                                   \
    enter(registry);                                                                        \
  }                                                                                         \
  static_assert(true)
