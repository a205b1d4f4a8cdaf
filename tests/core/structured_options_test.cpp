// Options with lists, mappings, texts and files: what they may be, and what is said about wrong ones.
#include <catch2/catch.hpp>

#include <waymark/core/registry/flow_text.hpp>
#include <waymark/core/registry/options.hpp>

namespace structured_options_test {

using namespace waymark;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

OptionInfo number(const std::string& name, const std::string& value, bool required = false) {
  return {.name = name,
          .value = value,
          .unit = "m",
          .allowed = OptionRange{-100, 100},
          .text = "a number",
          .required = required};
}

/// Options as a range sensor would have them: anchors by name, a bias list, a file.
std::vector<OptionInfo> known() {
  const OptionInfo anchor{.allowed =
                              OptionRecord{{number("x", "", true), number("y", "", true), number("z", "2")}}};
  return {{.name = "anchors", .value = "{}", .allowed = mapping_of(anchor), .text = "the anchors"},
          {.name = "biases", .value = "[0, 0]", .allowed = list_of(number("", ""), 2, 3), .text = "biases"},
          {.name = "map", .value = "", .allowed = OptionText{true}, .text = "the map"},
          {.name = "satellites",
           .value = "[]",
           .allowed = list_of({.allowed = OptionWords{"G", "E"}}),
           .text = "systems"}};
}

CheckedOptions checked(const Options& given) {
  const std::vector<OptionInfo> all = known();
  return {"uwb", given, all};
}

std::string error_of(const Options& given) {
  try {
    (void)checked(given);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("structured options: a mapping of records gives every number and the defaults") {
  const CheckedOptions options =
      checked({{"anchors", "{a1: {x: 1.5, y: -2}, \"north gate\": {x: 0, y: 3, z: 4}}"}});
  const OptionValue& anchors = options.value("anchors");
  REQUIRE(anchors.entries().size() == 2);
  CHECK(anchors.at("a1").at("x").number() == 1.5);
  CHECK(anchors.at("a1").at("y").number() == -2);
  CHECK(anchors.at("a1").at("z").number() == 2);
  CHECK(anchors.at("north gate").at("z").number() == 4);
  CHECK(options.value("biases").numbers() == std::vector<double>{0, 0});
  CHECK(options.word("map").empty());
}

TEST_CASE("structured options: a list gives its elements") {
  const CheckedOptions options = checked({{"biases", "[1, -2.5, 3e1]"}, {"satellites", "[E, G, E]"}});
  CHECK(options.value("biases").numbers() == std::vector<double>{1, -2.5, 30});
  REQUIRE(options.value("satellites").list().size() == 3);
  CHECK(options.value("satellites").list()[0].text() == "E");
}

TEST_CASE("structured options: an error names the place within the value") {
  CHECK_THAT(error_of({{"anchors", "{a1: {x: 1, y: far}}"}}),
             Equals("uwb: option 'anchors.a1.y' must be a number, got 'far'"));
  CHECK_THAT(error_of({{"anchors", "{a1: {x: 101, y: 0}}"}}),
             Equals("uwb: option 'anchors.a1.x' must lie in [-100, 100], got 101"));
  CHECK_THAT(error_of({{"anchors", "{a1: {y: 0}}"}}),
             Equals("uwb: option 'anchors.a1.x' must be given, got nothing"));
  CHECK_THAT(error_of({{"anchors", "{a1: {x: 1, yy: 0}}"}}),
             Contains("uwb: option 'anchors.a1': unknown key 'yy'") && Contains("did you mean 'y'?"));
  CHECK_THAT(error_of({{"biases", "[1]"}}), Equals("uwb: option 'biases' must have 2 to 3 elements, got 1"));
  CHECK_THAT(error_of({{"biases", "[1, [2]]"}}),
             Equals("uwb: option 'biases[2]' must be a number, got a list"));
  CHECK_THAT(error_of({{"biases", "7"}}), Equals("uwb: option 'biases' must be a list, got '7'"));
  CHECK_THAT(error_of({{"satellites", "[R]"}}),
             Equals("uwb: option 'satellites[1]' must be 'G' or 'E', got 'R'"));
  CHECK_THAT(error_of({{"biases", "[1, 2"}}), Contains("expected ',' or ']' at character 6"));
}

TEST_CASE("structured options: one that is required must be given") {
  const std::vector<OptionInfo> needs{number("rate", "", true)};
  CHECK_THROWS_WITH(CheckedOptions("uwb", {}, needs),
                    "uwb: option 'rate' must be given: a number; in [-100, 100]");
  CHECK(CheckedOptions("uwb", {{"rate", "5"}}, needs).number("rate") == 5);
}

TEST_CASE("structured options: the description says what is allowed") {
  const std::vector<OptionInfo> all = known();
  CHECK(
      all[0].description() ==
      "the anchors; mapping of names to {x: number m in [-100, 100], y: number m in [-100, 100], z: number m "
      "in [-100, 100], default 2}");
  CHECK(all[1].description() == "biases; list of 2 to 3: number m in [-100, 100]");
  CHECK(all[2].description() == "the map; a file");
  CHECK(all[3].description() == "systems; list of 'G' or 'E'");
}

TEST_CASE("structured options: files are below the folder of the drive unless they are absolute") {
  const std::vector<OptionInfo> all = known();
  CHECK(with_files_below("/data/run", {{"map", "a.csv"}}, all) == Options{{"map", "/data/run/a.csv"}});
  CHECK(with_files_below("/data/run", {{"map", "/a.csv"}}, all) == Options{{"map", "/a.csv"}});
  CHECK(with_files_below("/data/run", {{"biases", "[1, 2]"}}, all) == Options{{"biases", "[1, 2]"}});
  const std::vector<OptionInfo> nested{
      {.name = "maps", .value = "[]", .allowed = list_of({.allowed = OptionText{true}}), .text = "maps"}};
  CHECK(with_files_below("/d", {{"maps", "[a, /b]"}}, nested) == Options{{"maps", "[/d/a, /b]"}});
}

TEST_CASE("structured options: reading a value as what it is not is an error of the type") {
  const CheckedOptions options = checked({});
  CHECK_THROWS_AS(options.number("biases"), std::logic_error);
  CHECK_THROWS_AS(options.value("anchors").at("a9"), std::logic_error);
  CHECK_THROWS_AS(options.value("nothing"), std::logic_error);
}

TEST_CASE("flow text: parsing the written text gives the same value") {
  for (const char* text : {"[]", "{}", "[1, 2, [3, x]]", "{a: 1, b: {c: [d, e]}}",
                           R"(["with blank", "quote \" and \\"])", R"({"key: odd": "", x: "a:"})"}) {
    CAPTURE(text);
    CHECK(flow_text(parse_flow(text)) == text);
  }
  CHECK(flow_text(parse_flow("plain text, as it is")) == "plain text, as it is");
  CHECK_THROWS_WITH(parse_flow("[1] 2"), "expected nothing more at character 5");
  CHECK_THROWS_WITH(parse_flow("{a 1}"), "expected ':' at character 4");
  CHECK_THROWS_WITH(parse_flow("{a: 1, a: 2}"), Contains("no second 'a'"));
  CHECK_THROWS_AS(parse_flow(std::string(100, '[')), UsageError);
}

}  // namespace structured_options_test
