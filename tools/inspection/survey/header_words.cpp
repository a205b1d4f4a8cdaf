#include <waymark/tools/inspection/survey/header_words.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

#include <waymark/formats/logs/detail/common/unit_words.hpp>

namespace waymark::inspection {
namespace {

/// Names of a quantity, in English, and those of test vehicles' tools in German, French and Spanish. Words are
/// separated by blanks.
struct Known {
  std::string_view quantity;
  std::string_view names;  ///< separated by '|'
};

constexpr std::array kKnown{
    Known{
        "time",
        "t|time|timestamp|time stamp|stamp|gps sow|gps tow|gps time|gps seconds|sow|tow|itow|seconds of week|"
        "time of week|t gps|t gps clock|gps week second|gps second|week second|week seconds|unix|unix time|epoch|posix time|t unix|utc|utc "
        "time|gps time unix|time unix|time utc|time gps|time epoch|seconds|secs|sec|datetime|date time|gps timestamp|host time|log time|"
        "t s|t utc|zeit|zeitstempel|horodatage|tiempo|hora|gpst|gpstime|gps seconds of week|gps time of week|rostime|ros time|header stamp|millis|micros"},
    Known{
        "latitude",
        "lat|latitude|gps lat|gps latitude|gnss lat|gnss latitude|pos lat|breite|breitengrad|geographische breite|latitud"},
    Known{"longitude",
          "lon|lng|long|longitude|gps lon|gps longitude|gnss lon|gnss longitude|gps lng|pos lon|"
          "länge|laenge|längengrad|laengengrad|geographische länge|longitud"},
    Known{"height",
          "h|alt|altitude|height|ele|elevation|ellipsoidal height|height ellipsoid|gps alt|gps altitude|hmsl|"
          "höhe|hoehe|hauteur|altura|altitud"},
    Known{"accuracy",
          "accuracy|hacc|h acc|h accuracy|eph|pos acc|position accuracy|pos accuracy|horizontal accuracy|acc "
          "h|gps accuracy|hpe|epe|accuracy horizontal|genauigkeit|précision|precision|precisión|"
          "drms|d rms|2drms|2 drms|2d rms|cep|cep50|cep 50|r95|cep95|cep 95"},
    Known{"accuracy_east", "epx|accuracy east|acc east|acc e"},
    Known{"accuracy_north", "epy|accuracy north|acc north|acc n"},
    Known{
        "sigma_east",
        "position covariance0|position covariance 0|longitude sigma|pos east stdev|sde|sd e|sd east|std e|std east|sigma e|sigma east|sigma lon|std lon|lon std|lon sigma"},
    Known{
        "sigma_north",
        "position covariance4|position covariance 4|latitude sigma|pos north stdev|sdn|sd n|sd north|std n|std north|sigma n|sigma north|sigma lat|std lat|lat std|lat sigma"},
    Known{"covariance_en_signed_root", "sdne|sdne signed root|position covariance1|position covariance 1"},
    Known{"velocity_east",
          "velocity east|vel east|east velocity|east vel|v east|speed east|ve|v e|vel e|velocity e|evel"},
    Known{
        "velocity_north",
        "velocity north|vel north|north velocity|north vel|v north|speed north|vn|v n|vel n|velocity n|nvel"},
    Known{"speed_accuracy", "speed acc|speed accuracy|s acc|sacc|speed sigma|eps"},
    Known{"course_accuracy",
          "heading acc|heading accuracy|course acc|course accuracy|head acc|epd|track accuracy"},
    Known{
        "course",
        "course|cog|track|bearing|course over ground|head mot|heading motion|gps course|gps heading|gcrs|kurs|kurs über grund|kurs ueber grund|rumbo"},
    Known{"heading", "heading|yaw|azimuth|hdg|psi|gierwinkel|lacet|guiñada"},
    Known{"valid", "valid|fix|fix valid|gps valid|position valid|pos valid|fix ok"},
    Known{"quality",
          "q|quality|fix quality|gga mode|gga quality|gps quality|gnss quality|fix type|fixtype|solution|sol "
          "type|solution type|rtk|rtk status|rtk state|status status|navsat status|mode"},
    Known{"hdop", "hdop|gps hdop|gnss hdop|h dop"},
    Known{
        "satellites",
        "satellites|sats|n sats|nsat|nsats|num sats|num sat|numsv|num sv|satellites used|sats used|n sv|sv used|"
        "number of satellites|siv"},
    Known{"correction_age", "correction age|age|diff age|dgps age|age of corrections|corr age|diffage"},
    Known{"date", "date|day|utc date|gps date|gnss date|datum|gps week|week|week number|wn|gpsweek"},
    Known{"latitude_hemisphere", "ns|n s|lat hemisphere|latitude hemisphere|lat dir|north south|lat ns"},
    Known{"longitude_hemisphere",
          "ew|e w|lon hemisphere|longitude hemisphere|lon dir|east west|lon ew|long ew"},
    Known{"gnss_time", "gnss epoch|gps epoch|epoch utc"},
    Known{
        "yaw_rate",
        "twist twist angular z|twist angular z|yaw rate|yawrate|yaw vel|yaw velocity|yawvel|omega|omega z|w|turn rate|yawrate projected|yaw rate "
        "projected|yawrate calibrated|yaw rate calibrated|yawrate raw|psi dot|psidot|vehicle yaw rate|"
        "gierrate|giergeschwindigkeit|vitesse de lacet|vitesse lacet|velocidad de guiñada"},
    Known{"reverse", "reverse|reverse gear|is reverse|backwards|gear reverse"},
    Known{
        "steering_angle",
        "steering angle|steering|steer angle|steer|steering wheel angle|swa|steer ang|lenkwinkel|lenkradwinkel|angle volant"},
    Known{"distance", "distance|odometer|odo|trip|travelled|distance travelled|mileage"},
    Known{"wheel_ticks", "ticks|wheel ticks|odo count|counts|counter|encoder|odo counter|pulses"},
    Known{
        "speed",
        "twist twist linear x|twist linear x|v|speed|velocity|vel|vehicle speed|v fwd|speed fwd|forward speed|forward velocity|ground "
        "speed|gspeed|"
        "g speed|sog|speed over ground|wheel speed|obd speed|can speed|speed obd|gps speed|speed2d|vel forward|velocity forward|spd|odo speed|vx|v x|veh speed|"
        "vehspd|vehiclespeed|s1 pid 0 d vehicle speed|wheel based vehicle speed|tachograph vehicle speed|"
        "geschwindigkeit|fahrzeuggeschwindigkeit|fahrgeschwindigkeit|vitesse|vitesse véhicule|velocidad"}};

/// Words that name a wheel.
constexpr std::array kWheels{Known{"front_left", "fl|lf|front left|left front|vl|front axle left"},
                             Known{"front_right", "fr|rf|front right|right front|vr|front axle right"},
                             Known{"rear_left", "rl|lr|rear left|left rear|hl|rear axle left"},
                             Known{"rear_right", "rr|rear right|right rear|hr|rear axle right"}};
/// Axes of an inertial unit.
constexpr std::array kInertial{
    Known{
        "gyro",
        "gyro|gyr|gyroscope|rate of rotation|rotation rate|angular rate|angle rate|angular velocity|angular vel|angvel|angularvelocity|rate|omega|w|ang rate"},
    Known{"acceleration", "acceleration|accel|acc|a|accelerometer|linear acceleration|specific force"}};

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
  if (quantity == "time" || quantity == "gnss_time" || quantity == "correction_age") return "time";
  if (quantity.starts_with("wheel_ticks") || quantity == "valid" || quantity == "reverse" ||
      quantity == "quality" || quantity == "hdop" || quantity == "satellites" || quantity == "date" ||
      quantity.ends_with("hemisphere"))
    return "";
  if (quantity.starts_with("acceleration")) return "acceleration";
  if (quantity == "yaw_rate" || quantity.starts_with("gyro")) return "rate";
  if (quantity.starts_with("wheel_speed") || quantity.starts_with("velocity_") || quantity == "speed" ||
      quantity == "speed_accuracy")
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
  const bool speeds = any_of({"speed", "speeds", "spd", "v", "wheelspeed", "ws", "whl", "wheelspd", "rpm"});
  for (const Known& wheel : kWheels) {
    for (std::size_t first = 0; first < words.size(); ++first) {
      for (const std::size_t length : {3U, 2U, 1U}) {
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
    const bool begins_with_axis = words.size() > 1 && (words[0] == "x" || words[0] == "y" || words[0] == "z");
    for (std::size_t length = 2; begins_with_axis && length <= 3 && length < words.size(); ++length)
      if (has_name(sensor.names, joined_words(words.subspan(1, length))))
        return std::string(sensor.quantity) + "_" + words[0];
    if (words.size() >= 1 && words[0].size() == 2 &&
        (words[0][1] == 'x' || words[0][1] == 'y' || words[0][1] == 'z'))
      if (((words[0][0] == 'w' || words[0][0] == 'g') && sensor.quantity == "gyro") ||
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

/// Returns the unit of a rate of which a word names the thousandth, "deg/s" for "mdps"; else empty.
std::string_view thousandth_in(const std::string& word) {
  if (word.size() < 3 || word.front() != 'm') return {};
  const std::string_view unit = formats::known_unit(word.substr(1));
  return !unit.empty() && dimension(unit) == "rate" ? unit : std::string_view();
}

/// A yaw in deg/s is a yaw rate, whatever its name.
void read_dimension(std::span<const std::string> words, ColumnProposal& proposal) {
  const bool is_rate = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const std::string_view unit = formats::known_unit(word);
    return (!unit.empty() && dimension(unit) == "rate") || !thousandth_in(word).empty();
  });
  if (is_rate && proposal.quantity == "heading") proposal.quantity = "yaw_rate";
}

void read_unit(std::span<const std::string> words, ColumnProposal& proposal) {
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const std::string_view unit = formats::known_unit(*word);
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

/// A wheel in rad/s or revolutions per minute turns by its radius.
void read_scale(std::span<const std::string> words, ColumnProposal& proposal) {
  constexpr double kRadius_m = 0.3;
  if (!proposal.quantity.starts_with("wheel_speed") || proposal.unit_known) return;
  const auto names = [&](std::string_view unit) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return word == unit || formats::known_unit(word) == unit;
    });
  };
  if (names("rad/s")) {
    proposal.scale = kRadius_m;
    proposal.remark = "rad/s of a wheel: the scale is its radius in m, about 0.3";
  } else if (names("rpm")) {
    proposal.scale = 0.0314;  // 2 pi / 60 of 0.3 m
    proposal.remark =
        "revolutions per minute of a wheel: the scale is 0.10472 times its radius in m, about 0.3";
  }
}

/// A rate in thousandths: "gyro_z_mdps".
void read_thousandths(std::span<const std::string> words, ColumnProposal& proposal) {
  if (proposal.unit_known || dimension_of(proposal.quantity) != "rate") return;
  for (const std::string& word : words) {
    const std::string_view unit = thousandth_in(word);
    if (unit.empty()) continue;
    proposal.unit = unit;
    proposal.unit_known = true;
    proposal.scale = 1e-3;
  }
}

/// Words that say what share of the errors a radius holds.
bool tells_meaning(const std::string& word) {
  static constexpr std::array<std::string_view, 14> kWords{
      "drms", "2drms", "d", "2d", "2", "rms", "cep", "cep50", "cep95", "r95", "95", "95%", "50", "50%"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

void read_meaning(std::span<const std::string> words, ColumnProposal& proposal) {
  if (proposal.quantity != "accuracy") return;
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  const bool drms = has("drms") || (has("d") && has("rms"));
  if (has("2drms") || (has("2") && drms) || (has("2d") && has("rms"))) {
    proposal.meaning = AccuracyMeaning::drms;
    proposal.scale = 0.5;
  } else if (has("r95") || has("cep95") || has("95") || has("95%")) {
    proposal.meaning = AccuracyMeaning::drms;
    proposal.scale = 0.578;  // sqrt(2) / 2.448: the radius of 95 % of normal errors of 1 per axis
    proposal.remark = "a radius that holds 95 % of the errors is 1 / 0.578 of their drms";
  } else if (drms) {
    proposal.meaning = AccuracyMeaning::drms;
  } else if (has("cep") || has("cep50")) {
    proposal.meaning = AccuracyMeaning::cep50;
  }
}

/// Earth-centred coordinates, "ecef_x" or "WlsPositionXEcefMeters"; but not those of satellites, and no velocity.
std::string ecef_of(std::span<const std::string> words) {
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  constexpr std::array<std::string_view, 11> kOthers{
      "sv", "sat", "satellite", "velocity", "vel", "v", "sigma", "accuracy", "std", "cov", "acceleration"};
  if (!has("ecef") || std::any_of(kOthers.begin(), kOthers.end(), has)) return {};
  for (const char* axis : {"x", "y", "z"})
    if (has(axis)) return std::string("ecef_") + axis;
  return {};
}

bool has_date(std::span<const std::string> words) {
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word == "date" || word == "datum"; });
}

/// The words tell how a status, a date or a variance is coded.
void read_code(std::span<const std::string> words, ColumnProposal& proposal) {
  if (proposal.quantity == "quality") {
    if (words.front() == "status" || words.front() == "navsat")
      proposal.unit = "ros";
    else if (words.front() == "q")
      proposal.unit = "rtklib";
    else if (words.front() != "gga")
      proposal.remark = "the numbers of RTKLIB (1 fixed), of ROS or of GGA (4 fixed) are meant";
  } else if (proposal.quantity == "date" && joined_words(words) != "day" && !has_date(words)) {
    proposal.unit = "gps_week";
  } else if (words.front() == "position" && words.size() > 1 && words[1].starts_with("covariance")) {
    proposal.unit = "m^2";
    proposal.unit_known = true;
  }
}

/// Tells whether words name a part of a velocity that is not the speed forward: "velocity_north".
bool names_component(std::span<const std::string> words) {
  static constexpr std::array<std::string_view, 8> kComponents{"north", "east", "n",    "e",
                                                               "ve",    "vn",   "down", "up"};
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return std::find(kComponents.begin(), kComponents.end(), word) != kComponents.end();
  });
}

bool is_coordinate(std::string_view quantity) {
  return quantity == "latitude" || quantity == "longitude";
}

/// "Breite [m]" is a width.
bool names_length(std::span<const std::string> words) {
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const std::string_view unit = formats::known_unit(word);
    return !unit.empty() && dimension(unit) == "length";
  });
}

/// Reads the words of a name.
ColumnProposal proposal_of(std::span<const std::string> words) {
  ColumnProposal proposal;
  proposal.quantity = ecef_of(words);
  if (!proposal.quantity.empty()) return proposal;
  proposal.quantity = part_of(words);
  std::size_t used = words.size();
  if (proposal.quantity.empty()) proposal.quantity = beginning_of(words, used);
  if (proposal.quantity.empty()) return proposal;
  const std::span<const std::string> rest = words.subspan(used);
  // "speed valid" is no speed. The words after the name must be a unit, a sense or a word that
  // changes nothing.
  const auto understood = [&](const std::string& word) {
    static constexpr std::array<std::string_view, 12> kHarmless{
        "cw", "ccw", "from", "east", "north", "flag", "raw", "value", "filtered", "clock", "gps", "gnss"};
    if (!thousandth_in(word).empty())
      return proposal.quantity == "heading" || dimension_of(proposal.quantity) == "rate";
    return !formats::known_unit(word).empty() || (proposal.quantity == "accuracy" && tells_meaning(word)) ||
           std::find(kHarmless.begin(), kHarmless.end(), word) != kHarmless.end();
  };
  if (!rest.empty() && !understood(rest.front())) return {};
  if (proposal.quantity == "speed" && names_component(rest)) return {};
  if (is_coordinate(proposal.quantity) && names_length(rest)) return {};
  read_dimension(rest, proposal);
  read_unit(rest.empty() ? words : rest, proposal);
  read_scale(words, proposal);
  read_thousandths(words, proposal);
  read_meaning(words, proposal);
  read_sense(words, proposal);
  read_code(words, proposal);
  const auto odd = std::find_if_not(rest.begin(), rest.end(), understood);
  if (odd != rest.end()) proposal.remark = "the name is not known from '" + *odd + "' on";
  return proposal;
}

/// Tells whether a byte is part of a word in UTF-8: those of "ä" to "ÿ" begin with 0xC3, "°" and "µ" with 0xC2.
/// Other signs beyond ASCII (dashes, hard blanks) separate words.
bool is_letter_or_digit(std::string_view name, std::size_t at) {
  constexpr unsigned char kLetters = 0xC3;
  constexpr unsigned char kSigns = 0xC2;
  const auto byte = [&](std::size_t i) {
    return i < name.size() ? static_cast<unsigned char>(name[i]) : static_cast<unsigned char>(0);
  };
  const auto is_sign = [](unsigned char second) { return second == 0xB0 || second == 0xB5; };
  if (byte(at) < 0x80) return std::isalnum(byte(at)) != 0;
  if (byte(at) == kLetters) return true;
  if (byte(at) == kSigns) return is_sign(byte(at + 1));
  const unsigned char lead = at > 0 ? byte(at - 1) : static_cast<unsigned char>(0);
  return lead == kLetters || (lead == kSigns && is_sign(byte(at)));
}

/// Returns a byte in small letters; of "Ä" to "Ý" the second one.
char small_letter(std::string_view name, std::size_t at) {
  const auto byte = static_cast<unsigned char>(name[at]);
  const bool is_second = at > 0 && static_cast<unsigned char>(name[at - 1]) == 0xC3;
  if (is_second && byte >= 0x80 && byte <= 0x9E) return static_cast<char>(byte + 0x20);
  return byte < 0x80 ? static_cast<char>(std::tolower(byte)) : name[at];
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
    } else if (!is_letter_or_digit(name, i)) {
      end_word();
    } else {
      const bool capital = std::isupper(static_cast<unsigned char>(c)) != 0;
      const bool after_small = i > 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
      const bool before_small = i > 0 && i + 1 < name.size() &&
                                std::isupper(static_cast<unsigned char>(name[i - 1])) != 0 &&
                                std::islower(static_cast<unsigned char>(name[i + 1])) != 0;
      const bool sign = static_cast<unsigned char>(c) == 0xC2;  // the first byte of a degree sign
      if ((capital && (after_small || before_small)) || sign) end_word();
      word += small_letter(name, i);
    }
  }
  end_word();
  return words;
}

bool names_receiver(std::string_view name) {
  static constexpr std::array<std::string_view, 8> kWords{"receiver", "antenna", "rover",    "device",
                                                          "rx",       "gnss id", "frame id", "source"};
  std::vector<std::string> words = words_of(name);
  if (words.size() > 1 && (words.back() == "id" || words.back() == "name") && words.front() != "frame")
    words.pop_back();
  const std::string text = joined_words(words);
  return std::find(kWords.begin(), kWords.end(), text) != kWords.end();
}

ColumnProposal propose_quantity(std::string_view name) {
  const std::vector<std::string> all = words_of(name);
  std::span<const std::string> words(all);
  // rostopic writes "field." before the name of each member, and "%time" for when a message was recorded.
  if (words.size() > 1 && words.front() == "field") words = words.subspan(1);
  ColumnProposal proposal = proposal_of(words);
  // PlotJuggler writes topics before the members: "/odom/twist/twist/linear/x".
  // Of a member of one letter the topic tells what it is: "/odom/pose/pose/orientation/w".
  while (name.starts_with('/') && proposal.quantity.empty() && words.size() > 1 &&
         (words.size() > 2 || words.back().size() > 1)) {
    proposal = proposal_of(words = words.subspan(1));
    if (!proposal.quantity.empty() && proposal.remark.empty()) proposal.remark = "its topic is not looked at";
  }
  if (name == "%time") proposal.remark = "it is when the message was recorded";
  return proposal;
}

}  // namespace waymark::inspection
