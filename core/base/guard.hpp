/// Calls of code that plugins bring: whatever it throws is told with where it came from.
#pragma once

#include <string>
#include <string_view>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Turns the exception that is being handled into a PluginError "who: threw: what". A PluginError is
/// passed on: the inner guard knows more.
/// @param type tag or name of the registered type
[[noreturn]] void throw_plugin_error(const std::string& who, std::string_view type);

/// Calls code of a plugin. The errors of error.hpp are passed on, because plugins throw them too for
/// what users did wrong. Everything else becomes a PluginError, but a lack of memory where `who` names no plugin.
/// @param who returns "plugin 'uwb': sensor 'uwb'"; it is called only for an error
template <typename Who, typename Call>
decltype(auto) guarded(const Who& who, std::string_view type, const Call& call) {
  try {
    return call();
  } catch (const Error&) {
    throw;
  } catch (...) {
    throw_plugin_error(who(), type);
  }
}

}  // namespace waymark
