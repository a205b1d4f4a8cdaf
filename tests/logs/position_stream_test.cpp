#include <catch2/catch.hpp>

#include <limits>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>

namespace position_stream_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The error for a fix with this accuracy; "taken" if there is none.
std::string said_of(const StatedAccuracy& accuracy, const LogRequest& request = {}) {
  LogData data;
  PositionStream positions("log", request, "figures");
  const char* complaint = positions.add(data, {}, accuracy);
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
  CHECK(said_of({}) == "the log has no accuracy: state 'default_sigma'");
  CHECK(said_of({.hdop = 2}) ==
        "the log has no accuracy but HDOP: state 'range_error', which is multiplied by "
        "HDOP, or 'default_sigma'");
  LogRequest request;
  request.range_error_m = 4;
  CHECK(said_of({.hdop = 2}, request) == "taken");
  CHECK(said_of({.hdop = 1e300}, request) == "an accuracy of more than 10,000 km");
  request.stream = StreamKind::truth;
  CHECK(said_of({}, request) == "taken");
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
  request.companions["dbc"] = {};
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
