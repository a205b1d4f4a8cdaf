// Damaged logs, every reader: never a crash, and each damaged record is counted and named. Memory errors show
// under the preset asan; tests/fuzz looks further.
#include <catch2/catch.hpp>

#include <chrono>
#include <random>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "logs/hostile/hostile_samples.hpp"
#include "logs/log_pieces.hpp"
#include "logs/ubx/ubx_bytes.hpp"

#include "support/skip.hpp"

namespace hostile_test {

using namespace waymark;
using namespace waymark::formats;
using waymark_test::check_same;
using waymark_test::hostile_samples;
using waymark_test::HostileSample;

namespace {

std::size_t sample_count(const LogData& data) {
  return data.odometry.size() + data.fixes.size() + data.truth.size() + data.readings.size();
}

/// Places of the sample's records in its text.
std::vector<std::size_t> records_of(const HostileSample& sample) {
  std::vector<std::size_t> places;
  for (std::size_t at = sample.text.find(sample.record); at != std::string::npos;
       at = sample.text.find(sample.record, at + 1)) {
    const std::size_t begin = sample.text.find_last_not_of(" \t", at == 0 ? 0 : at - 1);
    if (!sample.lines || at == 0 || sample.text[begin] == '\n') places.push_back(at);
  }
  return places;
}

std::size_t line_of(const std::string& text, std::size_t place) {
  return static_cast<std::size_t>(
             std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n')) +
         1;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
    lines.push_back(text.substr(at, end + 1 - at));
    at = end + 1;
  }
  return lines;
}

std::string replaced_all(const std::string& text, const std::string& what, const std::string& with) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t next = text.find(what); next != std::string::npos; next = text.find(what, at)) {
    result += text.substr(at, next - at) + with;
    at = next + what.size();
  }
  return result + text.substr(at);
}

bool same_samples(const LogData& a, const LogData& b) {
  if (sample_count(a) != sample_count(b) || a.fixes.size() != b.fixes.size()) return false;
  for (std::size_t i = 0; i < a.fixes.size(); ++i) {
    if (a.fixes[i].stamp != b.fixes[i].stamp || a.fixes[i].latitude_deg != b.fixes[i].latitude_deg)
      return false;
  }
  return a.readings.stamps == b.readings.stamps;
}

/// A letter of every byte that a log could hold, from a fixed seed.
std::string random_bytes(std::size_t size) {
  std::mt19937 random(7);
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(random() & 0xFFU);
  return bytes;
}

double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

TEST_CASE("hostile: every reader has a sample, and reads it without complaint") {
  if (hostile_samples().size() < 12)
    waymark_test::skip("the shared data are absent, only logs made by hand are read");
  for (const HostileSample& sample : hostile_samples()) {
    INFO(sample.reader);
    const LogData data = sample.read(sample.text);
    CHECK(sample_count(data) >= 10);
    CHECK(data.corrupt == 0);
    CHECK(records_of(sample).size() >= 10);
  }
}

TEST_CASE("hostile: a log that breaks off anywhere gives what came before, at most one record is corrupt") {
  for (const HostileSample& sample : hostile_samples()) {
    INFO(sample.reader);
    const std::size_t all = sample_count(sample.read(sample.text));
    std::size_t most = 0;
    for (std::size_t k = 0; k < 150; ++k) {
      const std::size_t cut = sample.text.size() * k / 150 + k % 7;
      INFO(cut);
      const LogData data = sample.read(std::string_view(sample.text).substr(0, cut));
      CHECK(sample_count(data) <= all);
      CHECK(data.corrupt <= 1);
      most = std::max(most, sample_count(data));
    }
    if (sample.reader != "kitti_oxts") CHECK(most >= all / 2);  // that needs a time stamp for each record
  }
}

TEST_CASE("hostile: flipped bits never crash a reader, and pieces of any length give the same") {
  for (const HostileSample& sample : hostile_samples()) {
    INFO(sample.reader);
    for (unsigned seed = 0; seed < 60; ++seed) {
      INFO(seed);
      std::mt19937 random(seed);
      std::string text = sample.text;
      for (unsigned flips = 0; flips <= seed; ++flips)
        text[random() % text.size()] ^= static_cast<char>(1U << random() % 8);
      const LogData whole = sample.read(text);
      CHECK(sample_count(whole) <= whole.records);
      CHECK(whole.corrupt <= whole.records);
      if (seed % 10 == 0) check_same(whole, sample.read(text, 7));
    }
  }
}

TEST_CASE("hostile: damaged records are counted, and the first is named with its place") {
  for (const HostileSample& sample : hostile_samples()) {
    if (!sample.lines || sample.reader == "gpx") continue;  // gpx: after malformed XML nothing is read
    INFO(sample.reader);
    const std::vector<std::size_t> records = records_of(sample);
    std::string text = sample.text;
    std::size_t damaged = 0;
    std::size_t first = 0;
    const bool wanted_alone = sample.reader == "candump";  // of other frames nothing but the id is looked at
    for (std::size_t k = 2; k < records.size(); k += 3) {
      const std::size_t end = text.find('\n', records[k]);
      if (wanted_alone && text.substr(records[k], end - records[k]).find(" 024#") == std::string::npos)
        continue;
      const std::size_t at = sample.reader == "gpsd_json"
                                 ? text.rfind('}', end)
                                 : text.find_first_of(sample.fragile, records[k] + sample.record.size());
      REQUIRE(at < end);
      text[at] = 'x';
      if (damaged++ == 0) first = line_of(text, at);
    }
    REQUIRE(damaged >= 3);
    const LogData data = sample.read(text);
    CHECK(data.corrupt == damaged);
    REQUIRE(data.corrupt_examples.size() == std::min<std::size_t>(damaged, 5));
    CHECK(data.corrupt_examples[0].rfind("run.log:" + std::to_string(first) + ":", 0) == 0);
    CHECK(sample_count(data) + damaged >= sample_count(sample.read(sample.text)));
  }
}

TEST_CASE("hostile: damaged UBX frames are counted, and the first is named with its place") {
  const HostileSample& sample = hostile_samples().back();
  const std::vector<std::size_t> records = records_of(sample);
  std::string text = sample.text;
  for (const std::size_t k : {3U, 9U, 20U}) text[records[k] + 40] ^= 1;
  const LogData data = sample.read(text);
  CHECK(data.corrupt == 3);
  CHECK(data.fixes.size() == records.size() - 3);
  CHECK(data.corrupt_examples[0] ==
        "run.log:byte " + std::to_string(records[3]) + ": NAV-PVT: the checksum is wrong");
}

TEST_CASE("hostile: malformed XML ends a GPX log with one corrupt record that names its place") {
  for (const HostileSample& sample : hostile_samples()) {
    if (sample.reader != "gpx") continue;
    const std::size_t at = records_of(sample)[10];
    std::string text = sample.text;
    text[at + 1] = '<';
    const LogData data = sample.read(text);
    CHECK(data.corrupt == 1);
    CHECK(data.fixes.size() == 10);
    CHECK(data.corrupt_examples[0].rfind("run.log:" + std::to_string(line_of(text, at)) + ":", 0) == 0);
  }
}

TEST_CASE("hostile: two logs in one another, line by line") {
  for (const HostileSample& sample : hostile_samples()) {
    const LogData alone = sample.read(sample.text);
    for (const HostileSample& other : hostile_samples()) {
      if (other.reader == sample.reader) continue;
      INFO(sample.reader << " with " << other.reader);
      const std::vector<std::string> strange = lines_of(other.text);
      std::string text;
      std::size_t k = 0;
      for (const std::string& line : lines_of(sample.text)) text += line + strange[k++ % strange.size()];
      const LogData data = sample.read(text);
      CHECK(sample_count(data) <= data.records);
      // These skip foreign records.
      const bool passes =
          sample.reader == "nmea" || sample.reader == "novatel" || sample.reader == "gpsd_json";
      // gpsd writes the NMEA sentences of a receiver beside its own.
      const bool theirs = sample.reader == "nmea" && other.reader == "gpsd_json";
      if (passes && !theirs && other.lines) CHECK(same_samples(data, alone));
    }
  }
}

TEST_CASE("hostile: frames of a UBX log between lines of text") {
  const HostileSample& ubx = hostile_samples().back();
  const LogData alone = ubx.read(ubx.text);
  for (const HostileSample& other : hostile_samples()) {
    if (!other.lines) continue;
    INFO(other.reader);
    const std::vector<std::string> strange = lines_of(other.text);
    std::string text;
    const std::vector<std::size_t> frames = records_of(ubx);
    for (std::size_t k = 0; k < frames.size(); ++k)
      text += strange[k % strange.size()] + ubx.text.substr(frames[k], frames[0] + frames[1] - frames[0]);
    CHECK(same_samples(ubx.read(text), alone));
  }
}

TEST_CASE("hostile: empty, zero and random bytes give no sample and an error that names the log") {
  for (const LogReaderType& entry : builtin_log_readers()) {
    for (const std::string& text : {std::string(), std::string(100'000, '\0'), random_bytes(300'000)}) {
      INFO(entry.name << ", " << text.size() << " bytes");
      LogRequest request;
      request.default_sigma_m = 5;
      request.date = Stamp{};
      for (const HostileSample& sample : hostile_samples()) {
        if (sample.reader == entry.name) request = sample.request;
      }
      CHECK_THROWS_WITH(entry.reader->read(text, "run.log", request),
                        Catch::Matchers::StartsWith("run.log:") || Catch::Matchers::StartsWith("car.dbc:"));
      CHECK(entry.reader->recognise(text).certainty == 0);
    }
  }
}

TEST_CASE("hostile: a line of 64 MiB is one corrupt record, in little memory") {
  const std::string piece(1U << 20U, '7');
  for (const HostileSample& sample : hostile_samples()) {
    INFO(sample.reader);
    const double before = peak_megabytes();
    const auto decoder = sample.log_reader().open("run.log", sample.request);
    const std::size_t first_line = std::min(sample.text.find('\n') + 1, sample.text.size());
    decoder->take(std::string_view(sample.text).substr(0, first_line));
    for (int k = 0; k < 64; ++k) decoder->take(piece);
    try {
      decoder->finish();
    } catch (const InputError&) {
      // Other complaints than the line may come first.
    }
    const LogData& data = decoder->data();
    CHECK(sample_count(data) <= 1);
    for (const std::string& text : data.corrupt_examples) CHECK(text.size() < 300);
    for (const std::string& text : data.notes) CHECK(text.size() < 1000);
    CHECK(peak_megabytes() - before < 16);
  }
}

TEST_CASE("hostile: the text of a line that is too long") {
  const auto decoder = builtin_log_reader("rtklib_pos")->open("run.pos", {});
  decoder->take(
      "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m)\n");
  decoder->take(std::string((1U << 20U) + 1, '7'));
  decoder->finish();
  CHECK(decoder->data().corrupt_examples ==
        std::vector<std::string>{"run.pos:2:1: a line of more than 1 MiB is no record of a log"});
}

TEST_CASE("hostile: lines may end with CR LF, LF or, but for a complaint, CR") {
  for (const HostileSample& sample : hostile_samples()) {
    if (!sample.lines) continue;
    INFO(sample.reader);
    const std::string unix_text = replaced_all(sample.text, "\r\n", "\n");
    const std::string windows = replaced_all(unix_text, "\n", "\r\n");
    const LogData data = sample.read(unix_text);
    check_same(data, sample.read(windows));
    std::string mixed;
    std::size_t k = 0;
    for (const std::string& line : lines_of(unix_text))
      mixed += ++k % 2 == 0 ? replaced_all(line, "\n", "\r\n") : line;
    check_same(data, sample.read(mixed));
    CHECK(sample_count(sample.read(replaced_all(unix_text, "\n", "\r"))) <= sample_count(data));
  }
}

TEST_CASE("hostile: zero bytes within lines") {
  for (const HostileSample& sample : hostile_samples()) {
    INFO(sample.reader);
    std::string text;
    for (std::size_t i = 0; i < sample.text.size(); ++i) {
      text += sample.text[i];
      if (i % 997 == 996) text += '\0';
    }
    const LogData data = sample.read(text);
    CHECK(sample_count(data) <= sample_count(sample.read(sample.text)));
    for (const std::string& example : data.corrupt_examples) CHECK(example.find('\0') == std::string::npos);
  }
}

TEST_CASE("hostile: messages repeat names and values of a log cut and without control characters") {
  const std::string bell = "\x07\x1b[2J";
  const auto first_of = [](const char* reader, const std::string& text, LogRequest request) {
    request.default_sigma_m = 5;
    const auto decoder = builtin_log_reader(reader)->open("run.log", request);
    decoder->take(text);
    decoder->finish();
    return decoder->data().corrupt_examples.at(0);
  };
  CHECK(first_of("csv", "time,latitude,longitude\n1," + bell + std::string(100, '9') + ",2\n", {}) ==
        "run.log:2:3: latitude: expected a number, got '\\x07\\x1b[2J" + std::string(35, '9') + "...'");
  CHECK(first_of("gpsd_json", "{\"class\":\"TPV\",\"mode\":3,\"time\":\"\\u0007now\",\"lat\":1,\"lon\":2}\n",
                 {}) == "run.log:1:1: TPV: expected an ISO 8601 date for 'time', got '\\x07now'");
  LogRequest can;
  can.stream = StreamKind::sensor;
  can.readings = {{"speed", "m/s", "", true, ""}};
  can.columns["speed"] = {"V", "m/s", ""};
  can.companions["dbc"] = {{"car.dbc", "BO_ 1 M: 1 X\n SG_ V : 0|8@1+ (1,0) [0|0] \"m/s\" X\n"}};
  CHECK(first_of("candump", "(1.0) can0 001#07\n(1.\x01) can0 001#07\n", can) ==
        "run.log:2:2: '1.\\x01' is no time in decimal seconds");
  std::string sentence = "GPRMC,12\x7f,A,4807.038,N,01131.000,E,022.4,084.4,230394,,";
  unsigned sum = 0;
  for (const char c : sentence) sum ^= static_cast<unsigned char>(c);
  constexpr const char* kDigits = "0123456789ABCDEF";
  sentence = '$' + sentence + '*' + kDigits[sum >> 4U] + kDigits[sum & 15U] + '\n';
  CHECK(first_of("nmea", sentence, {}) == "run.log:1:8: GPRMC: expected a time hhmmss, got '12\\x7f'");
}

TEST_CASE("hostile: a header of a thousand columns is not repeated whole") {
  std::string header = "time";
  for (int k = 0; k < 1000; ++k) header += ",c" + std::to_string(k);
  LogRequest request;
  request.default_sigma_m = 5;
  try {
    (void)builtin_log_reader("csv")->read(header + "\n", "run.csv", request);
    FAIL("no latitude, and no complaint");
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.find("columns present: time, c0, c1") != std::string::npos);
    CHECK(text.substr(text.size() - 21) == "c37, c38 and 961 more");
  }
}

}  // namespace hostile_test
