/// The log readers that come with Waymark, by name.
#pragma once

#include <span>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark::formats {

/// All built-in readers, in the order to list them. They live as long as the program and are stateless.
[[nodiscard]] std::span<const LogReaderType> builtin_log_readers();
void register_log_readers(TypeRegistry& registry);
/// Null for an unknown name.
[[nodiscard]] const LogReader* builtin_log_reader(std::string_view name);

}  // namespace waymark::formats
