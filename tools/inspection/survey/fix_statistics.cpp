#include <waymark/tools/inspection/survey/fix_statistics.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/formats/logs/fix_quality.hpp>

namespace waymark::inspection {
namespace {

constexpr double kEarthRadius = 6371008.8;
constexpr double kDegreeLength = kEarthRadius * kDegree;
constexpr double kFar = 1e6;
constexpr double kCellSize = 5;  // degrees
constexpr std::size_t kColumns = 72;
constexpr std::size_t kRows = 36;
constexpr std::size_t kRunLength = 5;
constexpr double kMoving = 1;  // m/s
/// Steps of positions in degrees that tables and receivers use: decimals of degrees and of minutes,
/// coarser first.
constexpr std::array<double, 6> kSteps{1e-2, 1e-3, 1e-2 / 60, 1e-4, 1e-3 / 60, 1e-5};

bool multiple_of(double degrees, double step) {
  const double steps = degrees / step;
  return std::abs(steps - std::round(steps)) < 1e-4;
}

std::size_t cell_of(double latitude, double longitude) {
  const double wrapped = longitude - 360 * std::floor((longitude + 180) / 360);
  const auto row = static_cast<std::size_t>(std::clamp((latitude + 90) / kCellSize, 0.0, kRows - 1.0));
  const auto column = static_cast<std::size_t>(std::clamp((wrapped + 180) / kCellSize, 0.0, kColumns - 1.0));
  return row * kColumns + column;
}

void join(Range& range, const Range& other) {
  range.count += other.count;
  range.smallest = std::min(range.smallest, other.smallest);
  range.largest = std::max(range.largest, other.largest);
}

SigmaSummary summary_of(const Quantiles& sigma, const Range& range) {
  return {sigma.median(), sigma.quantile(0.95), range};
}

}  // namespace

double distance_m(double latitude_a, double longitude_a, double latitude_b, double longitude_b) {
  const double north = std::sin((latitude_b - latitude_a) * kDegree / 2);
  const double east = std::sin((longitude_b - longitude_a) * kDegree / 2);
  const double chord =
      north * north + std::cos(latitude_a * kDegree) * std::cos(latitude_b * kDegree) * east * east;
  return 2 * kEarthRadius * std::asin(std::sqrt(std::min(1.0, chord)));
}

double BoundingBox::height_m() const {
  return latitude.count == 0 ? 0 : (latitude.largest - latitude.smallest) * kDegreeLength;
}

double BoundingBox::width_m() const {
  if (longitude.count == 0) return 0;
  const double middle = (latitude.largest + latitude.smallest) / 2;
  return (longitude.largest - longitude.smallest) * kDegreeLength * std::cos(middle * kDegree);
}

FixStatistics::FixStatistics() : cells_(kRows * kColumns) {
  decimal_step_.fill(true);
}

void FixStatistics::add(const GeodeticFix& fix) {
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg)) return;
  ++summary_.fixes;
  summary_.stamps.add(fix.stamp, fix.line);
  if (fix.speed_mps) {
    ++summary_.with_speed;
    summary_.speed.add(*fix.speed_mps);
  }
  if (fix.course_rad) ++summary_.with_course;
  if (std::isfinite(fix.height_m)) summary_.height.add(fix.height_m);
  add_accuracy(fix);
  if (std::abs(fix.latitude_deg) < 1e-6 && std::abs(fix.longitude_deg) < 1e-6) {
    summary_.zero.see(fix.line, fix.stamp);
    return;
  }
  add_place(fix);
  add_way(fix);
  compare_speed(fix);
  last_ = fix;
}

void FixStatistics::add_place(const GeodeticFix& fix) {
  Cell& cell = cells_[cell_of(fix.latitude_deg, fix.longitude_deg)];
  if (cell.count++ == 0) {
    cell.line = fix.line;
    cell.stamp = fix.stamp;
  }
  cell.box.latitude.add(fix.latitude_deg);
  cell.box.longitude.add(fix.longitude_deg);
  latitudes_.add(fix.latitude_deg);
  longitudes_.add(fix.longitude_deg);
  for (std::size_t i = 0; i < kSteps.size(); ++i)
    decimal_step_[i] = decimal_step_[i] && multiple_of(fix.latitude_deg, kSteps[i]) &&
                       multiple_of(fix.longitude_deg, kSteps[i]);
}

void FixStatistics::add_way(const GeodeticFix& fix) {
  const bool same =
      last_ && last_->latitude_deg == fix.latitude_deg && last_->longitude_deg == fix.longitude_deg;
  if (!same) {
    end_run();
    run_ = 0;
    run_moving_ = 0;
    run_line_ = fix.line;
    run_stamp_ = fix.stamp;
  } else {
    ++summary_.repeated;
  }
  ++run_;
  if (fix.speed_mps && std::abs(*fix.speed_mps) > kMoving) ++run_moving_;
  if (!last_ || same) return;
  const double way =
      distance_m(last_->latitude_deg, last_->longitude_deg, fix.latitude_deg, fix.longitude_deg);
  if (way < kFar) summary_.distance_m += way;
}

void FixStatistics::end_run() {
  if (run_ < kRunLength) return;
  summary_.frozen.see(run_line_, run_stamp_, static_cast<double>(run_));
  summary_.repeated_in_frozen += run_ - 1;
  if (run_moving_ >= kRunLength) summary_.frozen_moving.see(run_line_, run_stamp_, static_cast<double>(run_));
}

void FixStatistics::add_accuracy(const GeodeticFix& fix) {
  const Eigen::Matrix2d& covariance = fix.covariance_en;
  const double east = std::sqrt(covariance(0, 0));
  const double north = std::sqrt(covariance(1, 1));
  ++summary_.qualities[fix.told.quality];
  if (fix.told.satellites >= 0) summary_.satellites.add(fix.told.satellites);
  if (fix.told.hdop > 0) summary_.hdop.add(fix.told.hdop);
  if (fix.told.correction_age_s >= 0) summary_.correction_age_s.add(fix.told.correction_age_s);
  if (!(east < 0.9999 * kNoAccuracy)) {
    ++summary_.without_accuracy[fix.told.quality];
    return;
  }
  const bool equal = std::abs(east - north) <= 1e-9 * east && covariance(0, 1) == 0;
  if (summary_.with_accuracy++ == 0) {
    summary_.axes_equal = summary_.accuracy_constant = true;
    first_variance_ = covariance(0, 0) + 2 * covariance(1, 1);
  }
  summary_.axes_equal = summary_.axes_equal && equal;
  summary_.accuracy_constant =
      summary_.accuracy_constant && covariance(0, 0) + 2 * covariance(1, 1) == first_variance_;
  sigma_east_.add(east);
  sigma_north_.add(north);
  summary_.east.range.add(east);
  summary_.north.range.add(north);
}

/// Compares over at least one second, because at higher rates the noise of positions would show.
void FixStatistics::compare_speed(const GeodeticFix& fix) {
  const double seconds = anchor_ ? fix.stamp.seconds() - anchor_->stamp.seconds() : 0;
  if (anchor_ && seconds >= 0 && seconds < 0.99) return;
  if (anchor_ && seconds > 0 && seconds < 3 && fix.speed_mps && anchor_->speed_mps) {
    const double way =
        distance_m(anchor_->latitude_deg, anchor_->longitude_deg, fix.latitude_deg, fix.longitude_deg);
    const double stated = (std::abs(*fix.speed_mps) + std::abs(*anchor_->speed_mps)) / 2;
    if (way / seconds > 2 && stated > 0.2) speed_factors_.add(stated * seconds / way);
  }
  anchor_ = fix;
}

std::size_t fixes_with_usual_sigma(const FixSummary& fixes) {
  std::size_t sum = 0;
  for (const auto& [quality, count] : fixes.without_accuracy)
    if (formats::usual_sigma(quality).sigma_m > 0) sum += count;
  return sum;
}

std::string usual_sigmas(const FixSummary& fixes) {
  std::string text;
  for (const auto& [quality, count] : fixes.without_accuracy) {
    const formats::UsualSigma usual = formats::usual_sigma(quality);
    if (usual.sigma_m > 0)
      text += fmt::format("{}{} {} m{}", text.empty() ? "" : ", ", to_string(quality), usual.sigma_m,
                          usual.by_hdop && fixes.hdop.count > 0 ? " x HDOP" : "");
  }
  return text;
}

namespace {

/// Returns longitudes less or plus a full turn, so that they are near a place beyond 180 degrees too.
Range turned_to(double place_deg, Range longitudes) {
  const double middle = (longitudes.smallest + longitudes.largest) / 2;
  const double turns = 360 * std::round((place_deg - middle) / 360);
  longitudes.smallest += turns;
  longitudes.largest += turns;
  return longitudes;
}

}  // namespace

FixSummary FixStatistics::summary() const {
  FixStatistics done = *this;
  done.end_run();
  FixSummary result = done.summary_;
  result.east = summary_of(sigma_east_, result.east.range);
  result.north = summary_of(sigma_north_, result.north.range);
  result.speed_comparisons = speed_factors_.count();
  result.speed_factor = speed_factors_.median();
  const double latitude = latitudes_.median();
  const double longitude = longitudes_.median();
  std::size_t places = 0;
  for (const Cell& cell : cells_) {
    if (cell.count == 0) continue;
    const double away =
        distance_m(latitude, longitude, (cell.box.latitude.smallest + cell.box.latitude.largest) / 2,
                   (cell.box.longitude.smallest + cell.box.longitude.largest) / 2);
    if (away > kFar) {
      const bool first = result.far.count == 0 || cell.line < result.far.line;
      if (first) result.far = {result.far.count, cell.line, cell.stamp, away};
      result.far.count += cell.count;
      continue;
    }
    places += cell.count;
    join(result.box.latitude, cell.box.latitude);
    join(result.box.longitude, turned_to(longitude, cell.box.longitude));
  }
  const bool moves = result.box.height_m() + result.box.width_m() > 0 && places >= 20;
  for (std::size_t i = 0; moves && i < kSteps.size() && result.resolution_m == 0; ++i) {
    if (decimal_step_[i]) result.resolution_m = kSteps[i] * kDegreeLength;
  }
  return result;
}

}  // namespace waymark::inspection
