/// Packs numbers into short text, because a page may hold a hundred thousand of them.
#pragma once

#include <string>
#include <vector>

namespace waymark::drawing {

/// Returns the step to which `pack` rounds a column. It is a power of ten and at most 1e-7 of the
/// extent of the column (a millimetre in ten kilometres). For whole numbers it is 1.
[[nodiscard]] double packing_step(const std::vector<double>& values);

/// Returns "STEP:BASE64". The bytes are the differences of neighbours in steps, zigzag-encoded (0,
/// -1, 1, -2 ... become 0, 1, 2, 3 ...) plus 1, as varints of Protocol Buffers: seven bits per
/// byte, the lowest first, and the eighth bit says that more follow. A single 0 is a number that is
/// not finite. Coordinates of a drive take two bytes per number.
[[nodiscard]] std::string pack(const std::vector<double>& values);

}  // namespace waymark::drawing
