/// The plugin boundary: one constant data symbol per plugin, read before any of its code runs.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <waymark/core/registry.hpp>

namespace waymark {

/// Raised whenever a type that crosses the boundary changes its layout or meaning.
inline constexpr std::uint32_t kPluginAbi = 1;
inline constexpr std::uint32_t kPluginMagic = 0x57415950;  // "WAYP"

/// How a binary was built, as far as it decides whether two binaries may share types.
struct BuildTraits {
  std::uint32_t compiler = 0;          ///< 1 GCC family, 2 Clang
  std::uint32_t standard_library = 0;  ///< 1 libstdc++ (new ABI), 2 libstdc++ (old ABI), 3 libc++
  std::uint32_t eigen_version = 0;     ///< world * 10000 + major * 100 + minor
  std::uint32_t eigen_max_align = 0;   ///< bytes; -mavx changes it
  std::uint32_t fast_math = 0;
  std::uint32_t debug_stl = 0;
};

/// The traits of the binary this is compiled into.
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
  return traits;
}

/// What the symbol `waymark_plugin` of a module holds. Plain data; `enter` is called only after all else was
/// checked.
struct PluginDescriptor {
  std::uint32_t magic;
  std::uint32_t abi;
  BuildTraits traits;
  const char* name;
  const char* version;
  void (*enter)(TypeRegistry& registry);  ///< registers the plugin's types; may throw waymark::Error
};

}  // namespace waymark

/// Defines a plugin: WAYMARK_PLUGIN(gnss_g1, "0.1.0", register_types). Compiled into a module
/// (WAYMARK_PLUGIN_MODULE defined) the symbol is `waymark_plugin`; built in, it is `waymark_plugin_NAME`, so
/// that many fit in one program.
#if defined(WAYMARK_PLUGIN_MODULE)
#define WAYMARK_PLUGIN_SYMBOL(name) waymark_plugin
#else
#define WAYMARK_PLUGIN_SYMBOL(name) waymark_plugin_##name
#endif
#define WAYMARK_PLUGIN(name, version, enter)                      \
  extern "C" __attribute__((visibility("default")))               \
  const waymark::PluginDescriptor WAYMARK_PLUGIN_SYMBOL(name);    \
  const waymark::PluginDescriptor WAYMARK_PLUGIN_SYMBOL(name) = { \
      waymark::kPluginMagic, waymark::kPluginAbi, waymark::build_traits(), #name, version, enter}
