/// What the name of a column or signal says about what it holds.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace waymark::inspection {

/// What is proposed for a column.
struct ColumnProposal {
  std::string quantity;     ///< of formats/logs/README.md; empty: none
  std::string unit;         ///< empty: the quantity's own
  std::string convention;   ///< empty: the quantity's own
  bool unit_known = false;  ///< by the name; else it is assumed
  std::string remark;       ///< why it needs a look; empty where the name says all
};

/// The words of a name, small letters: "gyro_x_degps", "WheelSpeedFL", "speed [km/h]" are
/// {gyro,x,degps}, {wheel,speed,fl}, {speed,km/h}.
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// Reads the name by a table of known words: first what the name begins with, then its unit and sense.
[[nodiscard]] ColumnProposal propose_quantity(std::string_view name);

}  // namespace waymark::inspection
