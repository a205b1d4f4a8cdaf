/// What a table tells of the accuracy and the quality of fixes. Columns and CAN signals use the same rules.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>

namespace waymark::formats {

/// The names of these quantities; empty: none.
struct AccuracyQuantities {
  std::string_view east, north, covariance_root;
  std::optional<AccuracyMeaning> usual_meaning;  ///< as in StatedAccuracy
};

/// Chooses sigma_east and sigma_north if the table has both; they are 1 sigma, even if the request
/// states another meaning. Otherwise it chooses accuracy_east and accuracy_north (95 unless
/// stated), otherwise accuracy (drms unless stated). A note names a meaning that was not stated.
/// @param has tells whether the table holds a quantity
/// @throws InputError if the table has none of them, no default sigma is stated, and neither a quality nor
/// HDOP can stand in
[[nodiscard]] AccuracyQuantities choose_accuracy(const std::function<bool(std::string_view)>& has,
                                                 const std::string& path, const LogRequest& request,
                                                 std::vector<std::string>& notes);

/// Returns the accuracy of one record. @param east, north, covariance_root its values of the
/// quantities; NaN: none. `covariance_root` is the signed root of the covariance.
[[nodiscard]] StatedAccuracy table_accuracy(double east, double north, double covariance_root,
                                            const AccuracyQuantities& quantities);

/// Returns the quality of a number of NMEA's GGA; unknown for 0 (no fix) and other numbers.
[[nodiscard]] FixQuality gga_quality(int number);
/// Returns the quality of RTKLIB's Q; unknown for 0 (no fix) and other numbers.
[[nodiscard]] FixQuality rtklib_quality(int number);

/// What a column tells of a fix.
struct TableQuality {
  FixQuality quality = FixQuality::unknown;
  bool no_fix = false;
};
/// Returns the quality of a word ("fixed", "RTK float", "DGPS", "single", "none", ...), or of a number of a
/// code: "gga", "rtklib" or "ros" (units of Quantity `quality`). Empty for anything else.
[[nodiscard]] std::optional<TableQuality> table_quality(std::string_view field, std::string_view code);

}  // namespace waymark::formats
