// Positions that were written wrong: what each slip does to places and ways, and what is said of it.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include <waymark/tools/drive/comparison/plausibility.hpp>
#include <waymark/tools/drive/coordinates/coordinate_slips.hpp>
#include <waymark/types_se2/se2.hpp>

namespace coordinate_slips_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

using Writing = std::function<GeodeticPoint(GeodeticPoint)>;

const Writing kRight = [](GeodeticPoint at) { return at; };
const Writing kExchanged = [](GeodeticPoint at) { return GeodeticPoint{at.longitude_deg, at.latitude_deg}; };
const Writing kNoWest = [](GeodeticPoint at) { return GeodeticPoint{at.latitude_deg, -at.longitude_deg}; };

/// 52 degrees 16.2147 minutes as 52.162147.
double hundredths(double degrees) {
  const double whole = std::trunc(degrees);
  return whole + (degrees - whole) * 0.6;
}
const Writing kMinutes = [](GeodeticPoint at) {
  return GeodeticPoint{hundredths(at.latitude_deg), hundredths(at.longitude_deg)};
};

/// A minute to the north-west of 52.27 north, 3.53 west.
GeodeticPoint place(int second) {
  return {52.27 + 1e-4 * second, -3.53 - 2e-4 * second};
}

std::string said(const Writing& fix_as, const Writing& truth_as) {
  std::vector<GeodeticFix> fixes;
  std::vector<GeodeticTruth> truth;
  for (int k = 0; k < 60; ++k) {
    const GeodeticPoint fix = fix_as(place(k));
    const GeodeticPoint true_place = truth_as(place(k));
    fixes.emplace_back();
    fixes.back().stamp = Stamp::from_seconds(k);
    fixes.back().latitude_deg = fix.latitude_deg;
    fixes.back().longitude_deg = fix.longitude_deg;
    truth.emplace_back();
    truth.back().stamp = Stamp::from_seconds(k);
    truth.back().latitude_deg = true_place.latitude_deg;
    truth.back().longitude_deg = true_place.longitude_deg;
  }
  return warning_of_distance(fixes, truth);
}

}  // namespace

TEST_CASE("coordinates: truth that is kilometres away is told with what was written wrong, and where") {
  CHECK(said(kRight, kRight).empty());
  CHECK(said(kExchanged, kExchanged).empty());
  // 0.004 degrees of latitude, 445 m: a poor start, no slip
  CHECK(said(
            [](GeodeticPoint at) {
              return GeodeticPoint{at.latitude_deg + 0.004, at.longitude_deg};
            },
            kRight)
            .empty());
  CHECK_THAT(said(kExchanged, kRight), EndsWith("in one of them latitude and longitude are exchanged"));
  CHECK_THAT(said(kRight, kMinutes), Contains("in the truth degrees and minutes are read as degrees"));
  // 7.07 degrees of longitude along the parallel of 52.27: 481 km on the great circle
  const std::string west = said(kNoWest, kRight);
  CHECK_THAT(west, StartsWith("the truth is 480.") || StartsWith("the truth is 481."));
  CHECK_THAT(
      west,
      Contains("km from the fixes of its time (median of 60): in one of them the sign of the longitude"));
  CHECK_THAT(said(kMinutes, kRight), Contains("in the fixes degrees and minutes are read as degrees"));
  CHECK_THAT(said(
                 [](GeodeticPoint) {
                   return GeodeticPoint{10, 20};
                 },
                 kRight),
             EndsWith("they are of different drives or frames"));
}

TEST_CASE("coordinates: what is meant is the place, and the way, that was driven") {
  const Writing writings[] = {kExchanged, kNoWest, kNoWest, kMinutes};
  const GeodeticPoint from = place(0);
  const GeodeticPoint to = place(1);
  const auto way = [](GeodeticPoint a, GeodeticPoint b) {
    return Eigen::Vector2d(
        (b.longitude_deg - a.longitude_deg) * std::cos(a.latitude_deg * 0.017453292519943295),
        b.latitude_deg - a.latitude_deg);
  };
  for (const std::size_t i : {0U, 1U, 3U}) {
    const CoordinateSlip& slip = coordinate_slips()[i];
    INFO(slip.words);
    const GeodeticPoint written = writings[i](from);
    CHECK(slip.mended(written).latitude_deg == Approx(from.latitude_deg));
    CHECK(slip.mended(written).longitude_deg == Approx(from.longitude_deg));
    const Eigen::Vector2d meant = mending(slip, written) * way(written, writings[i](to));
    CHECK((meant - way(from, to)).norm() < 1e-3 * way(from, to).norm());
  }
}

TEST_CASE("coordinates: odometry that fits only the mended fixes names the slip") {
  // A winding way of two minutes at 10 m/s, written as fixes near 52.27 north, 10.53 east.
  constexpr double kDegreesPerMetre = 1 / 111'195.0;
  const GeodeticPoint origin{52.27, 10.53};
  const double shrink = std::cos(origin.latitude_deg * 0.017453292519943295);
  const auto warnings = [&](const Writing& as) {
    const GeodeticPoint written = as(origin);
    const double written_shrink = std::cos(written.latitude_deg * 0.017453292519943295);
    std::vector<Fix> fixes;
    std::vector<Eigen::Vector3d> antenna;
    Pose2<double> pose;
    for (int k = 0; k < 120; ++k) {
      const GeodeticPoint at = as({origin.latitude_deg + kDegreesPerMetre * pose.position.y(),
                                   origin.longitude_deg + kDegreesPerMetre * pose.position.x() / shrink});
      Fix fix;
      fix.stamp = Stamp::from_seconds(k);
      fix.position = Eigen::Vector2d((at.longitude_deg - written.longitude_deg) * written_shrink,
                                     at.latitude_deg - written.latitude_deg) /
                     kDegreesPerMetre;
      fixes.push_back(fix);
      antenna.push_back(pose.vector());
      pose = compose(pose, se2_exp<double>(Eigen::Vector3d(10, 0, k / 10 % 2 == 0 ? 0.2 : -0.15)));
    }
    return compare_odometry_with_fixes(fixes, antenna, written).warnings;
  };
  CHECK(warnings(kRight).empty());
  REQUIRE(warnings(kExchanged).size() == 1);
  CHECK_THAT(warnings(kExchanged)[0], Contains("latitude and longitude are exchanged"));
  REQUIRE(warnings(kMinutes).size() == 1);
  // A shorter way has two reasons, and a mirror too.
  CHECK_THAT(warnings(kMinutes)[0], Contains("check the unit of the speed") &&
                                        Contains("unless degrees and minutes are read as degrees"));
  REQUIRE(warnings(kNoWest).size() == 1);
  CHECK_THAT(warnings(kNoWest)[0],
             Contains("state 'convention: cw', unless ") && Contains("the sign of a longitude (W) or"));
}

}  // namespace coordinate_slips_test
