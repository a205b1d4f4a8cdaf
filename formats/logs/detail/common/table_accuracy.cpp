#include <waymark/formats/logs/detail/common/table_accuracy.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/accuracy.hpp>

namespace waymark::formats {

AccuracyQuantities choose_accuracy(const std::function<bool(std::string_view)>& has, const std::string& path,
                                   const LogRequest& request, std::vector<std::string>& notes) {
  if (has("sigma_east") && has("sigma_north"))
    return {"sigma_east", "sigma_north", "covariance_en_signed_root", std::nullopt};
  AccuracyQuantities chosen;
  if (has("accuracy_east") && has("accuracy_north")) {
    chosen = {"accuracy_east", "accuracy_north", {}, AccuracyMeaning::percent95};
  } else if (has("accuracy")) {
    chosen = {"accuracy", "accuracy", {}, AccuracyMeaning::drms};
  } else if (request.default_sigma_m > 0) {
    return {};
  } else {
    throw InputError(
        fmt::format("{}: the fixes have no accuracy: map accuracy, accuracy_east and accuracy_north, or "
                    "sigma_east and sigma_north, or state 'default_sigma' (in metres)",
                    path));
  }
  if (request.accuracy == AccuracyMeaning::automatic)
    notes.push_back(
        fmt::format("{}: accuracy is taken as {} (not stated)", path, to_string(*chosen.usual_meaning)));
  return chosen;
}

StatedAccuracy table_accuracy(double east, double north, double covariance_root,
                              const AccuracyQuantities& quantities) {
  if (!(east > 0 && north > 0)) return {};
  const double common = std::isnan(covariance_root) ? 0 : covariance_root * std::abs(covariance_root);
  Eigen::Matrix2d squares;
  squares << east * east, common, common, north * north;
  return {squares, quantities.usual_meaning};
}

}  // namespace waymark::formats
