#include <catch2/catch.hpp>

#include <cmath>

#include <waymark/formats/logs/detail/place/geocentric.hpp>

namespace geocentric_test {

using namespace waymark;
using namespace waymark::formats;

TEST_CASE("geocentric: ECEF to geodetic as in EPSG guidance note 7-2, method 9602") {
  const Eigen::Vector3d ecef(3771793.968, 140253.342, 5124304.349);
  const GeodeticPlace place = geodetic_from_ecef(ecef);
  CHECK(place.latitude_deg == Approx(53 + 48 / 60.0 + 33.820 / 3600).margin(1e-8));
  CHECK(place.longitude_deg == Approx(2 + 7 / 60.0 + 46.380 / 3600).margin(1e-8));
  CHECK(place.height_m == Approx(73).margin(1e-3));
  for (const double latitude : {-90.0, -89.9999, -45.0, 0.0, 1e-7, 30.0, 60.0, 90.0}) {
    for (const double height : {-1e5, -100.0, 0.0, 9000.0, 1e6}) {
      const GeodeticPlace back = geodetic_from_ecef(ecef_from_geodetic({latitude, 12, height}));
      CAPTURE(latitude, height);
      CHECK(back.latitude_deg == Approx(latitude).margin(1e-13));
      CHECK(back.height_m == Approx(height).margin(3e-9));
    }
  }
}

}  // namespace geocentric_test
