// Tables for the terminal: alignment, widths, colours.
#include <catch2/catch.hpp>

#include <waymark/tools/text/text_table.hpp>

using namespace waymark;
using namespace waymark::text;

TEST_CASE(
    "text table: columns of numbers are flush right, those of words flush left, and no line ends in spaces") {
  TextTable table({"name", "unit", "value", "remark"});
  table.add({"gyro_bias", "rad/s", "-0.01", ""});
  table.add({"scale", "1", "12.5", "not observed"});
  table.add({"missing", "m", "-", ""});
  CHECK(table.text() ==
        "name       unit   value  remark\n"
        "gyro_bias  rad/s  -0.01\n"
        "scale      1       12.5  not observed\n"
        "missing    m          -\n");
}

TEST_CASE("text table: width is counted in characters, not in bytes") {
  CHECK(display_width("Köln") == 4);
  CHECK(display_width("道路") == 4);  // two columns each
  TextTable table({"drive", "n"});
  table.add({"Köln", "1"});
  table.add({"Bonn", "2"});
  CHECK(table.text() == "drive  n\nKöln   1\nBonn   2\n");
}

TEST_CASE("text table: a table too wide for the terminal goes on below itself") {
  TextTable table({"of", "first", "second", "third"});
  table.add({"a", "1", "2", "3"});
  const TextLook narrow{.colours = false, .columns = 17};
  CHECK(table.text(narrow) ==
        "of  first  second\n"
        "a       1       2\n"
        "of  third\n"
        "a       3\n");
  CHECK(table.text({.colours = false, .columns = 3}) ==
        "of  first\na       1\nof  second\na        2\nof  third\na       3\n");
}

TEST_CASE("text table: colours stand around the words and change no width") {
  TextTable table({"of", "n"});
  table.add({"a", "10"});
  table.paint(1, Tone::better);
  CHECK(table.text() == "of   n\na   10\n");
  CHECK(table.text({.colours = true, .columns = 0}) ==
        "\033[1mof\033[0m   \033[1mn\033[0m\na   \033[32m10\033[0m\n");
}

TEST_CASE("text table: what is fitted into a line neither leaves it nor steers the terminal") {
  CHECK(fitted("short", 5) == "short");
  CHECK(fitted("candump.log.gz", 10) == "candump...");
  CHECK(fitted("道路道路", 7) == "道路...");
  CHECK(fitted("abc", 2) == "..");
  CHECK(fitted("\033[31mred\r\n", 20) == "?[31mred??");
  CHECK(fitted("a\xe9\033[31m", 20) == "a??[31m");  // no UTF-8: the escape is no part of a character
  CHECK(fitted("\xc2\x9b"
               "31m",
               20) == "?31m");  // CSI as one character
}
