/// Derives the quantity of a column or signal from its name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::inspection {

/// The proposal for a column.
struct ColumnProposal {
  std::string quantity;             ///< as in formats/logs/README.md; empty: none
  std::string unit;                 ///< empty: the default of the quantity
  std::string convention;           ///< empty: the default of the quantity
  bool unit_known = false;          ///< known from the name; else assumed
  std::string remark;               ///< why the user should check it; empty: the name is clear
  double scale = 1;                 ///< as ColumnRequest::scale
  std::optional<double> missing{};  ///< as ColumnRequest::missing
  /// of an accuracy, if its name tells it
  AccuracyMeaning meaning = AccuracyMeaning::automatic;
};

/// Returns the words of a name in small letters: "gyro_x_degps", "WheelSpeedFL", "speed [km/h]"
/// become {gyro,x,degps}, {wheel,speed,fl}, {speed,km/h}.
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// Tells whether a column of this name may tell the receivers of a table apart: "receiver", "antenna_id".
[[nodiscard]] bool names_receiver(std::string_view name);

/// Reads a name with a table of known words: first its beginning, then its unit and sense.
[[nodiscard]] ColumnProposal propose_quantity(std::string_view name);

}  // namespace waymark::inspection
