// The short ways of reading and writing numbers against the standard library's.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/formats/text/detail/decimal.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>

using namespace waymark;
using namespace waymark::formats;

namespace {

std::string standard_text(double value) {
  std::string text(32, '\0');
  text.resize(static_cast<std::size_t>(std::to_chars(text.data(), text.data() + text.size(), value).ptr -
                                       text.data()));
  return text;
}

/// Each number on a line of its own.
std::string built_text(const std::vector<double>& values) {
  return collect_text([&](const TextSink& sink) {
    TextBuilder out(sink);
    for (const double value : values) out.number(value).end_line();
    out.finish();
  });
}

/// Whether both functions read the whole text as the same double. Texts that only the general one knows pass.
bool reads_alike(const std::string& text) {
  const char* const end = text.data() + text.size();
  const Decimal plain = read_plain_decimal(text.data(), end);
  if (plain.end != end) return true;
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return stop == end && error == std::errc() &&
         std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(plain.value);
}

}  // namespace

TEST_CASE("numbers: plain decimals are rounded like from_chars") {
  for (const char* text : {"",
                           "-",
                           ".",
                           "-.",
                           "0",
                           "-0",
                           "0.0",
                           "-0.0",
                           "5.",
                           ".5",
                           "-.5",
                           "007",
                           "9007199254740993",
                           "18446744073709551615",
                           "18446744073709551616",
                           "9999999999999999999",
                           "99999999999999999999",
                           "0.1234567890123456789",
                           "0.0000000000000000001",
                           "1.0000000000000000000",
                           "9007199254740992.5",
                           "9007199254740993.0",
                           "0.1.2",
                           "1e5"}) {
    INFO(text);
    CHECK(reads_alike(text));
  }
  std::mt19937_64 random(7);
  for (int i = 0; i < 200'000; ++i) {
    // Half of them lie half-way between two doubles, where rounding is decided by the last digit or the
    // remainder.
    const double value = std::ldexp(static_cast<double>(random() >> 11U), -static_cast<int>(random() % 60));
    const double next = std::nextafter(value, 0.0);
    char text[64];
    const int decimals = static_cast<int>(random() % 20);
    const long double middle = (static_cast<long double>(value) + static_cast<long double>(next)) / 2;
    std::snprintf(text, sizeof text, "%.*Lf", decimals,
                  i % 2 == 0 ? middle : static_cast<long double>(value));
    if (!reads_alike(text)) FAIL(text);
    if (!reads_alike(standard_text(value))) FAIL(standard_text(value));
  }
}

TEST_CASE("numbers: plain decimals end where the number does") {
  // The caller must check the rest: "12abc" and "1.5.2" are no numbers, although they begin like one.
  const std::string text = "-12.25abc";
  const Decimal decimal = read_plain_decimal(text.data(), text.data() + text.size());
  CHECK(decimal.value == -12.25);
  CHECK(decimal.end == text.data() + 6);
}

TEST_CASE("numbers: numbers are written as to_chars writes them") {
  std::vector<double> values = {0.0,
                                -0.0,
                                1,
                                -1,
                                99999,
                                1e5,
                                -1e5,
                                123456e5,
                                1e15,
                                1e16,
                                1e-4,
                                -2e-4,
                                0.00012,
                                0.001,
                                1e-5,
                                5e-324,
                                1e300,
                                0.1,
                                -0.1,
                                9007199254740992.0,
                                9007199254740994.0,
                                std::numeric_limits<double>::max()};
  std::mt19937_64 random(11);
  const auto digit = [&random](int most) {
    return static_cast<double>(random() % static_cast<unsigned>(most));
  };
  for (int i = 0; i < 100'000; ++i) {
    const double any = std::bit_cast<double>(random());
    values.push_back(std::isfinite(any) ? any : 0.5);
    values.push_back((i % 2 == 0 ? 1 : -1) * std::pow(10.0, 40 * (digit(1 << 20) / (1 << 20)) - 20));
    values.push_back(digit(10) / std::pow(10.0, digit(9)));
    values.push_back(digit(1'000'000) * std::pow(10.0, digit(12)));
    values.push_back(values[static_cast<std::size_t>(digit(20))]);  // again: from the memory of recent ones
  }
  std::string expected;
  for (const double value : values) expected.append(standard_text(value)).append("\n");
  CHECK((built_text(values) == expected));
}

TEST_CASE("numbers: a text is the same in pieces of any length") {
  // Words longer than a piece, and pieces that end within a line.
  const std::string word(700'000, 'x');
  std::string pieces;
  std::size_t count = 0;
  TextBuilder out([&](std::string_view piece) {
    pieces += piece;
    ++count;
  });
  std::string expected;
  for (int i = 0; i < 3; ++i) {
    out.word("A").word(word).integer(-5).number(0.5).end_line();
    expected.append("A ").append(word).append(" -5 0.5\n");
  }
  for (int i = 0; i < 200'000; ++i) {
    out.integer(i);
    if (i > 0) expected += ' ';
    expected += std::to_string(i);
  }
  out.end_line();
  out.finish();
  expected += "\n";
  CHECK((pieces == expected));
  CHECK(count > 5);
}
