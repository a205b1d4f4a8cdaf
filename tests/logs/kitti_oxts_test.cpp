// No recording is among the data: records follow oxts/dataformat.txt of KITTI's raw data; the first one is
// the first of drive 2011_09_26_0001 as publications quote it.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/kitti/kitti_oxts.hpp>

#include "logs/log_pieces.hpp"

namespace kitti_oxts_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

const std::string kFirst =
    "49.015003823272 8.4342971002335 116.43032836914 0.035752 0.00903 -2.6087069803847 -6.811441479104 "
    "-11.275641809511 13.172716663769 -0.12475264293164 -0.032919903047354 -0.44519814607457 "
    "0.042957369847256 10.209865300506 -0.34030092211055 -0.31686915378551 10.209117821189 "
    "0.0090951755733632 "
    "-0.023140741253985 -0.017909034508194 0.0089018002187228 -0.022495299354602 -0.018809330937153 "
    "0.027658633371879 "
    "0.012727922061358 4 11 6 6 6\n";
/// Column c holds c, if that is possible.
const std::string kCounting =
    "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 -0.5 2 0.1 4 9 4 4 0\n";
const std::string kTwoStamps = "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074389445\n";

LogRequest request_of(StreamKind stream, const std::string& stamps = kTwoStamps) {
  LogRequest request;
  request.stream = stream;
  request.time_scale = TimeScale::unix_time;
  request.companions["timestamps"] = {{"oxts/timestamps.txt", stamps}};
  return request;
}

LogData read(const std::string& text, const LogRequest& request) {
  return KittiOxtsReader().read(text, "oxts/data", request);
}

std::string first_complaint(const std::string& text, StreamKind stream) {
  return read(kFirst + text, request_of(stream)).corrupt_examples.at(0);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

}  // namespace

TEST_CASE("kitti_oxts by specification: odometry is vf and wu") {
  const LogData data = read(kFirst + kCounting, request_of(StreamKind::odometry));
  REQUIRE(data.odometry.size() == 2);
  // date -u -d '2011-09-26 13:02:25' +%s
  CHECK(data.odometry[0].stamp.nanoseconds == 1'317'042'145'964'389'445);
  CHECK(data.odometry[1].stamp.nanoseconds == 1'317'042'146'074'389'445);
  CHECK(data.odometry[0].speed_mps == 13.172716663769);
  CHECK(data.odometry[0].yaw_rate_radps == -0.018809330937153);
  CHECK(data.odometry[1].speed_mps == 8);
  CHECK(data.odometry[1].yaw_rate_radps == -0.5);
  CHECK(data.kinds == std::map<std::string, std::size_t>{{"navstat 4", 2}});
  CHECK(data.notes == std::vector<std::string>{
                          "oxts/data: the zone of the time stamps is not stated: they are taken as UTC",
                          "oxts/data: speed is vf and yaw rate is wu of an inertial unit that uses GNSS, no "
                          "independent odometry"});
}

TEST_CASE("kitti_oxts by specification: a fix with its accuracies") {
  const LogData data = read(kFirst + kCounting, request_of(StreamKind::gnss));
  REQUIRE(data.fixes.size() == 2);
  const GeodeticFix& fix = data.fixes[0];
  CHECK(fix.latitude_deg == 49.015003823272);
  CHECK(fix.longitude_deg == 8.4342971002335);
  CHECK(fix.height_m == 116.43032836914);
  CHECK(fix.covariance_en(0, 0) == Approx(0.027658633371879 * 0.027658633371879));
  CHECK(fix.covariance_en(0, 1) == 0);
  // The car drives where its nose points: vf and vn, ve agree, and the course with the yaw, to its slip.
  CHECK(*fix.speed_mps == Approx(std::hypot(13.172716663769, 0.12475264293164)).epsilon(1e-4));
  CHECK(*fix.course_rad == Approx(std::acos(-1) / 2 + 2.6087069803847).margin(0.02));
  CHECK(*fix.speed_sigma_mps == Approx(0.012727922061358));
  CHECK(data.fixes[1].covariance_en(1, 1) == 4);
  CHECK(data.notes.back() == "oxts/data: pos_accuracy is taken as 1sigma of each axis (not stated)");
  CHECK(data.fixes[1].line == 2);
}

TEST_CASE("kitti_oxts by specification: truth is position and yaw, counter-clockwise from east") {
  const LogData data = read(kFirst + kCounting, request_of(StreamKind::truth));
  REQUIRE(data.truth.size() == 2);
  CHECK(data.truth[0].latitude_deg == 49.015003823272);
  CHECK(data.truth[0].heading_rad == -2.6087069803847);
  CHECK(data.truth[1].heading_rad == 5);
}

TEST_CASE("kitti_oxts by specification: before the unit has locked there is no fix") {
  const std::string initialising = replaced(kCounting, "0.1 4 9", "0.1 2 9");
  const LogData data = read(kFirst + initialising, request_of(StreamKind::gnss));
  CHECK(data.fixes.size() == 1);
  CHECK(data.without_fix == 1);
  CHECK(data.notes.back() == "oxts/data: 1 of 2 records are marked as without a fix");
}

TEST_CASE("kitti_oxts: every record has its time stamp") {
  CHECK_THROWS_MATCHES(
      read(kFirst, request_of(StreamKind::gnss)), InputError,
      Message("oxts/data: 1 records, but oxts/timestamps.txt has 2 time stamps; each record needs one"));
  CHECK_THROWS_MATCHES(
      read(kFirst + kFirst + kFirst, request_of(StreamKind::gnss)), InputError,
      Message("oxts/data: 3 records, but oxts/timestamps.txt has 2 time stamps; each record needs one"));
  CHECK_THROWS_MATCHES(
      read(kFirst, request_of(StreamKind::gnss, "2011-09-26 13:02:25.9\n13:02\n")), InputError,
      Message("oxts/timestamps.txt:2:1: expected a time stamp like 2011-09-26 13:02:25.964389445, "
              "got '13:02'"));
}

TEST_CASE("kitti_oxts: what is wrong with a record is said with its place, and the next keeps its time") {
  CHECK(first_complaint("1 2 3\n", StreamKind::gnss) == "oxts/data:2:6: expected 30 numbers, got 3");
  CHECK(first_complaint(replaced(kCounting, "6 7 8", "6 7 x"), StreamKind::odometry) ==
        "oxts/data:2:17: vf: expected a number, got 'x'");
  CHECK(first_complaint(replaced(kCounting, "6 7 8", "6 7 800"), StreamKind::odometry) ==
        "oxts/data:2:17: vf: 800 is outside -150 .. 150");
  CHECK(first_complaint(replaced(kCounting, "-0.5 2 0.1", "-0.5 0 0.1"), StreamKind::gnss) ==
        "oxts/data:2:62: the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'");
  const LogData data = read("1 2 3\n" + kFirst, request_of(StreamKind::odometry));
  CHECK(data.odometry.at(0).stamp.nanoseconds == 1'317'042'146'074'389'445);
}

TEST_CASE("kitti_oxts: a request that it cannot meet is refused") {
  LogRequest request;
  CHECK_THROWS_MATCHES(
      read(kFirst, request), InputError,
      Message("oxts/data: a KITTI oxts log holds no time: give its oxts/timestamps.txt as 'timestamps'"));
  request.companions["dbc"] = {{}};
  CHECK_THROWS_MATCHES(read(kFirst, request), InputError,
                       Message("oxts/data: a KITTI oxts log takes no 'dbc' file; leave it out"));
  request.columns["latitude"] = {};
  CHECK_THROWS_MATCHES(read(kFirst, request), InputError,
                       Message("oxts/data: a KITTI oxts log has no columns to map; leave out 'columns'"));
  request.stream = StreamKind::sensor;
  CHECK_THROWS_MATCHES(read(kFirst, request), InputError,
                       Message("oxts/data: a KITTI oxts log holds no sensor readings; it gives the streams "
                               "odometry, gnss and truth"));
}

TEST_CASE("kitti_oxts: pieces of any length give the same") {
  for (const StreamKind stream : {StreamKind::odometry, StreamKind::gnss, StreamKind::truth})
    waymark_test::check_pieces(KittiOxtsReader(), kFirst + "\n1 nan 3", "oxts/data", request_of(stream));
}

TEST_CASE("kitti_oxts: it is known by 30 numbers a line") {
  CHECK(KittiOxtsReader().recognise(kFirst).certainty == 0.9);
  CHECK(KittiOxtsReader().recognise(kFirst + kCounting + kFirst.substr(0, 50)).evidence ==
        "each of its first 2 lines is 30 numbers, the last 5 whole");
  CHECK(KittiOxtsReader().recognise("1 2 3\n").certainty == 0);
  CHECK(KittiOxtsReader().recognise(kFirst + "text\n").certainty == 0);
  CHECK(KittiOxtsReader().recognise("").certainty == 0);
}

}  // namespace kitti_oxts_test
