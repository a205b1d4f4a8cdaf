#include <algorithm>
#include <cctype>
#include <map>

#include <waymark/tools/report/words.hpp>

namespace waymark::report {

std::string edge_name(const std::string& tag) {
  static const std::map<std::string, std::string> kNames = {
      {"EDGE_SE2_ODOMETRY", "odometry"},
      {"EDGE_SE2_ODOMETRY_CALIBRATED", "odometry, calibrated"},
      {"EDGE_SE2_ODOMETRY_YAW_CALIBRATED", "odometry, yaw calibrated"},
      {"EDGE_SE2_ODOMETRY_YAW_SCALED", "odometry, yaw scaled"},
      {"EDGE_SE2_TWIST", "odometry, twist"},
      {"EDGE_SE2_STANDSTILL", "standstill"},
      {"EDGE_GNSS_POSITION", "GNSS position"},
      {"EDGE_GNSS_POSITION_CORRELATED", "GNSS position, lasting errors"},
      {"EDGE_GNSS_POSITION_LATE", "GNSS position, delayed"},
      {"EDGE_GNSS_COURSE", "GNSS course"},
      {"EDGE_GNSS_SPEED", "GNSS speed"},
      {"EDGE_GNSS_BIAS_BETWEEN", "GNSS lasting error, step"},
      {"EDGE_GNSS_BIAS_DECAY", "GNSS lasting error, decay"},
      {"EDGE_GNSS_MULTIPATH_BETWEEN", "GNSS multipath, step"},
      {"EDGE_GNSS_MULTIPATH_DECAY", "GNSS multipath, decay"},
      {"EDGE_SE2_XY", "position"},
      {"EDGE_SE2", "relative pose"},
      {"EDGE_SE2_LOG", "relative pose (logarithm)"},
      {"EDGE_PRIOR_SE2", "prior of a pose"},
      {"EDGE_PRIOR_SE2_XY", "prior of a position"},
  };
  if (const auto found = kNames.find(tag); found != kNames.end()) return found->second;
  std::string name = tag.starts_with("EDGE_") ? tag.substr(5) : tag;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(c == '_' ? ' ' : std::tolower(c)); });
  return name;
}

std::vector<std::pair<std::string, std::string>> glossary() {
  return {
      {"RMSE", "root mean square error: the root of the mean squared distance from the truth"},
      {"GNSS", "satellite navigation: GPS, Galileo, GLONASS, BeiDou"},
      {"raw GNSS", "the positions of the receiver as they were logged"},
      {"NIS",
       "normalised innovation squared: squared distance of a fix from its prediction, in units of the "
       "covariance that it should have"},
      {"NEES",
       "normalised estimation error squared: squared error against truth, in units of the stated covariance"},
      {"sigma", "standard deviation: 68 % of errors along one axis are smaller"},
      {"chi2",
       "sum of all squared residuals in units of their stated noise; the optimiser makes it smallest"},
      {"Acc", "length of the mean error: the constant offset"},
      {"Prec", "standard deviation of the errors about their mean"},
      {"CEP50", "radius about the truth that holds half of the positions"},
      {"CEP95", "radius about the truth that holds 95 % of the positions"},
      {"fix", "one position reading of a receiver"},
      {"odometry", "motion from the vehicle itself: wheels, steering, yaw rate"},
      {"Odometry", "motion from the vehicle itself: wheels, steering, yaw rate"},
      {"dead reckoning", "following the odometry alone from the last fix that was used"},
      {"gate", "the test that rejects implausible fixes before the fusion"},
      {"antenna", "the point that GNSS measures; its place on the vehicle is the lever arm"},
      {"body point", "the point of the vehicle whose positions are told"},
      {"whitened", "divided by the stated noise, so that 1 is one sigma"},
      {"Whitened", "divided by the stated noise, so that 1 is one sigma"},
      {"marginal covariances", "the stated uncertainty of single poses, with all others unknown"},
      {"marginal covariance", "the stated uncertainty of one value, with all others unknown"},
      {"loss", "a function that takes weight from measurements that fit badly"},
      {"prior", "what is known of a value before the drive"},
      {"initial guess", "the values from which the optimiser begins"},
      {"HDOP", "horizontal dilution of precision: how much the geometry of the satellites enlarges errors"},
      {"RPE", "relative pose error: error of the motion over a distance, wherever it begins"},
  };
}

}  // namespace waymark::report
