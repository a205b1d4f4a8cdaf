#include <waymark/formats/logs/detail/can/dbc_set.hpp>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace waymark::formats {
namespace {

/// Extended ids have 2147483648 added; those of J1939 end in the null address FE.
constexpr std::string_view kStandard = R"(BO_ 2024 OBD2: 8 ECU
 SG_ Service M : 8|8@1+ (1,0) [0|255] "" X
 SG_ Parameter m65M : 16|8@1+ (1,0) [0|255] "" X
 SG_ VehicleSpeed m13 : 24|8@1+ (1,0) [0|255] "km/h" X
BO_ 2564485392 OBD2_EXTENDED: 8 ECU
 SG_ Service M : 8|8@1+ (1,0) [0|255] "" X
 SG_ Parameter m65M : 16|8@1+ (1,0) [0|255] "" X
 SG_ VehicleSpeed m13 : 24|8@1+ (1,0) [0|255] "km/h" X
BO_ 2566844926 CCVS1: 8 J1939
 SG_ WheelBasedVehicleSpeed : 8|16@1+ (0.00390625,0) [0|250.996] "km/h" X
BO_ 2365484286 TCO1: 8 J1939
 SG_ TachographVehicleSpeed : 48|16@1+ (0.00390625,0) [0|250.996] "km/h" X
BO_ 2565868030 VDC2: 8 J1939
 SG_ SteeringWheelAngle : 0|16@1+ (0.0009765625,-31.374) [-31.374|31.374] "rad" X
 SG_ YawRate : 24|16@1+ (0.0001220703125,-3.92) [-3.92|3.92] "rad/s" X
BO_ 2298375934 HRW: 8 J1939
 SG_ FrontAxleLeftWheelSpeed : 0|16@1+ (0.00390625,0) [0|250.996] "km/h" X
 SG_ FrontAxleRightWheelSpeed : 16|16@1+ (0.00390625,0) [0|250.996] "km/h" X
 SG_ RearAxleLeftWheelSpeed : 32|16@1+ (0.00390625,0) [0|250.996] "km/h" X
 SG_ RearAxleRightWheelSpeed : 48|16@1+ (0.00390625,0) [0|250.996] "km/h" X
BO_ 2566845438 VehiclePosition: 8 J1939
 SG_ Latitude : 0|32@1+ (1e-07,-210) [-210|211.1] "deg" X
 SG_ Longitude : 32|32@1+ (1e-07,-210) [-210|211.1] "deg" X
BO_ 2566842622 VehicleDirectionSpeed: 8 J1939
 SG_ CompassBearing : 0|16@1+ (0.0078125,0) [0|501.99] "deg" X
 SG_ NavigationBasedVehicleSpeed : 16|16@1+ (0.00390625,0) [0|250.996] "km/h" X
SG_MUL_VAL_ 2024 Parameter Service 65-65;
SG_MUL_VAL_ 2024 VehicleSpeed Parameter 13-13;
SG_MUL_VAL_ 2564485392 Parameter Service 65-65;
SG_MUL_VAL_ 2564485392 VehicleSpeed Parameter 13-13;
)";

bool are_alike(const DbcMessage& first, const DbcMessage& second) {
  const auto alike = [](const DbcSignal& a, const DbcSignal& b) {
    return a.name == b.name && a.start == b.start && a.length == b.length && a.big_endian == b.big_endian &&
           a.number == b.number && a.factor == b.factor && a.offset == b.offset && a.unit == b.unit;
  };
  return first.id == second.id && first.name == second.name &&
         std::equal(first.signals.begin(), first.signals.end(), second.signals.begin(), second.signals.end(),
                    alike);
}

void append(Dbc& all, Dbc further) {
  all.path += (all.path.empty() ? "" : ", ") + further.path;
  for (DbcMessage& message : further.messages) {
    const bool known = std::any_of(all.messages.begin(), all.messages.end(),
                                   [&](const DbcMessage& one) { return are_alike(one, message); });
    if (!known) all.messages.push_back(std::move(message));
  }
}

}  // namespace

const Dbc& standard_messages() {
  static const Dbc standard = [] {
    Dbc dbc = Dbc::parse(kStandard, "the list of OBD-II and J1939 messages (no 'dbc: FILE' is stated)");
    for (DbcMessage& message : dbc.messages) message.is_standard = true;
    return dbc;
  }();
  return standard;
}

Dbc dbc_of(const LogRequest& request) {
  Dbc all;
  const auto files = request.companions.find("dbc");
  if (files != request.companions.end())
    for (const CompanionFile& file : files->second) append(all, Dbc::parse(file.text, file.path));
  if (all.messages.empty()) return standard_messages();
  std::vector<DbcMessage> further = standard_messages().messages;
  std::erase_if(further, [&all](const DbcMessage& standard) {
    return std::any_of(all.messages.begin(), all.messages.end(), [&](const DbcMessage& stated) {
      return stated.id == standard.id || (standard.is_group && (stated.id & kExtendedFrame) != 0 &&
                                          parameter_group(stated.id) == parameter_group(standard.id));
    });
  });
  std::move(further.begin(), further.end(), std::back_inserter(all.messages));
  return all;
}

}  // namespace waymark::formats
