/// The log readers of Waymark, by name.
#pragma once

#include <span>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark::formats {

/// Returns all built-in readers in the order of their listing. They live as long as the program and
/// have no state.
[[nodiscard]] std::span<const LogReaderType> builtin_log_readers();
void register_log_readers(TypeRegistry& registry);
/// Returns null for an unknown name.
[[nodiscard]] const LogReader* builtin_log_reader(std::string_view name);

}  // namespace waymark::formats
