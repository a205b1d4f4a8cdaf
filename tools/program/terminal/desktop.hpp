/// The desktop that the program was started on, if there is one.
#pragma once

#include <string>

namespace waymark::program {

/// Opens a file with the program that the desktop has chosen for its kind (`xdg-open`), and does not
/// wait for that program to end.
/// @param path absolute
/// @return false if there is no desktop (neither DISPLAY nor WAYLAND_DISPLAY is set), no `xdg-open`,
/// or if that reports within 3 s that it cannot open the file
[[nodiscard]] bool open_on_desktop(const std::string& path);

}  // namespace waymark::program
