// Options of registered types: names and values are checked once, and errors carry their parts as data.
#include <stdexcept>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/registry.hpp>

namespace options_test {

using namespace waymark;

namespace {

const std::vector<OptionInfo>& known() {
  static const std::vector<OptionInfo> value = {
      {"radius", "1", "m", OptionRange{1e-6, 1e4}, "first radius"},
      {"share", "0.5", "", OptionRange{.low = 0, .high = 1, .low_open = true, .high_open = true}, "of it"},
      {"rate", "1", "Hz", OptionRange{.low = 0, .low_open = true}, "of the clock"},
      {"error", "decoupled", "", OptionWords{"decoupled", "literal"}, "'decoupled' or 'literal'"}};
  return value;
}

CheckedOptions check(const Options& given) {
  return CheckedOptions("g1", given, known());
}

/// The error that these options cause.
OptionError error_of(const Options& given) {
  try {
    (void)check(given);
  } catch (const OptionError& error) {
    return error;
  }
  throw std::logic_error("the options were accepted");
}

void check_refused(const char* option, const std::string& value, const std::string& message) {
  INFO(option << " = " << value);
  const OptionError error = error_of({{option, value}});
  CHECK(error.what() == "g1: " + message);
  CHECK(error.owner() == "g1");
  CHECK(error.option() == option);
  CHECK(error.value() == value);
}

}  // namespace

TEST_CASE("options: what nobody gives has its default") {
  const CheckedOptions options = check({{"radius", "2.5e-1"}, {"error", "literal"}});
  CHECK(options.owner() == "g1");
  CHECK(options.number("radius") == 0.25);
  CHECK(options.number("share") == 0.5);
  CHECK(options.word("error") == "literal");
  CHECK(check({}).word("error") == "decoupled");
}

TEST_CASE("options: a closed range holds its bounds, an open one does not") {
  CHECK(check({{"radius", "1e-6"}}).number("radius") == 1e-6);
  CHECK(check({{"radius", "10000"}}).number("radius") == 1e4);
  check_refused("radius", "10000.1", "option 'radius' must lie in [1e-6, 1e4], got 10000.1");
  check_refused("radius", "0", "option 'radius' must lie in [1e-6, 1e4], got 0");
  CHECK(check({{"share", "1e-300"}}).number("share") == 1e-300);
  check_refused("share", "0", "option 'share' must lie in (0, 1), got 0");
  check_refused("share", "1", "option 'share' must lie in (0, 1), got 1");
  CHECK(check({{"rate", "1e300"}}).number("rate") == 1e300);
  check_refused("rate", "-0.0", "option 'rate' must lie in (0, inf), got -0.0");
}

TEST_CASE("options: what is no finite number is refused whatever the range") {
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1 ", "1m", "0x10", "one"}) {
    check_refused("rate", text, "option 'rate' must be a number, got '" + std::string(text) + "'");
  }
}

TEST_CASE("options: a word is one of those that are allowed") {
  check_refused("error", "Literal", "option 'error' must be 'decoupled' or 'literal', got 'Literal'");
  check_refused("error", "", "option 'error' must be 'decoupled' or 'literal', got ''");
}

TEST_CASE("options: an unknown name is told with the nearest one, or with all") {
  check_refused("raduis", "1", "unknown option 'raduis'; did you mean 'radius'?");
  check_refused("colour", "red", "unknown option 'colour'; it has radius, share, rate, error");
  CHECK_THROWS_WITH(CheckedOptions("plain", {{"radius", "1"}}, {}),
                    "plain: unknown option 'radius'; it has none");
}

TEST_CASE("options: reading what is not declared is a defect of the program, not of its user") {
  const CheckedOptions options = check({});
  CHECK_THROWS_AS(options.number("raduis"), std::logic_error);
  CHECK_THROWS_AS(options.number("error"), std::logic_error);
  CHECK_THROWS_AS(options.word("radius"), std::logic_error);
}

TEST_CASE("options: the description ends with the range, as people write numbers") {
  const auto described = [](OptionRange range) {
    return OptionInfo{"x", "1", "", range, "text"}.description();
  };
  CHECK(described({1e-12, 1e6}) == "text; in [1e-12, 1e6]");
  CHECK(described({-100, 100}) == "text; in [-100, 100]");
  CHECK(described({0.1, 1e4}) == "text; in [0.1, 1e4]");
  CHECK(described({2.5e-7, 360}) == "text; in [2.5e-7, 360]");
  CHECK(described({.low = 0, .high = 1e100, .low_open = true}) == "text; in (0, 1e100]");
  CHECK(known().back().description() == "'decoupled' or 'literal'");
}

/// What the registry says of a sensor whose option `sigma` has this prior; empty: it takes it.
std::string refusal(const NoisePrior& prior) {
  SensorModelType type;
  type.name = "radar";
  type.options = known();
  type.options.push_back({.name = "sigma", .value = "1", .allowed = OptionRange{1e-3, 10}, .prior = prior});
  TypeRegistry registry;
  try {
    registry.add_sensor_model(type);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("options: a prior that cannot be meant is refused when its type is registered") {
  CHECK(refusal({.mean = 1, .deviation = 0.5}).empty());
  CHECK(refusal({.mean = 1, .where_option = "error", .where_word = "literal"}).empty());
  const std::string begin = "radar of waymark: the prior of option 'sigma' ";
  CHECK(refusal({.mean = 11}) == begin + "has its mean outside [1e-3, 10]");
  CHECK(refusal({.mean = 1, .deviation = 0}) == begin + "needs a deviation above 0");
  CHECK(refusal({.mean = 1, .where_option = "errors", .where_word = "literal"}) ==
        begin + "names an option 'errors' that is not there");
  CHECK(refusal({.mean = 1, .where_option = "error", .where_word = "litteral"}) ==
        begin + "names a word 'litteral' that option 'error' does not have");
  CHECK(refusal({.mean = 1, .where_option = "radius", .where_word = "1"}) ==
        begin + "names a word '1' that option 'radius' does not have");
}

TEST_CASE("options: those of a search for noise must be there") {
  SensorModelType type;
  type.name = "radar";
  type.options = known();
  type.noise_search.options = {{"eror", "literal"}};
  TypeRegistry registry;
  CHECK_THROWS_WITH(registry.add_sensor_model(type),
                    "radar of waymark: noise_search: unknown option 'eror'; did you mean 'error'?");
}

}  // namespace options_test
