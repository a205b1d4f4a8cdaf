#include <waymark/tools/inspection/survey/header_words.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace waymark::inspection {
namespace {

/// Names of a quantity. Words are separated by blanks.
struct Known {
  std::string_view quantity;
  std::string_view names;  ///< separated by '|'
};

constexpr std::array kKnown{
    Known{
        "time",
        "t|time|timestamp|time stamp|stamp|gps sow|gps tow|gps time|gps seconds|sow|tow|itow|seconds of week|"
        "time of week|t gps|t gps clock|gps week second|unix|unix time|epoch|posix time|t unix|utc|utc "
        "time|gps time unix|time unix|seconds|secs|sec|datetime|date time|gps timestamp|host time|log time|"
        "t s|gpst|rostime|ros time|header stamp"},
    Known{"latitude", "lat|latitude|gps lat|gps latitude|gnss lat|gnss latitude"},
    Known{"longitude", "lon|lng|long|longitude|gps lon|gps longitude|gnss lon|gnss longitude|gps lng"},
    Known{
        "height",
        "h|alt|altitude|height|ele|elevation|ellipsoidal height|height ellipsoid|gps alt|gps altitude|hmsl"},
    Known{"accuracy",
          "accuracy|hacc|h acc|eph|pos acc|position accuracy|pos accuracy|horizontal accuracy|acc "
          "h|gps accuracy|hpe|epe|accuracy horizontal"},
    Known{"accuracy_east", "epx|accuracy east|acc east|acc e"},
    Known{"accuracy_north", "epy|accuracy north|acc north|acc n"},
    Known{"sigma_east",
          "sde|sd e|sd east|std e|std east|sigma e|sigma east|sigma lon|std lon|lon std|lon sigma"},
    Known{"sigma_north",
          "sdn|sd n|sd north|std n|std north|sigma n|sigma north|sigma lat|std lat|lat std|lat sigma"},
    Known{"covariance_en_signed_root", "sdne|sdne signed root"},
    Known{"speed_accuracy", "speed acc|speed accuracy|s acc|sacc|speed sigma|eps"},
    Known{"course_accuracy",
          "heading acc|heading accuracy|course acc|course accuracy|head acc|epd|track accuracy"},
    Known{"course",
          "course|cog|track|bearing|course over ground|head mot|heading motion|gps course|gps heading"},
    Known{"heading", "heading|yaw|azimuth|hdg|psi"},
    Known{"valid",
          "valid|fix|fix valid|gps valid|position valid|pos valid|q|quality|fix quality|gga mode|gga "
          "quality|fix ok"},
    Known{"gnss_time", "gnss epoch|gps epoch|epoch utc"},
    Known{"yaw_rate",
          "yaw rate|yawrate|yaw vel|yaw velocity|yawvel|omega|omega z|w|turn rate|yawrate projected|yaw rate "
          "projected|yawrate calibrated|yaw rate calibrated|yawrate raw|psi dot|psidot|vehicle yaw rate"},
    Known{"reverse", "reverse|reverse gear|is reverse|backwards|gear reverse"},
    Known{"steering_angle", "steering angle|steering|steer angle|steer|steering wheel angle|swa|steer ang"},
    Known{"distance", "distance|odometer|odo|trip|travelled|distance travelled|mileage"},
    Known{"wheel_ticks", "ticks|wheel ticks|odo count|counts|counter|encoder|odo counter|pulses"},
    Known{
        "speed",
        "v|speed|velocity|vel|vehicle speed|v fwd|speed fwd|forward speed|forward velocity|ground "
        "speed|gspeed|"
        "g speed|sog|speed over ground|wheel speed|obd speed|can speed|gps speed|odo speed|vx|v x|veh speed|"
        "vehspd|vehiclespeed|s1 pid 0 d vehicle speed"}};

/// Words that name a wheel.
constexpr std::array kWheels{Known{"front_left", "fl|lf|front left|left front|vl"},
                             Known{"front_right", "fr|rf|front right|right front|vr"},
                             Known{"rear_left", "rl|lr|rear left|left rear|hl"},
                             Known{"rear_right", "rr|rear right|right rear|hr"}};
/// Axes of an inertial unit.
constexpr std::array kInertial{
    Known{
        "gyro",
        "gyro|gyr|gyroscope|angular rate|angular velocity|angular vel|angularvelocity|rate|omega|w|ang rate"},
    Known{"acceleration", "acceleration|accel|acc|a|accelerometer|linear acceleration|specific force"}};

struct UnitWord {
  std::string_view word, unit;
};
constexpr std::array kUnits{
    UnitWord{"mps", "m/s"},     UnitWord{"m/s", "m/s"},     UnitWord{"ms-1", "m/s"},
    UnitWord{"kmh", "km/h"},    UnitWord{"kph", "km/h"},    UnitWord{"kmph", "km/h"},
    UnitWord{"km/h", "km/h"},   UnitWord{"mph", "mph"},     UnitWord{"kn", "kn"},
    UnitWord{"kt", "kn"},       UnitWord{"kts", "kn"},      UnitWord{"knots", "kn"},
    UnitWord{"mm/s", "mm/s"},   UnitWord{"mmps", "mm/s"},   UnitWord{"radps", "rad/s"},
    UnitWord{"rad/s", "rad/s"}, UnitWord{"rps", "rad/s"},   UnitWord{"degps", "deg/s"},
    UnitWord{"dps", "deg/s"},   UnitWord{"deg/s", "deg/s"}, UnitWord{"deg", "deg"},
    UnitWord{"degrees", "deg"}, UnitWord{"rad", "rad"},     UnitWord{"m", "m"},
    UnitWord{"meters", "m"},    UnitWord{"metres", "m"},    UnitWord{"cm", "cm"},
    UnitWord{"mm", "mm"},       UnitWord{"s", "s"},         UnitWord{"sec", "s"},
    UnitWord{"ms", "ms"},       UnitWord{"msec", "ms"},     UnitWord{"us", "us"},
    UnitWord{"ns", "ns"},       UnitWord{"nsec", "ns"},     UnitWord{"mps2", "m/s^2"},
    UnitWord{"m/s2", "m/s^2"},  UnitWord{"m/s^2", "m/s^2"}, UnitWord{"g", "g"}};

std::string joined_words(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

bool has_name(std::string_view names, std::string_view name) {
  while (true) {
    const std::size_t end = names.find('|');
    if (names.substr(0, end) == name) return true;
    if (end == std::string_view::npos) return false;
    names.remove_prefix(end + 1);
  }
}

std::string_view unit_of(std::string_view word) {
  for (const UnitWord& known : kUnits) {
    if (known.word == word) return known.unit;
  }
  return {};
}

/// Returns the dimension of a unit.
std::string_view dimension(std::string_view unit) {
  if (unit == "m/s" || unit == "km/h" || unit == "mph" || unit == "kn" || unit == "mm/s") return "speed";
  if (unit == "rad/s" || unit == "deg/s") return "rate";
  if (unit == "deg" || unit == "rad") return "angle";
  if (unit == "m" || unit == "cm" || unit == "mm") return "length";
  if (unit == "s" || unit == "ms" || unit == "us" || unit == "ns") return "time";
  return "acceleration";
}

std::string_view dimension_of(std::string_view quantity) {
  if (quantity == "time" || quantity == "gnss_time") return "time";
  if (quantity.starts_with("wheel_ticks") || quantity == "valid" || quantity == "reverse") return "";
  if (quantity.starts_with("acceleration")) return "acceleration";
  if (quantity == "yaw_rate" || quantity.starts_with("gyro")) return "rate";
  if (quantity.starts_with("wheel_speed") || quantity == "speed" || quantity == "speed_accuracy")
    return "speed";
  if (quantity.starts_with("course") || quantity == "heading" || quantity == "latitude" ||
      quantity == "longitude" || quantity == "steering_angle")
    return "angle";
  return "length";
}

/// Returns the wheel or axis in a name such as {wheel, speed, fl} or {gyro, x}; empty if
/// there is none.
std::string part_of(std::span<const std::string> words) {
  const auto any_of = [&](std::initializer_list<std::string_view> some) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return std::find(some.begin(), some.end(), word) != some.end();
    });
  };
  const bool ticks = any_of({"ticks", "tick", "counts", "count", "pulses", "encoder"});
  const bool speeds = any_of({"speed", "speeds", "spd", "v", "wheelspeed", "ws", "whl", "wheelspd"});
  for (const Known& wheel : kWheels) {
    for (std::size_t first = 0; first < words.size(); ++first) {
      for (const std::size_t length : {2U, 1U}) {
        if (first + length > words.size()) continue;
        if (!has_name(wheel.names, joined_words(words.subspan(first, length)))) continue;
        if (ticks) return "wheel_ticks_" + std::string(wheel.quantity);
        if (speeds) return "wheel_speed_" + std::string(wheel.quantity);
      }
    }
  }
  for (const Known& sensor : kInertial) {
    for (std::size_t length = 1; length + 1 <= words.size() && length <= 2; ++length) {
      for (std::size_t first = 0; first + length < words.size(); ++first) {
        const std::string& axis = words[first + length];
        if (axis != "x" && axis != "y" && axis != "z") continue;
        if (has_name(sensor.names, joined_words(words.subspan(first, length))))
          return std::string(sensor.quantity) + "_" + axis;
      }
    }
    if (words.size() >= 1 && words[0].size() == 2 &&
        (words[0][1] == 'x' || words[0][1] == 'y' || words[0][1] == 'z'))
      if ((words[0][0] == 'w' && sensor.quantity == "gyro") ||
          (words[0][0] == 'a' && sensor.quantity == "acceleration"))
        return std::string(sensor.quantity) + "_" + words[0][1];
  }
  return {};
}

/// Returns the quantity of the longest known beginning of the name. @param used how many
/// words it has
std::string beginning_of(std::span<const std::string> words, std::size_t& used) {
  for (used = words.size(); used > 0; --used) {
    const std::string name = joined_words(words.first(used));
    for (const Known& known : kKnown) {
      if (has_name(known.names, name)) return std::string(known.quantity);
    }
  }
  return {};
}

void read_unit(std::span<const std::string> words, ColumnProposal& proposal) {
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const std::string_view unit = unit_of(*word);
    if (unit.empty() || dimension(unit) != dimension_of(proposal.quantity)) continue;
    proposal.unit = unit;
    proposal.unit_known = true;
    return;
  }
}

void read_sense(std::span<const std::string> words, ColumnProposal& proposal) {
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  const bool clockwise = has("cw") || has("clockwise");
  const bool counter = has("ccw") || has("counterclockwise");
  if (proposal.quantity == "yaw_rate") {
    if (clockwise) proposal.convention = "cw";
    return;
  }
  if (proposal.quantity != "heading" && proposal.quantity != "course") return;
  if (counter && has("east")) proposal.convention = "ccw_from_east";
  if (clockwise && has("north")) proposal.convention = "cw_from_north";
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(std::move(word));
    word.clear();
  };
  // Units in brackets are kept whole: "speed [km/h]", "a (m/s^2)".
  bool in_unit = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (c == '[' || c == '(') {
      end_word();
      in_unit = true;
    } else if (c == ']' || c == ')') {
      end_word();
      in_unit = false;
    } else if (in_unit) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
      end_word();
    } else {
      const bool capital = std::isupper(static_cast<unsigned char>(c)) != 0;
      const bool after_small = i > 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
      const bool before_small = i > 0 && i + 1 < name.size() &&
                                std::isupper(static_cast<unsigned char>(name[i - 1])) != 0 &&
                                std::islower(static_cast<unsigned char>(name[i + 1])) != 0;
      if (capital && (after_small || before_small)) end_word();
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  end_word();
  return words;
}

ColumnProposal propose_quantity(std::string_view name) {
  ColumnProposal proposal;
  const std::vector<std::string> all = words_of(name);
  std::span<const std::string> words(all);
  proposal.quantity = part_of(words);
  std::size_t used = words.size();
  if (proposal.quantity.empty()) proposal.quantity = beginning_of(words, used);
  if (proposal.quantity.empty()) return proposal;
  const std::span<const std::string> rest = words.subspan(used);
  // "speed valid" is no speed. The words after the name must be a unit, a sense or a word that
  // changes nothing.
  const auto understood = [](const std::string& word) {
    static constexpr std::array<std::string_view, 12> kHarmless{
        "cw", "ccw", "from", "east", "north", "flag", "raw", "value", "filtered", "clock", "gps", "gnss"};
    return !unit_of(word).empty() || std::find(kHarmless.begin(), kHarmless.end(), word) != kHarmless.end();
  };
  if (!rest.empty() && !understood(rest.front())) return {};
  read_unit(rest.empty() ? words : rest, proposal);
  read_sense(words, proposal);
  const auto odd = std::find_if_not(rest.begin(), rest.end(), understood);
  if (odd != rest.end()) proposal.remark = "the name is not known from '" + *odd + "' on";
  return proposal;
}

}  // namespace waymark::inspection
