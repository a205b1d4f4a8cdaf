// Tables: alignment, widths and colours on the terminal; Markdown and CSV.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/tools/text/number_text.hpp>
#include <waymark/tools/text/table.hpp>

namespace table_test {

using namespace waymark;
using namespace waymark::text;

TEST_CASE(
    "table: columns of numbers are flush right, those of words flush left, and no line ends in spaces") {
  Table table{.columns = {"name", "unit", "value", "remark"}};
  table.rows.push_back({"gyro_bias", "rad/s", "-0.01", ""});
  table.rows.push_back({"scale", "1", "12.5", "not observed"});
  table.rows.push_back({"missing", "m", "-", ""});
  CHECK(table_text(table) ==
        "name       unit   value  remark\n"
        "gyro_bias  rad/s  -0.01\n"
        "scale      1       12.5  not observed\n"
        "missing    m          -\n");
}

TEST_CASE("table: width is counted in characters, not in bytes") {
  CHECK(display_width("Köln") == 4);
  CHECK(display_width("道路") == 4);  // two columns each
  Table table{.columns = {"drive", "n"}};
  table.rows.push_back({"Köln", "1"});
  table.rows.push_back({"Bonn", "2"});
  CHECK(table_text(table) == "drive  n\nKöln   1\nBonn   2\n");
}

TEST_CASE("table: a table too wide for the terminal goes on below itself") {
  Table table{.columns = {"of", "first", "second", "third"}};
  table.rows.push_back({"a", "1", "2", "3"});
  const TextLook narrow{.colours = false, .columns = 17};
  CHECK(table_text(table, narrow) ==
        "of  first  second\n"
        "a       1       2\n"
        "of  third\n"
        "a       3\n");
  CHECK(table_text(table, {.colours = false, .columns = 3}) ==
        "of  first\na       1\nof  second\na        2\nof  third\na       3\n");
}

TEST_CASE("table: colours stand around the words and change no width") {
  Table table{.columns = {"of", "n"}};
  table.rows.push_back({"a", "10"});
  table.tones[{0, 1}] = Tone::better;
  CHECK(table_text(table) == "of   n\na   10\n");
  CHECK(table_text(table, {.colours = true, .columns = 0}) ==
        "\033[1mof\033[0m   \033[1mn\033[0m\na   \033[32m10\033[0m\n");
}

TEST_CASE("table: title and notes enclose the columns, and a table of words has no column of numbers") {
  const Table table{.title = "T",
                    .columns = {"library", "version"},
                    .rows = {{"a", "10.1"}, {"bc", "9"}},
                    .notes = {"note"},
                    .words = true};
  CHECK(table_text(table) == "T\nlibrary  version\na        10.1\nbc       9\n  note\n");
  CHECK(aligned_columns({.rows = {{"a", "b"}, {"cd"}, {}}}) == "a   b\ncd\n\n");
  CHECK(table_text({}).empty());
  CHECK(indented("a\nb\n", 2) == "  a\n  b\n");
  CHECK(indented("a\n\nb", 1) == " a\n\n b");
}

TEST_CASE("table: cells are escaped for Markdown and CSV") {
  const Table table{
      .title = "T", .columns = {"a", "b"}, .rows = {{"x,y", "say \"z\""}, {"p|q", "1"}}, .notes = {"note"}};
  CHECK(table_csv(table) == "a,b\n\"x,y\",\"say \"\"z\"\"\"\np|q,1\n");
  CHECK(table_markdown(table) ==
        "## T\n\n| a | b |\n|---|---:|\n| x,y | say \"z\" |\n| p\\|q | 1 |\n\n- note\n");
}

TEST_CASE("table: an undefined number is a dash") {
  CHECK(decimals(std::nan(""), 2) == "-");
  CHECK(decimals(-0.125, 2) == "-0.12");
}

TEST_CASE("text look: what is fitted into a line neither leaves it nor steers the terminal") {
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

}  // namespace table_test
