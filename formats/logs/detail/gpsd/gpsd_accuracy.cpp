#include <waymark/formats/logs/detail/gpsd/gpsd_accuracy.hpp>

#include <charconv>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/accuracy.hpp>

namespace waymark::formats {
namespace {

struct Release {
  int major = 0;
  int minor = 0;

  friend constexpr auto operator<=>(const Release&, const Release&) = default;
};

/// Reads the numbers before and after the first point of "3.22" or "3.20.1~dev". Empty for
/// anything else.
std::optional<Release> release_from(const std::string& text) {
  Release release;
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, release.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, release.minor);
  if (minor.ec != std::errc()) return std::nullopt;
  return release;
}

constexpr Release kRawAccuracySince{3, 11};
constexpr Release kDilutionSince{3, 19};

}  // namespace

StatedAccuracy GpsdAccuracy::of(const GpsdReport& report, const GpsdReport* gst, AccuracyMeaning stated) {
  const bool radial_first = stated == AccuracyMeaning::drms || stated == AccuracyMeaning::cep50;
  if (stated == AccuracyMeaning::automatic && gst != nullptr) {
    if (const auto measured = covariance_from_gst(*gst)) return {measured, std::nullopt};
  }
  const double east = report.number(GpsdNumber::epx).value_or(0);
  const double north = report.number(GpsdNumber::epy).value_or(0);
  const double radial = report.number(GpsdNumber::eph).value_or(0);
  const bool per_axis = is_accuracy(east) && is_accuracy(north);

  if (per_axis && !(radial_first && is_accuracy(radial))) {
    ++per_axis_;
    if (east == north) ++per_axis_equal_;
    per_axis_sum_m_ += (east + north) / 2;
    if (is_accuracy(radial)) {
      ++per_axis_with_radial_;
      radial_sum_m_ += radial;
    }
    return {Eigen::Vector2d(east * east, north * north).asDiagonal().toDenseMatrix(),
            AccuracyMeaning::percent95};
  }
  if (!is_accuracy(radial)) return {};
  ++radial_;
  return {radial * radial * Eigen::Matrix2d::Identity(), AccuracyMeaning::drms};
}

std::optional<Eigen::Matrix2d> GpsdAccuracy::covariance_from_gst(const GpsdReport& gst) {
  const double east = gst.number(GpsdNumber::lon).value_or(0);
  const double north = gst.number(GpsdNumber::lat).value_or(0);
  if (!is_accuracy(east) || !is_accuracy(north)) return std::nullopt;
  ++from_gst_;
  const double major = gst.number(GpsdNumber::major).value_or(0);
  const double minor = gst.number(GpsdNumber::minor).value_or(0);
  const std::optional<double> orientation = gst.number(GpsdNumber::orient);
  double common = 0;
  if (is_accuracy(major) && is_accuracy(minor) && orientation) {
    if (const auto correlation = ellipse_correlation(east, north, major, minor, *orientation)) {
      ++from_ellipse_;
      common = *correlation * east * north;
    }
  }
  return (Eigen::Matrix2d() << east * east, common, common, north * north).finished();
}

std::vector<std::string> GpsdAccuracy::notes(const std::string& release, AccuracyMeaning meaning) const {
  std::vector<std::string> notes;
  const bool automatic = meaning == AccuracyMeaning::automatic;
  const std::string stated(to_string(meaning));
  if (from_gst_ > 0)
    notes.push_back(
        fmt::format("{} fixes with a GST object, whose errors are 1 sigma; {} of them with the correlation "
                    "of its error ellipse",
                    from_gst_, from_ellipse_));
  if (per_axis_ > 0) {
    notes.push_back(fmt::format("gpsd {}: {} fixes with epx and epy read as {}",
                                release.empty() ? "of unknown version" : release, per_axis_,
                                automatic ? "95 (not stated)" : stated));
    if (automatic) {
      if (const std::string text = dialect(release); !text.empty()) notes.push_back(text);
    }
  }
  if (radial_ > 0)
    notes.push_back(
        fmt::format("{} fixes with eph read as {}", radial_, automatic ? "drms (not stated)" : stated));
  return notes;
}

/// Returns a sentence: the meaning of epx and epy that version and values indicate, and the setting
/// that would fit. Empty if they indicate nothing.
std::string GpsdAccuracy::dialect(const std::string& release) const {
  const std::optional<Release> version = release_from(release);
  const double figure = per_axis_sum_m_ / static_cast<double>(per_axis_);
  const double read = sigma_factor(AccuracyMeaning::percent95) * figure;
  if (version && *version < kRawAccuracySince)
    return fmt::format(
        "epx and epy of gpsd before 3.11 are the 3-D accuracy / sqrt(2), a rough 1sigma: sigma would be "
        "{:.3g} m on average instead of {:.3g} m",
        figure, read);
  const bool all_equal = per_axis_equal_ == per_axis_;
  if (all_equal && (!version || *version < kDilutionSince))
    return fmt::format(
        "epx equals epy throughout: gpsd 3.11 to 3.18 reports u-blox' hAcc unchanged; read it with "
        "'drms': sigma would be {:.3g} m on average instead of {:.3g} m",
        sigma_factor(AccuracyMeaning::drms) * figure, read);
  if (per_axis_with_radial_ > 0 && (!version || *version >= kDilutionSince))
    return fmt::format(
        "epx and epy come from the dilution of precision (gpsd since 3.19); eph is the receiver's "
        "own accuracy, if it states one; read it with 'drms': sigma would be {:.3g} m on average "
        "instead of {:.3g} m",
        sigma_factor(AccuracyMeaning::drms) * radial_sum_m_ / static_cast<double>(per_axis_with_radial_),
        read);
  return {};
}

}  // namespace waymark::formats
