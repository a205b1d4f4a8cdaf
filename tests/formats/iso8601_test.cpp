#include <catch2/catch.hpp>

#include <string_view>

#include <waymark/formats/text/iso8601.hpp>

using namespace waymark;
using namespace waymark::formats;

TEST_CASE("iso8601: dates in every usual spelling are read, others are refused") {
  const auto nanoseconds = [](std::string_view text) { return stamp_from_iso8601(text).value().nanoseconds; };
  CHECK(nanoseconds("1970-01-01T00:00:00Z") == 0);
  CHECK(nanoseconds("2000-02-29T12:00:00.123456789Z") == 951'825'600'123'456'789);
  CHECK(nanoseconds("1969-12-31T23:59:59.5Z") == -500'000'000);
  CHECK(nanoseconds("2016-12-31T23:59:60Z") == nanoseconds("2017-01-01T00:00:00Z"));
  CHECK(nanoseconds("2023-06-28 14:52:12-0130") == nanoseconds("2023-06-28T16:22:12Z"));
  for (const char* wrong :
       {"", "2023-06-31T00:00:00Z", "2023-6-1T00:00:00Z", "2023-06-01T24:00:00Z", "2023-06-01T00:00:00X",
        "2023-06-01T00:00:00.Z", "2023-06-01", "2023-06-01T00:00:00Z "})
    CHECK(!stamp_from_iso8601(wrong));
}
