/// The error of a file that cannot be read.
#pragma once

#include <string>

namespace waymark::formats {

/// @param error  the value of errno
/// @throws InputError always; the message names the path and the reason
[[noreturn]] void fail_read(const std::string& path, int error);

}  // namespace waymark::formats
