/// CAN frames for tests, with the DBC of their messages and functions that read them.
#pragma once

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/can/can_log.hpp>

#include "logs/log_pieces.hpp"

namespace waymark_test::candump_samples {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

// Written by hand from the DBC specification: wheel speeds in km/h on one id, the yaw rate on
// another, and a receiver's burst of three.
inline constexpr const char* kDbc =
    "BO_ 170 WHEELS: 4 ECU\n"
    " SG_ FL : 7|16@0+ (0.01,0) [0|0] \"kph\" X\n"
    " SG_ FR : 23|16@0+ (0.01,0) [0|0] \"kph\" X\n"
    "BO_ 36 MOTION: 2 ECU\n"
    " SG_ YAW_RATE : 0|16@1- (0.1,0) [0|0] \"deg/s\" X\n"
    "BO_ 37 STEERING: 3 ECU\n"
    " SG_ YAW_RATE : 0|16@1- (0.1,0) [0|0] \"\" X\n"
    " SG_ COUNT : 16|8@1+ (1,0) [0|0] \"\" X\n"
    "BO_ 3 gnss_pos: 8 R\n"
    " SG_ Latitude : 0|28@1+ (1e-06,-90) [0|0] \"deg\" X\n"
    " SG_ Longitude : 28|29@1+ (1e-06,-180) [0|0] \"deg\" X\n"
    " SG_ Accuracy : 57|6@1+ (1,0) [0|0] \"m\" X\n"
    " SG_ Valid : 63|1@1+ (1,0) [0|0] \"\" X\n"
    "BO_ 7 gnss_motion: 4 R\n"
    " SG_ Speed : 0|16@1+ (0.01,0) [0|0] \"m/s\" X\n"
    " SG_ Heading : 16|16@1+ (0.1,0) [0|0] \"deg\" X\n"
    "BO_ 2 gnss_time: 5 R\n"
    " SG_ Epoch : 0|40@1+ (0.001,1577840400) [0|0] \"sec\" X\n"
    "BO_ 10 latitude_only: 4 R\n"
    " SG_ Lat : 0|28@1+ (1e-06,-90) [0|0] \"deg\" X\n"
    "BO_ 11 longitude_only: 4 R\n"
    " SG_ Lon : 0|29@1+ (1e-06,-180) [0|0] \"deg\" X\n"
    "BO_ 12 covariances: 6 R\n"
    " SG_ East : 0|16@1+ (0.1,0) [0|0] \"m\" X\n"
    " SG_ North : 16|16@1+ (0.1,0) [0|0] \"m\" X\n"
    " SG_ Root : 32|16@1- (0.1,0) [0|0] \"m\" X\n";

inline ColumnRequest from(const std::string& column, const std::string& unit = "",
                          const std::string& convention = "") {
  return {column, unit, convention};
}

inline LogRequest request_of(StreamKind stream, std::map<std::string, ColumnRequest> columns) {
  LogRequest request;
  request.stream = stream;
  request.columns = std::move(columns);
  request.companions["dbc"] = {{"car.dbc", kDbc}};
  request.time_scale = TimeScale::unix_time;
  if (stream == StreamKind::odometry) request.readings = odometry_channels();
  return request;
}

inline LogRequest fixes() {
  return request_of(StreamKind::gnss, {{"latitude", from("Latitude")},
                                       {"longitude", from("Longitude")},
                                       {"accuracy", from("Accuracy")},
                                       {"valid", from("Valid")},
                                       {"speed", from("Speed")},
                                       {"course", from("Heading")}});
}

inline LogData read(const std::string& text, const LogRequest& request) {
  return CanLogReader().read(text, "car.log", request);
}

inline std::string hex_bytes(std::uint64_t word, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    const auto byte = static_cast<std::size_t>((word >> (8 * i)) & 255U);
    text += {kDigits[byte / 16], kDigits[byte % 16]};
  }
  return text;
}

/// Returns a frame of gnss_pos at (latitude, longitude) in millionths of a degree.
inline std::string position(const std::string& time, int latitude, int longitude, unsigned accuracy = 4,
                            bool valid = true) {
  const std::uint64_t word = static_cast<std::uint64_t>(latitude + 90'000'000) |
                             (static_cast<std::uint64_t>(longitude + 180'000'000) << 28U) |
                             (std::uint64_t{accuracy} << 57U) | (std::uint64_t{valid ? 1U : 0U} << 63U);
  return "(" + time + ") can0 003#" + hex_bytes(word, 8) + "\n";
}

/// Returns a frame of gnss_motion: speed in cm/s, heading in tenths of a degree.
inline std::string motion(const std::string& time, unsigned speed, unsigned heading) {
  return "(" + time + ") can0 007#" + hex_bytes(speed | (heading << 16U), 4) + "\n";
}

inline std::size_t channel(const std::string& name) {
  for (std::size_t i = 0; i < odometry_channels().size(); ++i) {
    if (odometry_channels()[i].name == name) return i;
  }
  return odometry_channels().size();
}

inline void check_refused(const LogRequest& request, const std::string& message) {
  CHECK_THROWS_MATCHES(CanLogReader().open("car.log", request), InputError, Message("car.log: " + message));
}

}  // namespace waymark_test::candump_samples
