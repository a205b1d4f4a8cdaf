#include <catch2/catch.hpp>

#include <string>

#include <waymark/formats/logs/detail/common/kind_tally.hpp>

namespace kind_tally_test {

using namespace waymark;
using namespace waymark::formats;

TEST_CASE("kinds of messages: names are told apart by their first 24 characters") {
  KindTally tally;
  for (const char* name : {"GPRMC", "BESTGNSSPOSA", "BESTGNSSVELA", "GPRMC", "", "DUALANTENNAHEADINGA"})
    tally.add(name);
  tally.add("abcdefghijklmnopqrstuvwxyz");
  tally.add("abcdefghijklmnopqrstuvwx");
  const std::map<std::string, std::size_t> expected{{"", 1},
                                                    {"BESTGNSSPOSA", 1},
                                                    {"BESTGNSSVELA", 1},
                                                    {"DUALANTENNAHEADINGA", 1},
                                                    {"GPRMC", 2},
                                                    {"abcdefghijklmnopqrstuvwx", 2}};
  CHECK(tally.counts() == expected);
}

TEST_CASE("kinds of messages: of endless names the first 128 are counted by name") {
  KindTally tally;
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 1000; ++i) {
      std::string name = "K";
      name += std::to_string(i);
      tally.add(name);
    }
  }
  const auto counts = tally.counts();
  CHECK(counts.size() == 129);
  CHECK(counts.at("K0") == 2);
  CHECK(counts.at("K127") == 2);
  CHECK(counts.at("others") == 2 * (1000 - 128));
}

}  // namespace kind_tally_test
