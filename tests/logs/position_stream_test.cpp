#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>

namespace position_stream_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The error for a fix with this accuracy; "taken" if there is none.
std::string said_of(const StatedAccuracy& accuracy, const LogRequest& request = {},
                    const FixDetails& told = {}) {
  LogData data;
  PositionStream positions("log", request, "figures");
  GeodeticFix fix;
  fix.told = told;
  const char* complaint = positions.add(data, fix, accuracy);
  CHECK(data.fixes.size() + data.truth.size() == (complaint == nullptr ? 1 : 0));
  return complaint == nullptr ? "taken" : complaint;
}

StatedAccuracy squares(double east, double north, double common = 0) {
  return {.squares_en = (Eigen::Matrix2d() << east, common, common, north).finished()};
}

}  // namespace

TEST_CASE("positions: figures mean what is stated, else what they usually do, else what they are") {
  const auto variance = [](AccuracyMeaning stated, std::optional<AccuracyMeaning> usual) {
    LogRequest request;
    request.accuracy = stated;
    PositionStream positions("log", request, "figures");
    GeodeticFix fix;
    StatedAccuracy accuracy = squares(16, 16);
    accuracy.usual_meaning = usual;
    REQUIRE(positions.set_covariance(fix, accuracy) == nullptr);
    return fix.covariance_en(0, 0);
  };
  CHECK(variance(AccuracyMeaning::automatic, AccuracyMeaning::drms) == 8);
  CHECK(variance(AccuracyMeaning::automatic, AccuracyMeaning::one_sigma) == 16);
  CHECK(variance(AccuracyMeaning::percent95, AccuracyMeaning::drms) == 4);
  CHECK(variance(AccuracyMeaning::percent95, std::nullopt) == 16);
}

TEST_CASE("positions: what no accuracy can be is complained of") {
  CHECK(said_of(squares(4, 9, 5.9)) == "taken");
  CHECK(said_of(squares(4, 9, 6)) == "the covariance is not positive definite");
  CHECK(said_of(squares(0, 9)) == "the covariance is not positive definite");
  CHECK(said_of(squares(4, kNan)) == "the covariance is not positive definite");
  CHECK(said_of(squares(kNan, 4)) == "the covariance is not positive definite");
  CHECK(said_of(squares(1.1e14, 4)) == "an accuracy of more than 10,000 km");
  CHECK(said_of({}) == "the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'");
  CHECK(said_of({}, {}, {.hdop = 2}) ==
        "the log has no accuracy but HDOP: state 'range_error', which is multiplied by "
        "HDOP, or 'accuracy: {default_sigma: ...}'");
  LogRequest request;
  request.range_error_m = 4;
  CHECK(said_of({}, request, {.hdop = 2}) == "taken");
  CHECK(said_of({}, request, {.hdop = 1e300}) == "an accuracy of more than 10,000 km");
  request.stream = StreamKind::truth;
  CHECK(said_of({}, request) == "taken");
}

namespace {

struct Given {
  double sigma_m;
  bool claimed;
};
Given sigma_of(const FixDetails& told, const LogRequest& request = {}) {
  PositionStream positions("log", request, "figures");
  GeodeticFix fix;
  fix.told = told;
  REQUIRE(positions.set_covariance(fix, {}) == nullptr);
  CHECK(fix.covariance_en(0, 0) == fix.covariance_en(1, 1));
  return {std::sqrt(fix.covariance_en(0, 0)), fix.accuracy_claimed};
}

}  // namespace

TEST_CASE("positions: without figures the quality says what a fix is worth") {
  using enum FixQuality;
  CHECK(sigma_of({.quality = fixed}).sigma_m == Approx(0.02));
  CHECK(sigma_of({.quality = floating}).sigma_m == Approx(0.4));
  CHECK(sigma_of({.quality = fixed, .hdop = 3}).sigma_m == Approx(0.02));
  CHECK(sigma_of({.quality = single, .hdop = 2}).sigma_m == Approx(6));
  CHECK(sigma_of({.quality = differential, .hdop = 2}).sigma_m == Approx(3));
  CHECK(sigma_of({.quality = dead_reckoned}).sigma_m == Approx(10));
  // A usual sigma without anything of this fix in it is no claim.
  CHECK(sigma_of({.quality = fixed}).claimed);
  CHECK(sigma_of({.quality = single, .hdop = 2}).claimed);
  CHECK_FALSE(sigma_of({.quality = single}).claimed);
}

TEST_CASE("positions: what is stated for a quality wins, what is stated for all is for code ranges") {
  using enum FixQuality;
  LogRequest request;
  request.default_sigma_m = 5;
  CHECK(sigma_of({.quality = single, .hdop = 2}, request).sigma_m == Approx(5));
  CHECK(sigma_of({.quality = fixed}, request).sigma_m == Approx(0.02));
  request.range_error_m = 4;
  CHECK(sigma_of({.quality = single, .hdop = 2}, request).sigma_m == Approx(8));
  CHECK(sigma_of({.quality = floating, .hdop = 2}, request).sigma_m == Approx(0.4));
  request.sigma_by_quality = {{fixed, 0.012}, {single, 2.5}};
  CHECK(sigma_of({.quality = fixed}, request).sigma_m == Approx(0.012));
  CHECK(sigma_of({.quality = single, .hdop = 2}, request).sigma_m == Approx(2.5));
  CHECK(sigma_of({.quality = single, .hdop = 2}, request).claimed);

  LogRequest small;
  small.default_sigma_m = 0.01;
  CHECK(sigma_of({.quality = fixed}, small).sigma_m == Approx(0.01));
}

TEST_CASE("positions: fixes are counted by quality, and a note says where their sigma is from") {
  LogRequest request;
  request.sigma_by_quality = {{FixQuality::single, 2.5}};
  PositionStream positions("log", request, nullptr);
  LogData data;
  for (const FixQuality quality :
       {FixQuality::fixed, FixQuality::single, FixQuality::fixed, FixQuality::differential}) {
    GeodeticFix fix;
    fix.told.quality = quality;
    REQUIRE(positions.add(data, fix, {}) == nullptr);
  }
  positions.finish(data);
  CHECK(data.qualities == std::map<FixQuality, std::size_t>{{FixQuality::single, 1},
                                                            {FixQuality::differential, 1},
                                                            {FixQuality::fixed, 2}});
  CHECK(data.notes == std::vector<std::string>{
                          "log: the sigma of fixes without accuracy is that stated for their quality: 1 "
                          "single 2.5 m",
                          "log: the sigma of fixes without accuracy is the usual one (not stated) for "
                          "their quality: 1 differential 1.5 m, 2 fixed 0.02 m"});
}

TEST_CASE("tables: a quality is a word, or a number of a code") {
  const auto is = [](std::string_view field, std::string_view code, FixQuality quality) {
    const auto told = table_quality(field, code);
    return told && !told->no_fix && told->quality == quality;
  };
  CHECK(is("RTK_Fixed", "gga", FixQuality::fixed));
  CHECK(is("Float RTK", "ros", FixQuality::floating));
  CHECK(is("DGPS", "gga", FixQuality::differential));
  CHECK(is("", "gga", FixQuality::unknown));
  CHECK(is("4", "gga", FixQuality::fixed));
  CHECK(is("5.0", "gga", FixQuality::floating));
  CHECK(is("1", "rtklib", FixQuality::fixed));
  CHECK(is("5", "rtklib", FixQuality::single));
  CHECK(is("0", "ros", FixQuality::single));
  CHECK(table_quality("0", "gga")->no_fix);
  CHECK(table_quality("-1", "ros")->no_fix);
  CHECK(table_quality("No fix", "gga")->no_fix);
  CHECK_FALSE(table_quality("87", "gga"));
  CHECK_FALSE(table_quality("1.5", "gga"));
  CHECK_FALSE(table_quality("good", "gga"));
}

TEST_CASE("positions: a stamp that the offset carries beyond what it can hold is none") {
  LogRequest request;
  request.time_offset_s = 9e9;
  const PositionStream positions("log", request, nullptr);
  CHECK(positions.stamp(Stamp{0}, TimeScale::gps)->nanoseconds == 9'000'000'000'000'000'000);
  CHECK_FALSE(positions.stamp(Stamp{1'000'000'000'000'000'000}, TimeScale::gps).has_value());
}

TEST_CASE("log requests: what a format cannot give is refused in one way") {
  LogRequest request;
  const auto check = [&](const std::string& message) {
    CHECK_THROWS_MATCHES(require_positions("run.log", request, "a log"), InputError,
                         Message("run.log: a log " + message));
  };
  CHECK_NOTHROW(require_positions("run.log", request, "a log"));
  request.companions["dbc"] = {{}};
  check("takes no 'dbc' file; leave it out");
  CHECK_NOTHROW(require_companions("run.log", request, "a log", "dbc"));
  request.columns["speed"] = {};
  check("has no columns to map; leave out 'columns'");
  request.stream = StreamKind::odometry;
  check("holds no odometry; it gives the streams gnss and truth");
  request.stream = StreamKind::gnss;
  CHECK_THROWS_MATCHES(require_streams("run.log", request, "a log", {StreamKind::odometry}), InputError,
                       Message("run.log: a log holds no fixes; it gives the streams odometry"));
}

}  // namespace position_stream_test
