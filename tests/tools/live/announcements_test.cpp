// What a live run says of something that happens again and again: not each time, and all of it is counted.
#include <catch2/catch.hpp>

#include <waymark/tools/live/estimator/announcements.hpp>

namespace announcements_test {

using namespace waymark;
using namespace waymark::live;

TEST_CASE("announcements: failures of one kind are told at powers of ten, and all are counted", "[live]") {
  Announcements says;
  for (int i = 0; i < 250; ++i) says.fail(Stamp{i}, "no minimum");
  says.fail(Stamp{250}, "no start");
  CHECK(says.counts.failures == 251);
  std::vector<std::string> told;
  for (const Report& report : says.take()) told.push_back(std::get<Event>(report).text);
  CHECK(told == std::vector<std::string>{"no minimum", "no minimum (so far 10 times)",
                                         "no minimum (so far 100 times)", "no start"});
}

}  // namespace announcements_test
