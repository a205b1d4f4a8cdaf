// RINEX files made here: what is read of them, and what is said of wrong ones.
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "logs/log_pieces.hpp"
#include "logs/rinex/made_rinex.hpp"
#include "logs/rinex/shared_raw.hpp"
#include "support/skip.hpp"

namespace rinex_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;
using Catch::Matchers::Contains;

namespace {

/// The real drive of Berlin: 2016-06-06 11:10:41.7, GPS and GLONASS.
struct Berlin {
  std::string observations;
  std::vector<CompanionFile> navigation;
};

std::optional<Berlin> berlin() {
  const std::string folder = "drives/berlin_potsdamer_platz_raw/";
  const auto path = shared_data(folder + "rover.obs");
  if (!path) return std::nullopt;
  std::string text = read_text_file(*path);
  // Header and the first epochs
  std::size_t end = 0;
  for (int line = 0; line < 200; ++line) end = text.find('\n', end) + 1;
  const std::size_t epoch = text.rfind("\n 16  6  6", end) + 1;
  return Berlin{text.substr(0, epoch),
                {read_companion(*shared_data(folder + "brdc1580.16n")),
                 read_companion(*shared_data(folder + "brdc1580.16g"))}};
}

LogRequest request(std::vector<CompanionFile> navigation) {
  LogRequest result;
  result.stream = StreamKind::sensor;
  result.readings = raw_gnss_columns();
  if (!navigation.empty()) result.companions["navigation"] = std::move(navigation);
  return result;
}

LogData read(const std::string& text, std::vector<CompanionFile> navigation) {
  return builtin_log_reader("rinex")->read(text, "rover.obs", request(std::move(navigation)));
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  REQUIRE(from.size() == to.size());
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
    text.replace(at, from.size(), to);
}

const std::string kHead3 =
    rinex_header_line("     3.03           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
    rinex_header_line("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") +
    rinex_header_line("", "END OF HEADER");

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("rinex: the same rows whatever the pieces, and the content tells the format") {
  const auto drive = berlin();
  if (!drive) return;
  const LogReader& reader = *builtin_log_reader("rinex");
  const LogData whole = read(drive->observations, drive->navigation);
  CHECK(whole.readings.size() > 100);
  for (const std::size_t length : {1UL, 7UL, 64UL}) {
    const LogData pieces =
        read_in_pieces_of(length, reader, drive->observations, "rover.obs", request(drive->navigation));
    CHECK(pieces.readings.stamps == whole.readings.stamps);
    CHECK(pieces.readings.values.size() == whole.readings.values.size());
  }
  CHECK(reader.recognise(drive->observations).certainty == 1);
  CHECK(reader.recognise(drive->navigation[0].text).certainty == 0);
}

TEST_CASE("rinex: a log without ephemerides, and files in each other's place, are told the remedy") {
  const auto drive = berlin();
  if (!drive) return;
  CHECK_THROWS_WITH(read(drive->observations, {}), Contains("rover.obs: ") && Contains("'navigation: FILE'"));
  CHECK_THROWS_WITH(builtin_log_reader("rinex")->open("rover.obs", {}),
                    Contains("holds no fixes but pseudoranges"));
  CHECK_THROWS_WITH(read(drive->observations, {{"nav", drive->observations}}),
                    Contains("nav:1: this is an observation file"));
  CHECK_THROWS_WITH(read(drive->navigation[0].text, drive->navigation),
                    Contains("rover.obs:1: this is no observation file"));
  CHECK_THROWS_WITH(read(drive->observations, {{"nav", "a,b\n"}}),
                    Contains("nav:1: expected a RINEX navigation file"));
  const std::string head = drive->navigation[0].text.substr(0, 200);
  CHECK_THROWS_WITH(read(drive->observations, {{"nav", head}}),
                    Contains("nav:3: the file ends in its header"));
}

TEST_CASE("rinex: the navigation file of another day is named with both times") {
  auto drive = berlin();
  if (!drive) return;
  replace_all(drive->observations, " 16  6  6 ", " 16  6  9 ");
  CHECK_THROWS_WITH(read(drive->observations, {drive->navigation[0]}),
                    Contains("no satellite has a usable ephemeris from 2016-06-09T11:10:41") &&
                        Contains("name the navigation file of that day"));
}

TEST_CASE("rinex: satellites without an ephemeris are counted and named, the others are used") {
  const auto drive = berlin();
  if (!drive) return;
  const LogData data = read(drive->observations, {drive->navigation[0]});
  CHECK(data.readings.size() > 50);
  CHECK(any_contains(data.notes, "have no usable ephemeris and are left out: S20 R01"));
}

TEST_CASE("rinex: dates of another cycle of 1024 weeks are corrected, and a note says so") {
  auto drive = berlin();
  if (!drive) return;
  const LogData right = read(drive->observations, drive->navigation);
  // 1024 weeks before 2016-06-06
  replace_all(drive->observations, " 16  6  6 ", " 96 10 21 ");
  const LogData data = read(drive->observations, drive->navigation);
  CHECK(data.readings.stamps == right.readings.stamps);
  CHECK(any_contains(data.notes, "1 cycles of 1024 weeks"));
}

TEST_CASE("rinex: an epoch that is cut off is corrupt, and those before it count") {
  const auto drive = berlin();
  if (!drive) return;
  const std::string cut = drive->observations.substr(0, drive->observations.size() - 200);
  const LogData data = read(cut, drive->navigation);
  CHECK(data.corrupt == 1);
  CHECK_THAT(data.corrupt_examples.at(0),
             Contains("the file ends after") && Contains("the epoch is left out"));
  CHECK(data.readings.size() < read(drive->observations, drive->navigation).readings.size());
}

TEST_CASE("rinex: an epoch with fewer satellites than it announces is corrupt, and the next one counts") {
  auto drive = berlin();
  if (!drive) return;
  const LogData right = read(drive->observations, drive->navigation);
  // The last line before the second epoch is lost: one satellite with its four observations.
  const std::string date = "\n 16  6  6";
  const std::size_t second = drive->observations.find(date, drive->observations.find(date) + 1);
  const std::size_t lost = drive->observations.rfind('\n', second - 1);
  std::string text = drive->observations;
  text.erase(lost, second - lost);
  const LogData data = read(text, drive->navigation);
  CHECK(data.corrupt == 1);
  CHECK_THAT(data.corrupt_examples.at(0),
             Contains("the next epoch begins after 18 of 19 satellites of the epoch of line 13") &&
                 Contains("the epoch is left out"));
  const auto first_epoch =
      std::count(right.readings.stamps.begin(), right.readings.stamps.end(), right.readings.stamps.front());
  CHECK(data.readings.size() + static_cast<std::size_t>(first_epoch) == right.readings.size());
}

TEST_CASE("rinex: events are skipped with their lines, and a new list of observations is obeyed") {
  auto drive = berlin();
  if (!drive) return;
  const LogData right = read(drive->observations, drive->navigation);
  const std::size_t first = drive->observations.find("\n 16  6  6") + 1;
  const std::string comment = rinex_header_line("stopped at a light", "COMMENT");
  std::string moved = drive->observations;
  moved.insert(first, "                            2  1\n" + comment);
  const LogData data = read(moved, drive->navigation);
  CHECK(data.readings.stamps == right.readings.stamps);
  CHECK(any_contains(data.notes, "1 event records were skipped"));
  // The Doppler shift is announced under another name, so there are no range rates.
  moved.insert(first, "                            4  1\n" +
                          rinex_header_line("     4    C1    L1    S1    D2", "# / TYPES OF OBSERV"));
  const LogData renamed = read(moved, drive->navigation);
  CHECK(std::isnan(renamed.readings.at(0, 3)));
  CHECK(!std::isnan(right.readings.at(0, 3)));
}

TEST_CASE("rinex: wrong lines of RINEX 3 are named by line and column") {
  const CompanionFile nav{
      "nav", rinex_header_line("     3.03           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE") +
                 rinex_header_line("", "END OF HEADER") + "G01 2021 05 17 02 00 00 1.0e-4 0 0\n" + "    1\n"};
  CHECK_THROWS_WITH(read(kHead3, {nav}), Contains("holds no ephemeris"));
  CHECK_THROWS_WITH(read(kHead3, {nav}), Contains("line 3: the file ends in the record"));
  const auto complaint = [](const std::string& text) {
    const auto drive = berlin();
    const auto decoder = builtin_log_reader("rinex")->open("rover.obs", request(drive->navigation));
    decoder->take(text);
    try {
      decoder->finish();
    } catch (const InputError&) {
      // Nothing was usable.
    }
    return decoder->data().corrupt_examples.at(0);
  };
  if (!berlin()) return;
  CHECK_THAT(complaint(kHead3 + "G01  20000000.000\n"), Contains("rover.obs:4:1: expected an epoch"));
  CHECK_THAT(complaint(kHead3 + "> 2021 13 17  2 33 13.0000000  0  1\nG01  20000000.000\n"),
             Contains("rover.obs:4:3: expected a date"));
  CHECK_THAT(
      complaint(
          kHead3 +
          "> 2021  5 17  2 33 13.0000000  0  2\nG01  20000000.000\n> 2021  5 17  2 33 14.0000000  0  0\n"),
      Contains("rover.obs:6:1: the next epoch begins after 1 of 2 satellites of the epoch of line 4"));
}

TEST_CASE("rinex: versions and files that are not read are named") {
  const auto refused = [](const std::string& head) {
    const auto drive = berlin();
    CHECK_THROWS_AS(read(head, drive->navigation), InputError);
  };
  const auto drive = berlin();
  if (!drive) return;
  refused(rinex_header_line("     4.00           OBSERVATION DATA    M", "RINEX VERSION / TYPE"));
  refused(rinex_header_line("     3.03           OBSERVATION DATA    M",
                            "RINEX VERSION / TYPE"));  // cut off in the header
  const std::string phases =
      rinex_header_line("     3.03           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
      rinex_header_line("G    1 L1C", "SYS / # / OBS TYPES") + rinex_header_line("", "END OF HEADER");
  CHECK_THROWS_WITH(read(phases, drive->navigation),
                    Contains("announces no pseudorange of a first frequency"));
}

}  // namespace rinex_test
