/// Numbers as short text, for pages that carry a hundred thousand of them.
#pragma once

#include <string>
#include <vector>

namespace waymark::drawing {

/// The step to which `pack` rounds a column: a power of ten, at most 1e-7 of the column's extent (a
/// millimetre in ten kilometres), and 1 for whole numbers.
[[nodiscard]] double packing_step(const std::vector<double>& values);

/// "STEP:BASE64": differences of neighbours in steps, zigzag (0, -1, 1, -2 ... become 0, 1, 2, 3 ...), plus
/// 1, in bytes of seven bits, the lowest first, the eighth saying that more follow (Protocol Buffers'
/// varint); a single 0 is a number that is not finite. Two bytes a number for a drive's coordinates.
[[nodiscard]] std::string pack(const std::vector<double>& values);

}  // namespace waymark::drawing
