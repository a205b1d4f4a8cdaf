// The messages of readers about a log that they refuse or a record that they cannot use, one in each case.
#include <catch2/catch.hpp>

#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "logs/hostile/hostile_samples.hpp"

namespace messages_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

LogRequest odometry(std::map<std::string, ColumnRequest> columns = {}) {
  LogRequest request;
  request.stream = StreamKind::odometry;
  request.columns = std::move(columns);
  return request;
}

/// The complaint that refuses the log, or about its first corrupt record.
std::string complaint(const char* reader, const std::string& text, const LogRequest& request) {
  try {
    const auto decoder = builtin_log_reader(reader)->open("run.log", request);
    decoder->take(text);
    decoder->finish();
    return decoder->data().corrupt_examples.empty() ? "no complaint" : decoder->data().corrupt_examples[0];
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string dbc_complaint(const std::string& text) {
  try {
    (void)Dbc::parse(text, "car.dbc");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

/// The message about a signal of a sound message.
std::string signal_complaint(const std::string& signal) {
  return dbc_complaint("BO_ 1 M: 8 X\n SG_ " + signal + "\n");
}

}  // namespace

TEST_CASE("csv messages: a quoted field of the header is not closed") {
  CHECK(complaint("csv", "time,\"speed,yaw_rate\n", odometry()) ==
        "run.log:1:1: a quoted field of the header is not closed");
}

TEST_CASE("csv messages: a quoted field of a record is not closed") {
  CHECK(complaint("csv", "time,speed,yaw_rate\n1,\"2,3\n", odometry()) ==
        "run.log:2:7: a quoted field is not closed or text follows its end");
}

TEST_CASE("csv messages: a decimal comma") {
  CHECK(complaint("csv", "time,speed,yaw_rate\n1,\"2,5\",3\n", odometry()) ==
        "run.log:2:4: speed: expected a number with a decimal point, got '2,5'");
}

TEST_CASE("csv messages: a time that is no number") {
  CHECK(complaint("csv", "time,speed,yaw_rate\n1h,2,3\n", odometry()) ==
        "run.log:2:1: time: expected a decimal number, got '1h'");
}

TEST_CASE("csv messages: a time beyond the range of a stamp") {
  LogRequest late = odometry();
  late.time_offset_s = 9e9;
  CHECK(complaint("csv", "time,speed,yaw_rate\n9000000000,2,3\n", late) ==
        "run.log:2:1: time: '9000000000' is too large for a stamp");
}

TEST_CASE("csv messages: no column for the time in a table without a header") {
  CHECK(complaint("csv", "1,2,3\n", odometry({{"speed", {"v", "", ""}}})) ==
        "run.log:1:1: no column for time (neither 'time' nor 'time_s'): name it under columns; the table has "
        "no header, only columns 1 to 3");
}

TEST_CASE("csv messages: a convention for a quantity that has none") {
  CHECK(complaint("csv", "time,v\n", odometry({{"speed", {"v", "", "cw"}}})) ==
        "run.log: speed has no convention; leave it out");
}

TEST_CASE("csv messages: an unknown convention") {
  CHECK(complaint("csv", "time,v\n", odometry({{"yaw_rate", {"v", "", "cww"}}})) ==
        "run.log: unknown convention 'cww' for yaw_rate; did you mean 'ccw'?; known: ccw, cw");
}

TEST_CASE("csv messages: no column for any channel") {
  LogRequest channels = odometry();
  channels.readings = odometry_channels();
  CHECK(complaint("csv", "time,rpm\n1,2\n", channels) ==
        "run.log:1:1: no column for speed or another channel: name it under columns; columns present: time, "
        "rpm");
}

TEST_CASE("dbc messages: a file without a message") {
  CHECK(dbc_complaint("VERSION \"\"\n") == "car.dbc: no message (a line 'BO_ ...'): this is no DBC file");
}

TEST_CASE("dbc messages: a message without a name or a length") {
  CHECK(dbc_complaint("BO_ 1 ?\n") == "car.dbc:1:7: BO_: expected the message's name, got '?'");
  CHECK(dbc_complaint("BO_ 1 M: x X\n") ==
        "car.dbc:1:10: BO_ M: expected the message's length in bytes, got 'x X'");
}

TEST_CASE("dbc messages: a signal without a name, length, byte order or colon") {
  CHECK(signal_complaint("?") == "car.dbc:2:6: SG_: expected the signal's name, got '?'");
  CHECK(signal_complaint("V : 0|x") == "car.dbc:2:12: SG_ V: expected the length in bits, got 'x'");
  CHECK(signal_complaint("V : 0|8@x") ==
        "car.dbc:2:14: SG_ V: expected the byte order 0 (Motorola) or 1 (Intel), got 'x'");
  CHECK(signal_complaint("V ?") ==
        "car.dbc:2:8: SG_ V: expected ':' or a multiplexing such as 'M' or 'm3', got '?'");
}

TEST_CASE("dbc messages: a name that no tool would write") {
  const std::string name(129, 'N');
  CHECK(dbc_complaint("BO_ 1 " + name + ": 8 X\n") ==
        "car.dbc:1:7: BO_: a name of 129 characters: none has more than 128");
}

TEST_CASE("log messages: a stamp that does not fit, for every receiver's log") {
  for (const waymark_test::HostileSample& sample : waymark_test::hostile_samples()) {
    if (sample.reader == "csv" || sample.reader == "candump") continue;
    INFO(sample.reader);
    LogRequest request = sample.request;
    request.time_offset_s = 9e9;
    const std::string text = complaint(sample.reader.c_str(), sample.text, request);
    CHECK(text.rfind("run.log:", 0) == 0);
    CHECK(text.find("too large for a stamp") != std::string::npos);
  }
}

}  // namespace messages_test
