#include <catch2/catch.hpp>

#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/log_readers.hpp>

namespace log_readers_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

TEST_CASE("log readers: the built-in readers are found by name") {
  REQUIRE(builtin_log_readers().size() >= 2);
  for (const LogReaderType& entry : builtin_log_readers())
    CHECK(builtin_log_reader(entry.name) == entry.reader);
  CHECK(builtin_log_reader("cvs") == nullptr);
}

TEST_CASE("suggestions: the nearest known word is suggested") {
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("yaw_rate", "ywa_rate") == 1);  // a swap is one edit
  CHECK(edit_distance("Speed", "speed") == 0);
  const std::vector<std::string_view> words{"columns", "format", "file"};
  CHECK(did_you_mean("colums", words) == "; did you mean 'columns'?");
  CHECK(did_you_mean("xyz", words).empty());
  CHECK(suggestion("colums", words) == "; did you mean 'columns'?");
  CHECK(suggestion("xyz", words) == "; there are: columns, format, file");
  // If several names are equally near, none of them is more likely to be meant.
  const std::vector<std::string_view> alike{"g1", "g2"};
  CHECK(suggestion("g9", alike) == "; there are: g1, g2");
}

}  // namespace log_readers_test
