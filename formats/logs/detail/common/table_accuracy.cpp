#include <waymark/formats/logs/detail/common/table_accuracy.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/accuracy.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

struct QualityWord {
  std::string_view word;
  TableQuality quality;
};
constexpr TableQuality kNoFix{FixQuality::unknown, true};
constexpr std::array<QualityWord, 42> kQualityWords{{
    {"none", kNoFix},
    {"nofix", kNoFix},
    {"invalid", kNoFix},
    {"single", {FixQuality::single}},
    {"autonomous", {FixQuality::single}},
    {"gps", {FixQuality::single}},
    {"gnss", {FixQuality::single}},
    {"spp", {FixQuality::single}},
    {"2d", {FixQuality::single}},
    {"3d", {FixQuality::single}},
    {"differential", {FixQuality::differential}},
    {"dgps", {FixQuality::differential}},
    {"dgnss", {FixQuality::differential}},
    {"sbas", {FixQuality::differential}},
    {"waas", {FixQuality::differential}},
    {"egnos", {FixQuality::differential}},
    {"float", {FixQuality::floating}},
    {"rtkfloat", {FixQuality::floating}},
    {"floatrtk", {FixQuality::floating}},
    {"floatingrtk", {FixQuality::floating}},
    {"frtk", {FixQuality::floating}},
    {"ppp", {FixQuality::floating}},
    {"narrowfloat", {FixQuality::floating}},
    {"fixed", {FixQuality::fixed}},
    {"rtk", {FixQuality::fixed}},
    {"rtkfix", {FixQuality::fixed}},
    {"rtkfixed", {FixQuality::fixed}},
    {"fixedrtk", {FixQuality::fixed}},
    {"rtkint", {FixQuality::fixed}},
    {"integer", {FixQuality::fixed}},
    {"narrowint", {FixQuality::fixed}},
    {"dr", {FixQuality::dead_reckoned}},
    {"deadreckoned", {FixQuality::dead_reckoned}},
    {"deadreckoning", {FixQuality::dead_reckoned}},
    {"estimated", {FixQuality::dead_reckoned}},
    {"manual", {FixQuality::manual}},
    {"simulated", {FixQuality::simulated}},
    {"simulator", {FixQuality::simulated}},
    {"simulation", {FixQuality::simulated}},
    {"unknown", {FixQuality::unknown}},
    {"", {FixQuality::unknown}},
    {"nan", {FixQuality::unknown}},
}};

/// Returns the quality of a number of GGA or RTKLIB, where 0 is no fix.
std::optional<TableQuality> of_number(int index, FixQuality (*quality_of)(int)) {
  if (index == 0) return kNoFix;
  const FixQuality quality = quality_of(index);
  return quality == FixQuality::unknown ? std::nullopt : std::optional(TableQuality{quality});
}

/// sensor_msgs/NavSatStatus: -1 no fix, 0 fix, 1 with satellite corrections, 2 with ground corrections. The
/// last is often RTK, but does not say so.
std::optional<TableQuality> of_ros(int index) {
  if (index == -1) return kNoFix;
  if (index == 0) return TableQuality{FixQuality::single};
  return index == 1 || index == 2 ? std::optional(TableQuality{FixQuality::differential}) : std::nullopt;
}

}  // namespace

FixQuality gga_quality(int number) {
  constexpr std::array kQualities{
      FixQuality::unknown,     FixQuality::single,   FixQuality::differential,  FixQuality::single,  // 3: PPS
      FixQuality::fixed,       FixQuality::floating, FixQuality::dead_reckoned, FixQuality::manual,
      FixQuality::simulated,
      FixQuality::differential  // 9: SBAS, in the dialect of NovAtel
  };
  return number > 0 && number < static_cast<int>(kQualities.size())
             ? kQualities[static_cast<std::size_t>(number)]
             : FixQuality::unknown;
}

FixQuality rtklib_quality(int number) {
  // PPP has real-valued ambiguities.
  constexpr std::array kQualities{FixQuality::unknown,      FixQuality::fixed,        FixQuality::floating,
                                  FixQuality::differential, FixQuality::differential, FixQuality::single,
                                  FixQuality::floating,     FixQuality::dead_reckoned};
  return number > 0 && number < static_cast<int>(kQualities.size())
             ? kQualities[static_cast<std::size_t>(number)]
             : FixQuality::unknown;
}

AccuracyQuantities choose_accuracy(const std::function<bool(std::string_view)>& has, const std::string& path,
                                   const LogRequest& request, std::vector<std::string>& notes) {
  if (has("sigma_east") && has("sigma_north"))
    return {"sigma_east", "sigma_north", "covariance_en_signed_root", std::nullopt};
  AccuracyQuantities chosen;
  if (has("accuracy_east") && has("accuracy_north")) {
    chosen = {"accuracy_east", "accuracy_north", {}, AccuracyMeaning::percent95};
  } else if (has("accuracy")) {
    chosen = {"accuracy", "accuracy", {}, AccuracyMeaning::drms};
  } else if (request.default_sigma_m > 0 || has("quality") || (has("hdop") && request.range_error_m > 0)) {
    return {};
  } else {
    throw InputError(fmt::format(
        "{}: the fixes have no accuracy: map accuracy, accuracy_east and accuracy_north, or "
        "sigma_east and sigma_north, or quality, or state 'accuracy: {{default_sigma: ...}}' (in metres)",
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

std::optional<TableQuality> table_quality(std::string_view field, std::string_view code) {
  if (const std::optional<double> number = field_number(field)) {
    if (*number != std::floor(*number)) return std::nullopt;
    const int index = static_cast<int>(std::clamp(*number, -2.0, 100.0));
    if (code == "ros") return of_ros(index);
    return of_number(index, code == "rtklib" ? rtklib_quality : gga_quality);
  }
  std::string word;  // "RTK_Fixed" is "rtkfixed"
  for (const char c : field)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const QualityWord& known : kQualityWords)
    if (word == known.word) return known.quality;
  return std::nullopt;
}

}  // namespace waymark::formats
