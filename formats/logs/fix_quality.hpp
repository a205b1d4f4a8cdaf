/// What the quality of a fix is worth where the log gives no accuracy.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include <waymark/core/drive/sample.hpp>

namespace waymark::formats {

/// The sigma of fixes of a quality that neither log nor user gives, per axis. It is multiplied by HDOP, if
/// told, unless carrier phases were used.
struct UsualSigma {
  double sigma_m = 0;  ///< 0: there is none, the user must state one
  bool by_hdop = false;
};
/// fixed 0.02 m, float 0.4 m; single 3 m, differential 1.5 m and dead reckoned 10 m, times HDOP. The others
/// have none.
[[nodiscard]] UsualSigma usual_sigma(FixQuality quality);

/// Returns "120 fixed, 30 float, 2 unknown", from the most frequent on.
[[nodiscard]] std::string quality_counts(const std::map<FixQuality, std::size_t>& counts);

}  // namespace waymark::formats
