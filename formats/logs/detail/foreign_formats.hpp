/// Formats that are not read here: how they are recognised, and what makes a log of them that is.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace waymark::formats {

/// Returns "it is a ROS 1 bag, which is not supported; `rostopic echo ...` writes CSV from it" for the first
/// bytes of a log. Empty: it is none of the known foreign formats.
[[nodiscard]] std::optional<std::string> foreign_format(std::string_view head);

}  // namespace waymark::formats
