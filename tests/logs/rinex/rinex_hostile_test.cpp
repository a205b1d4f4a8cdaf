// RINEX files that are wrong in every way that was thought of: an error with its place and the remedy, or a corrupt record.
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "logs/rinex/made_rinex.hpp"
#include "logs/rinex/shared_raw.hpp"

namespace rinex_hostile_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;
using Catch::Matchers::Contains;

namespace {

const std::string kEpoch = "> 2016 06 05 00 00  0.0000000  0  1\n";
const std::string kSatellite = "G05  20182000.000 8 106055000.000 8         0.000          49.000\n";

LogRequest request(const std::string& navigation) {
  LogRequest result;
  result.stream = StreamKind::sensor;
  result.readings = raw_gnss_columns();
  result.companions["navigation"] = {{"brdc.nav", navigation}};
  return result;
}

LogData read(const std::string& observations, const std::string& navigation = made_rinex_navigation()) {
  return builtin_log_reader("rinex")->read(observations, "rover.obs", request(navigation));
}

/// The first complaint of a log, also of one without a usable row.
std::string complaint(const std::string& observations) {
  const auto decoder = builtin_log_reader("rinex")->open("rover.obs", request(made_rinex_navigation()));
  decoder->take(observations);
  decoder->finish();
  REQUIRE(decoder->data().corrupt == 1);
  return decoder->data().corrupt_examples.at(0);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("rinex hostile: the files made here are sound") {
  const LogData data = read(made_rinex_observations(20));
  CHECK(data.corrupt == 0);
  REQUIRE(data.readings.size() == 20);
  // In the zenith of the equator: a - 6378137 m = 5153.7^2 - 6378137 m above the receiver.
  CHECK(data.readings.at(0, 4) == Approx(5153.7 * 5153.7).margin(2));
  CHECK(data.readings.at(0, 10) == Approx(1.5707963).margin(1e-3));
}

TEST_CASE("rinex hostile: versions and kinds of files that are not read name the remedy") {
  const auto first_line = [](const std::string& content) {
    return rinex_header_line(content, "RINEX VERSION / TYPE") + rinex_header_line("", "END OF HEADER");
  };
  CHECK_THROWS_WITH(
      read(first_line("     4.00           OBSERVATION DATA    M")),
      "rover.obs:1: RINEX 4.00 is not read, only 2 and 3; RTKLIB's convbin or gfzrnx converts it");
  CHECK_THROWS_WITH(read(first_line("     1.00           OBSERVATION DATA    M")),
                    Contains("rover.obs:1: RINEX 1.00 is not read"));
  CHECK_THROWS_WITH(read(first_line("     3.03           \x1bOBSERVATION        M")),
                    Contains("rover.obs:1: this is no observation file but a file of type '\\x1b'"));
  CHECK_THROWS_WITH(read(made_rinex_observations(1), first_line("     4.00           NAVIGATION DATA     M")),
                    Contains("brdc.nav:1: RINEX 4.00 is not read"));
  CHECK_THROWS_WITH(read(made_rinex_observations(1), first_line("     3.03           METEOROLOGICAL DATA")),
                    "brdc.nav:1: expected a navigation file, whose type is N or G, got 'M'");
  CHECK_THROWS_WITH(read(made_rinex_observations(1), first_line("     2.11           H: GEO NAV MSG DATA")),
                    Contains("brdc.nav:1: this is a navigation file of SBAS") && Contains("leave it out"));
}

TEST_CASE("rinex hostile: counts beyond reason take neither memory nor the records after them") {
  const std::string types =
      rinex_header_line("     3.03           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
      rinex_header_line("G  999 C1C L1C D1C S1C", "SYS / # / OBS TYPES") +
      rinex_header_line("  6378137.0000        0.0000        0.0000", "APPROX POSITION XYZ") +
      rinex_header_line("", "END OF HEADER");
  CHECK(read(types + kEpoch + kSatellite).readings.size() == 1);
  CHECK_THAT(
      complaint(made_rinex_header() + "> 2016 06 05 00 00  0.0000000  0999\n"),
      Contains("rover.obs:5:32: expected an epoch: its flag, 0 to 6, and the number of its satellites"));
  CHECK_THAT(complaint(made_rinex_header() + "> 2016 06 05 00 00  0.0000000  9  1\n"),
             Contains("rover.obs:5:32: expected an epoch"));
  // Two hundred satellites, one is there.
  CHECK_THAT(
      complaint(made_rinex_header() + "> 2016 06 05 00 00  0.0000000  0200\n" + kSatellite),
      Contains("the file ends after 1 of 200 satellites of the epoch of line 5; the epoch is left out"));
  const std::string version_2 =
      rinex_header_line("     2.11           OBSERVATION DATA    G", "RINEX VERSION / TYPE") +
      rinex_header_line("999999    C1    L1    S1    D1", "# / TYPES OF OBSERV") +
      rinex_header_line("", "END OF HEADER");
  CHECK_THAT(complaint(version_2 + " 16  6  5  0  0  0.0000000  0  1G05\n" + "  20182000.000\n"),
             Contains("the file ends after 0 of 1 satellites"));
}

TEST_CASE("rinex hostile: lines of a million characters are read to their columns") {
  const std::string tail(1'000'000, 'x');
  // A label ends in column 80.
  const auto lengthened = [&](std::string text, std::size_t at) {
    const std::size_t begin = text.rfind('\n', at - 1) + 1;
    const std::size_t end = text.find('\n', at);
    return text.insert(end, std::string(end - begin < 80 ? 80 - (end - begin) : 0, ' ') + tail);
  };
  const std::string sound = made_rinex_observations(3);
  for (std::size_t at = sound.find('\n'); at != std::string::npos; at = sound.find('\n', at + 1)) {
    INFO(at);
    const LogData data = read(lengthened(sound, at));
    CHECK(data.readings.size() == 3);
    CHECK(data.corrupt == 0);
  }
  const std::string navigation = made_rinex_navigation();
  for (std::size_t at = navigation.find('\n'); at != std::string::npos; at = navigation.find('\n', at + 1))
    CHECK(read(sound, lengthened(navigation, at)).readings.size() == 3);
}

TEST_CASE("rinex hostile: event flags among epochs, also those that announce more lines than there are") {
  const auto event = [](int flag, int lines) {
    return "> 2016 06 05 00 00  0.0000000  " + std::to_string(flag) + "  " + std::to_string(lines) + "\n";
  };
  const std::string comment = rinex_header_line("antenna moved", "COMMENT");
  for (const int flag : {2, 3, 4, 5}) {
    INFO(flag);
    const LogData data = read(made_rinex_header() + event(flag, 1) + comment + kEpoch + kSatellite);
    CHECK(data.readings.size() == 1);
    CHECK(data.corrupt == 0);
  }
  // Records of cycle slips (6) look like satellites and are none.
  CHECK(read(made_rinex_header() + event(6, 1) + kSatellite + kEpoch + kSatellite).readings.size() == 1);
  // Power failure before the epoch (1): it is one.
  CHECK(read(made_rinex_header() + event(1, 1) + kSatellite).readings.size() == 1);
  CHECK_THROWS_AS(read(made_rinex_header() + event(4, 9) + comment + kEpoch + kSatellite), InputError);
  CHECK_THROWS_WITH(read(made_rinex_header() + event(4, 1) +
                         rinex_header_line("G    1 L1C", "SYS / # / OBS TYPES") + kEpoch + kSatellite),
                    Contains("rover.obs:6: the header announces no pseudorange"));
}

TEST_CASE("rinex hostile: navigation records that are cut, mixed or beyond any orbit are counted and named") {
  const std::string sound = made_rinex_navigation();
  const std::string record = sound.substr(sound.find("G05"));
  const std::string observations = made_rinex_observations(1);
  const auto notes = [&](const std::string& before) {
    const LogData data = read(observations, replaced(sound, record, before + record));
    CHECK(data.readings.size() == 1);
    for (const std::string& note : data.notes)
      if (note.starts_with("brdc.nav: 1 records could not be used, the first one: ")) return note.substr(54);
    return std::string("no note");
  };
  const std::string cut = record.substr(0, record.find('\n', 300) + 1);
  CHECK(notes(cut) == "line 3: a line of the record is missing");
  CHECK(notes("X05" + record.substr(3, record.find('\n') - 2)) == "line 3: no satellite of RINEX");
  CHECK(notes("G00" + record.substr(3)) == "line 3: its satellite or date is impossible");
  CHECK(notes(replaced(record, "2016 06 05", "2016 13 05")) == "line 3: its satellite or date is impossible");
  CHECK(notes(replaced(record, "5.153700000000E+03", "5.153700000000E+30")) ==
        "line 3: its numbers are no orbit");
  CHECK_THROWS_WITH(
      read(observations, cut.empty() ? "" : sound.substr(0, sound.find("G05")) + cut),
      Contains("brdc.nav: the navigation file holds no ephemeris that can be used (line 3: the file ends in "
               "the record); take a file of broadcast ephemerides of the day"));
}

}  // namespace rinex_hostile_test
