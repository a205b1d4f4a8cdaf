#include <waymark/formats/logs/detail/common/unit_words.hpp>

#include <array>
#include <string>

namespace waymark::formats {
namespace {

struct UnitAlias {
  std::string_view written;  ///< in small letters
  std::string_view name;
};
constexpr std::array<UnitAlias, 81> kUnitAliases{{
    {"m/s", "m/s"},
    {"mps", "m/s"},
    {"meter/sec", "m/s"},
    {"km/h", "km/h"},
    {"kph", "km/h"},
    {"kmh", "km/h"},
    {"kmph", "km/h"},
    {"km/hr", "km/h"},
    {"kilometers/hour", "km/h"},
    {"mph", "mph"},
    {"mi/h", "mph"},
    {"kn", "kn"},
    {"kt", "kn"},
    {"kts", "kn"},
    {"knots", "kn"},
    {"mm/s", "mm/s"},
    {"rad/s", "rad/s"},
    {"degs", "deg/s"},
    {"unix time", "s"},
    {"rad/sec", "rad/s"},
    {"deg/s", "deg/s"},
    {"deg/sec", "deg/s"},
    {"dps", "deg/s"},
    {"°/s", "deg/s"},
    {"°/sec", "deg/s"},
    {"degree/s", "deg/s"},
    {"degrees/s", "deg/s"},
    {"deg", "deg"},
    {"degree", "deg"},
    {"degrees", "deg"},
    {"°", "deg"},
    {"rad", "rad"},
    {"m", "m"},
    {"meter", "m"},
    {"meters", "m"},
    {"metre", "m"},
    {"cm", "cm"},
    {"mm", "mm"},
    {"m/s^2", "m/s^2"},
    {"m/s2", "m/s^2"},
    {"m/s²", "m/s^2"},
    {"m/s/s", "m/s^2"},
    {"m/ss", "m/s^2"},
    {"m/(s^2)", "m/s^2"},
    {"mps2", "m/s^2"},
    {"g", "g"},
    {"s", "s"},
    {"sec", "s"},
    {"seconds", "s"},
    {"ms", "ms"},
    {"us", "us"},
    {"ns", "ns"},
    {"ms-1", "m/s"},
    {"m/sec", "m/s"},
    {"kmh-1", "km/h"},
    {"knot", "kn"},
    {"mmps", "mm/s"},
    {"radps", "rad/s"},
    {"rps", "rad/s"},
    {"degps", "deg/s"},
    {"degree/sec", "deg/s"},
    {"radian", "rad"},
    {"radians", "rad"},
    {"metres", "m"},
    {"centimeter", "cm"},
    {"millimeter", "mm"},
    {"second", "s"},
    {"secs", "s"},
    {"msec", "ms"},
    {"usec", "us"},
    {"\xC2\xB5s", "us"},
    {"nsec", "ns"},
    {"millis", "ms"},
    {"micros", "us"},
    {"nanos", "ns"},
    {"0.001 s", "ms"},
    {"0.01 m", "cm"},
    {"m^2", "m^2"},
    {"m2", "m^2"},
    {"m\xC2\xB2", "m^2"},
    {"1e-7deg", "1e-7deg"},
}};

}  // namespace

std::string_view known_unit(std::string_view word) {
  std::string written(word);
  for (char& c : written) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  for (const UnitAlias& alias : kUnitAliases) {
    if (alias.written == written) return alias.name;
  }
  return {};
}

}  // namespace waymark::formats
