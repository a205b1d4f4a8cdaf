#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/csv/csv_log.hpp>
#include <waymark/formats/logs/detail/rtklib/rtklib_pos.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "support/skip.hpp"

namespace rtklib_pos_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
/// 2024-07-20 09:52:30 is second 553950 of GPS week 2323.
constexpr std::int64_t kStart = (2323LL * 604800 + 553950) * kSecond;

const std::string kDegrees =
    "% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp,ns=# of satellites)\n"
    "%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  "
    "sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n";
const std::string kFix =
    "2024/07/20 09:52:30.000   35.165318215  136.881460576    40.2116   5  30   4.0   2.0   5.0   1.5  -1.5 "
    "-1.9 0.00 0.0\n";
const std::string kEcef =
    "%  GPST                      x-ecef(m)      y-ecef(m)      z-ecef(m)   Q  ns   sdx(m)   sdy(m)   sdz(m) "
    " sdxy(m)  sdyz(m)  sdzx(m) age(s)  ratio";
const std::string kBaseline =
    "%  GPST             e-baseline(m)  n-baseline(m)  u-baseline(m)   Q  ns   sde(m)   sdn(m)   sdu(m)  "
    "sden(m)  sdnu(m)  sdue(m) age(s)  ratio\n";

LogData read(const std::string& text, const LogRequest& request = {}) {
  return RtklibPosReader().read(text, "run.pos", request);
}

std::string first_complaint(const std::string& text, const LogRequest& request = {}) {
  const auto decoder = RtklibPosReader().open("run.pos", request);
  decoder->take(text);
  decoder->finish();
  return decoder->data().corrupt_examples.at(0);
}

}  // namespace

TEST_CASE("rtklib_pos: latitude, longitude and height with deviations north first") {
  const LogData data = read(kDegrees + kFix);
  REQUIRE(data.fixes.size() == 1);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.stamp.nanoseconds == kStart);
  CHECK(fix.latitude_deg == 35.165318215);
  CHECK(fix.longitude_deg == 136.881460576);
  CHECK(fix.height_m == 40.2116);
  CHECK(fix.covariance_en(0, 0) == 4);     // sde = 2
  CHECK(fix.covariance_en(1, 1) == 16);    // sdn = 4
  CHECK(fix.covariance_en(0, 1) == 2.25);  // sdne |sdne|
  CHECK(fix.covariance_en(1, 0) == 2.25);
  CHECK(!fix.speed_mps);
  CHECK(fix.line == 3);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"Q5 single", 1}});
  CHECK(data.notes == std::vector<std::string>{"run.pos: solutions by quality: 1 single"});
}

TEST_CASE("rtklib_pos: the scale is the header's and comes out on the one asked for") {
  const auto stamp = [](const std::string& text, TimeScale scale) {
    LogRequest request;
    request.time_scale = scale;
    return read(text, request).fixes.at(0).stamp.nanoseconds;
  };
  const auto with = [](const std::string& scale, const std::string& time) {
    std::string text = kDegrees + kFix;
    text.replace(text.find("GPST"), 4, scale);
    return text.replace(text.find("2024/07/20 09:52:30.000"), 23, time);
  };
  constexpr std::int64_t kPosix = 1'721'469'150 * kSecond;  // date -u -d '2024-07-20 09:52:30' +%s
  CHECK(stamp(with("GPST", "2323 553950.000"), TimeScale::gps) == kStart);
  CHECK(stamp(with("UTC", "2024/07/20 09:52:30.000"), TimeScale::utc) == kPosix);
  CHECK(stamp(with("JST", "2024/07/20 18:52:30.000"), TimeScale::utc) == kPosix);
  CHECK(stamp(with("UTC", "2323 553950.000"), TimeScale::utc) == kPosix);  // weeks of the calendar
  CHECK(stamp(with("UTC", "2024/07/20 09:52:30.000"), TimeScale::gps) == kStart + 18 * kSecond);
  CHECK(stamp(with("GPST", "2024/07/20 09:52:30.123456789"), TimeScale::gps) == kStart + 123'456'789);
  LogRequest request;
  request.time_offset_s = -0.25;
  CHECK(read(kDegrees + kFix, request).fixes.at(0).stamp.nanoseconds == kStart - kSecond / 4);
}

TEST_CASE("rtklib_pos: fields may be separated by commas, and angles be degrees, minutes, seconds") {
  const std::string text =
      "%  "
      "GPST,latitude(d'\"),longitude(d'\"),height(m),Q,ns,sdn(m),sde(m),sdu(m),sdne(m),sdeu(m),sdun(m),age(s)"
      ",ratio\n"
      "2323,553950.000,  -0,30,36.00000, 136,52,53.25800,   40.2116,  1, 12,  0.02,0.01,0.05,0.0,0.0,0.0, "
      "0.00, 3.1\n";
  const LogData data = read(text);
  CHECK(data.fixes.at(0).latitude_deg == Approx(-0.51).epsilon(1e-15));
  CHECK(data.fixes.at(0).longitude_deg == Approx(136 + 52 / 60.0 + 53.258 / 3600).epsilon(1e-15));
  CHECK(data.fixes.at(0).height_m == 40.2116);
  CHECK(data.fixes.at(0).covariance_en(1, 1) == Approx(4e-4));
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"Q1 fix", 1}});
}

TEST_CASE("rtklib_pos: at latitude and longitude 0 the axes x, y, z are up, east, north") {
  const LogData data = read(kEcef +
                            " vx(m/s) vy(m/s) vz(m/s) sdvx sdvy sdvz sdvxy sdvyz sdvzx\n"
                            "2323 553950 6378237 0 0 1 9 3 1 2 0 -1.2 0 0.0 0.0 0.1 3 4 0.3 0.1 0.1 0 0 0\n");
  const GeodeticFix& fix = data.fixes.at(0);
  CHECK(fix.latitude_deg == 0);
  CHECK(fix.longitude_deg == 0);
  CHECK(fix.height_m == Approx(100).margin(1e-8));
  CHECK(fix.covariance_en(0, 0) == Approx(1));      // sdy
  CHECK(fix.covariance_en(1, 1) == Approx(4));      // sdz
  CHECK(fix.covariance_en(0, 1) == Approx(-1.44));  // sdyz
  CHECK(*fix.speed_mps == Approx(5));
  CHECK(*fix.course_rad == Approx(std::atan2(3, 4)));
  CHECK(*fix.speed_sigma_mps == Approx(0.1));
  CHECK(*fix.course_sigma_rad == Approx(0.02));
}

TEST_CASE("rtklib_pos: baselines are added to the reference position of the header") {
  const std::string text = "% ref pos   :   53.809394444  2.129550000    73.0000\n" + kBaseline +
                           "2323 553950 0 0 0 1 9 1 2 3 1.2 0 0 0.0 0.0\n"
                           "2323 553951 0 1000 0 1 9 1 2 3 1.2 0 0 0.0 0.0\n";
  const LogData data = read(text);
  REQUIRE(data.fixes.size() == 2);
  CHECK(data.fixes[0].latitude_deg == Approx(53.809394444).margin(1e-12));
  CHECK(data.fixes[0].height_m == Approx(73).margin(1e-8));
  CHECK(data.fixes[0].covariance_en(0, 0) == Approx(1));
  CHECK(data.fixes[0].covariance_en(1, 1) == Approx(4));
  CHECK(data.fixes[0].covariance_en(0, 1) == Approx(1.44));
  // 1000 m along the meridian, on its radius of curvature M(53.81 deg) = 6,377,103 m plus the height.
  const double sine = std::sin(53.809394444 * std::numbers::pi / 180);
  const double meridian =
      6378137 * (1 - 0.00669437999014) / std::pow(1 - 0.00669437999014 * sine * sine, 1.5);
  CHECK(data.fixes[1].latitude_deg - data.fixes[0].latitude_deg ==
        Approx(1000 / (meridian + 73) * 180 / std::numbers::pi).epsilon(1e-6));
  CHECK(data.fixes[1].longitude_deg == Approx(2.12955).margin(1e-12));

  CHECK_THROWS_MATCHES(
      read(kBaseline + "2323 553950 0 0 0 1 9 1 2 3 1.2 0 0 0.0 0.0\n"), InputError,
      Message("run.pos: the baselines (e/n/u) have no reference position: there is no '% ref pos' "
              "line in degrees above them; let RTKLIB write latitude, longitude and height"));
}

TEST_CASE("rtklib_pos: a solution without fix is counted, heights above the geoid are noted") {
  std::string text = kDegrees + kFix + kFix;
  text.replace(text.find("ellipsoidal"), 11, "geodetic");
  text.replace(text.rfind("   5  30"), 8, "   0  30");
  const LogData data = read(text);
  CHECK(data.fixes.size() == 1);
  CHECK(data.without_fix == 1);
  CHECK(data.notes ==
        std::vector<std::string>{"run.pos: solutions by quality: 1 none, 1 single",
                                 "run.pos: heights are above the geoid ('geodetic' in the header)",
                                 "run.pos: 1 of 2 records are marked as without a fix"});
}

TEST_CASE("rtklib_pos: without a header the default layout is assumed and said") {
  const LogData data = read(kFix);
  CHECK(data.fixes.at(0).stamp.nanoseconds == kStart);
  CHECK(data.notes.at(1) ==
        "run.pos: no header names the columns; assumed are latitude, longitude (degrees), height, "
        "Q, ns and deviations, on GPST");
}

TEST_CASE("rtklib_pos: Q stands in for accuracy, for code after the stated default, and truth needs none") {
  const std::string header = "%  GPST latitude(deg) longitude(deg) height(m) Q ns\n";
  const std::string text = header + "2323 553950.0 35.1 136.8 40.2 5 9\n";
  const GeodeticFix fixed = read(header + "2323 553950.0 35.1 136.8 40.2 1 9\n").fixes.at(0);
  CHECK(fixed.covariance_en(0, 0) == Approx(0.02 * 0.02));
  CHECK(fixed.told.quality == FixQuality::fixed);
  CHECK(fixed.told.satellites == 9);
  CHECK(read(text).fixes.at(0).covariance_en(0, 0) == 9);
  LogRequest request;
  request.default_sigma_m = 3;
  const LogData data = read(text, request);
  CHECK(data.fixes.at(0).covariance_en == 9 * Eigen::Matrix2d::Identity());
  CHECK(data.notes.back() == "run.pos: 1 fixes have no accuracy; the stated default sigma of 3 m is used");
  request.stream = StreamKind::truth;
  request.default_sigma_m = 0;
  CHECK(read(text, request).truth.at(0).latitude_deg == 35.1);
}

TEST_CASE("rtklib_pos: a stated meaning overrides 1 sigma") {
  LogRequest request;
  request.accuracy = AccuracyMeaning::percent95;
  const LogData data = read(kDegrees + kFix, request);
  CHECK(data.fixes.at(0).covariance_en(1, 1) == 4);  // (4 / 2)^2
  CHECK(data.notes.back() == "run.pos: 1 fixes with standard deviations read as 95");
}

TEST_CASE("rtklib_pos: what is wrong with a record is said with its place") {
  const auto replaced = [](const std::string& what, const std::string& with) {
    std::string text = kDegrees + kFix;
    return first_complaint(text.replace(text.rfind(what), what.size(), with));
  };
  CHECK(replaced("0.00 0.0", "0.00") == "run.pos:3:113: expected 15 fields, got 14");
  CHECK(replaced("35.165318215", "35.16x318215") ==
        "run.pos:3:27: latitude: expected a number, got '35.16x318215'");
  CHECK(replaced("35.165318215", "95.165318215") ==
        "run.pos:3:27: latitude: 95.165318215 is outside -90 .. 90");
  CHECK(replaced("   5  30", "  12  30") == "run.pos:3:67: Q: expected a quality 0 .. 7, got '12'");
  CHECK(replaced("09:52:30.000", "09:72:30.000") ==
        "run.pos:3:1: time: expected yyyy/mm/dd hh:mm:ss.sss or a GPS week and its seconds, got '2024/07/20' "
        "'09:72:30.000'");
  CHECK(replaced("1.5  -1.5", "3.0  -1.5") == "run.pos:3:76: the covariance is not positive definite");
  CHECK(replaced("4.0   2.0", "1e9   2.0") == "run.pos:3:76: an accuracy of more than 10,000 km");
  CHECK(replaced("4.0   2.0", "nan   2.0") ==
        "run.pos:3:76: standard deviation: expected a number, got 'nan'");
  CHECK(first_complaint("2323 553950.0 35.1 136.8\n") == "run.pos:1:25: expected at least 7 fields, got 4");
  CHECK(first_complaint(kEcef + "\n2323 553950 0 0 0 1 9 1 2 3 1.2 0 0 0.0 0.0\n") ==
        "run.pos:2:13: the position is 0 km from the centre of the Earth");
  CHECK(first_complaint("%  GPST latitude(d'\") longitude(d'\") height(m) Q ns\n"
                        "2323 553950.0 35 61 0 136 52 53 40.2 1 9\n") ==
        "run.pos:2:15: latitude: minutes or seconds are outside 0 .. 60");
  CHECK(first_complaint(
            "%  GPST latitude(deg) longitude(deg) height(m) Q ns vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu "
            "sdvne sdveu sdvun\n2323 553950.0 35 136 40.2 1 9 1e6 0 0 1 1 1 0 0 0\n") ==
        "run.pos:2:31: velocity: more than 100 km/s");
}

TEST_CASE("rtklib_pos: a request that it cannot meet is refused") {
  LogRequest request;
  request.stream = StreamKind::odometry;
  CHECK_THROWS_MATCHES(
      read(kFix, request), InputError,
      Message("run.pos: an RTKLIB solution holds no odometry; it gives the streams gnss and truth"));
  request.stream = StreamKind::sensor;
  CHECK_THROWS_MATCHES(
      read(kFix, request), InputError,
      Message("run.pos: an RTKLIB solution holds no sensor readings; it gives the streams gnss and truth"));
  request = {};
  request.columns["latitude"] = {};
  CHECK_THROWS_MATCHES(read(kFix, request), InputError,
                       Message("run.pos: an RTKLIB solution has no columns to map; leave out 'columns'"));
  request = {};
  request.companions["dbc"] = {{}};
  CHECK_THROWS_MATCHES(read(kFix, request), InputError,
                       Message("run.pos: an RTKLIB solution takes no 'dbc' file; leave it out"));
}

TEST_CASE("rtklib_pos: pieces of any length give the same") {
  const std::string broken = "2024/07/20 09:52:31.000   35.1\n\n%\n2323 1e99 1 2 3 4 5";
  waymark_test::check_pieces(RtklibPosReader(), kDegrees + kFix + broken + kFix, "run.pos", {});
}

TEST_CASE("rtklib_pos: it is known by the line that names its columns") {
  CHECK(RtklibPosReader().recognise(kDegrees + kFix).certainty == 1);
  CHECK(RtklibPosReader().recognise(kDegrees).evidence ==
        "a header line names the columns of an RTKLIB solution");
  CHECK(RtklibPosReader().recognise("% latitude(deg)\n1 2 3\n").certainty == 0);
  CHECK(RtklibPosReader().recognise("%\n%").certainty == 0);
}

TEST_CASE("rtklib_pos: the real solution of Nagoya agrees with the table made from it") {
  const auto solution = waymark_test::shared_data("logs/pos/taroz_rover_1Hz_spp.pos");
  const auto table = waymark_test::shared_data("drives/nagoya/gnss.csv");
  if (!solution || !table) return;
  const std::string text = read_text_file(*solution);
  const LogData fixes = read(text);
  LogRequest columns;
  columns.gps_week = 2323;
  columns.columns = {{"time", {"gps_tow_s", "", ""}},
                     {"latitude", {"lat_deg", "", ""}},
                     {"longitude", {"lon_deg", "", ""}},
                     {"height", {"h_m", "", ""}},
                     {"sigma_east", {"sde_m", "", ""}},
                     {"sigma_north", {"sdn_m", "", ""}},
                     {"covariance_en_signed_root", {"sdne_m", "", ""}}};
  const LogData expected = CsvLogReader().read(read_text_file(*table), "gnss.csv", columns);
  REQUIRE(fixes.fixes.size() == 1107);
  REQUIRE(expected.fixes.size() == 1107);
  CHECK(fixes.corrupt == 0);
  for (std::size_t i = 0; i < 1107; ++i) {
    const GeodeticFix& a = fixes.fixes[i];
    const GeodeticFix& b = expected.fixes[i];
    CAPTURE(i);
    CHECK(a.stamp == b.stamp);
    CHECK(a.latitude_deg == b.latitude_deg);
    CHECK(a.longitude_deg == b.longitude_deg);
    CHECK(a.height_m == b.height_m);
    CHECK((a.covariance_en - b.covariance_en).cwiseAbs().maxCoeff() <= 1e-12 * b.covariance_en.norm());
  }
  CHECK(RtklibPosReader().recognise(text.substr(0, 65536)).certainty == 1);
}

}  // namespace rtklib_pos_test
