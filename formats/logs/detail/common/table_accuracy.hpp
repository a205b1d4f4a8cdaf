/// Which quantities of a table tell the accuracy of its fixes; the same for columns and for CAN signals.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>

namespace waymark::formats {

/// Names of quantities; empty: none.
struct AccuracyQuantities {
  std::string_view east, north, covariance_root;
  std::optional<AccuracyMeaning> usual_meaning;  ///< as in StatedAccuracy
};

/// sigma_east and sigma_north where the table has both, which are 1 sigma whatever the request says; else
/// accuracy_east and accuracy_north (95, unless stated), else accuracy (drms, unless stated). An unstated
/// meaning is noted.
/// @param has  whether the table holds a quantity
/// @throws InputError where there are none of them and no default sigma is stated
[[nodiscard]] AccuracyQuantities choose_accuracy(const std::function<bool(std::string_view)>& has,
                                                 const std::string& path, const LogRequest& request,
                                                 std::vector<std::string>& notes);

/// What a record says. @param east, north, covariance_root  its values of the quantities, NaN: none.
/// `covariance_root` is the signed root of the covariance.
[[nodiscard]] StatedAccuracy table_accuracy(double east, double north, double covariance_root,
                                            const AccuracyQuantities& quantities);

}  // namespace waymark::formats
