#include <waymark/core/base/error.hpp>

#include <new>
#include <utility>

#include <waymark/core/base/guard.hpp>

namespace waymark {

Error::~Error() = default;
UsageError::~UsageError() = default;
InputError::~InputError() = default;
EmptyLogError::~EmptyLogError() = default;
OutputError::~OutputError() = default;

PluginError::PluginError(const std::string& message, std::string type)
    : Error(message), type_(std::move(type)) {}
PluginError::~PluginError() = default;

void throw_plugin_error(const std::string& who, std::string_view type) {
  try {
    throw;
  } catch (const PluginError&) {
    throw;
  } catch (const std::exception& error) {
    const bool names_plugin = who.starts_with("plugin ");  // without one, memory is short for everybody
    if (!names_plugin && dynamic_cast<const std::bad_alloc*>(&error) != nullptr) throw;
    throw PluginError(who + ": threw: " + error.what(), std::string(type));
  } catch (...) {
    throw PluginError(who + ": threw something that is no std::exception", std::string(type));
  }
}

}  // namespace waymark
