#include <waymark/tools/live/outputs/lines.hpp>

#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::live {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

double course_deg(double heading_rad, double convergence_rad) {
  double course = drive::course_from_grid_heading(heading_rad, convergence_rad) / kDegree;
  return course >= 360 ? course - 360 : course;
}

class JsonWriter final : public ReportWriter {
 public:
  [[nodiscard]] std::string header() const override { return frame_line_; }
  [[nodiscard]] std::string write(const Report& report, const Surroundings& around) override {
    std::string lines;
    if (around.projection != nullptr && frame_line_.empty()) {
      const Frame& frame = around.projection->frame();
      lines = fmt::format(
          "{{\"kind\":\"frame\",\"schema\":\"waymark-live\",\"version\":1,\"time_scale\":\"{}\",\"zone\":{},"
          "\"north\":{},\"origin_easting_m\":{},\"origin_northing_m\":{}}}\n",
          to_string(around.scale), frame.zone, frame.north, frame.origin_easting_m, frame.origin_northing_m);
      frame_line_ = lines;
    }
    return lines + std::visit([&](const auto& one) { return line(one, around); }, report);
  }

 private:
  static std::string line(const LivePose& pose, const Surroundings& around) {
    const Eigen::Matrix3d& c = pose.covariance;
    std::string text = fmt::format(
        "{{\"kind\":\"pose\",\"stamp_ns\":{},\"state\":\"{}\",\"x_m\":{},\"y_m\":{},\"heading_rad\":{},"
        "\"covariance\":[{},{},{},{},{},{}]",
        pose.stamp.nanoseconds, to_string(pose.state), number(pose.pose[0]), number(pose.pose[1]),
        pose.heading_known ? number(pose.pose[2]) : "null", number(c(0, 0)), number(c(0, 1)), number(c(1, 1)),
        number(c(0, 2)), number(c(1, 2)), number(c(2, 2)));
    if (around.projection != nullptr) {
      const GeodeticPoint place = around.projection->to_geodetic(pose.pose.head<2>());
      text += fmt::format(",\"latitude_deg\":{:.9f},\"longitude_deg\":{:.9f}", place.latitude_deg,
                          place.longitude_deg);
      if (pose.heading_known)
        text += fmt::format(",\"course_deg\":{:.4f}",
                            course_deg(pose.pose[2], around.projection->to_grid(place).convergence_rad));
    }
    if (pose.heading_known)
      text += fmt::format(",\"smooth\":[{},{},{}]", number(pose.smooth[0]), number(pose.smooth[1]),
                          number(pose.smooth[2]));
    text += fmt::format(
        ",\"speed_mps\":{},\"yaw_rate_radps\":{},\"corrected\":{},\"resets\":{},\"fix_age_s\":{:.3f},\"radius95_m\":{:.3f}}}\n",
        number(pose.speed_mps), number(pose.yaw_rate_radps), pose.corrected, pose.resets, pose.fix_age_s,
        pose.radius95_m);
    return text;
  }
  static std::string line(const SettledPose& pose, const Surroundings&) {
    return fmt::format(
        "{{\"kind\":\"settled\",\"stamp_ns\":{},\"x_m\":{},\"y_m\":{},\"heading_rad\":{},\"resets\":{}}}\n",
        pose.stamp.nanoseconds, number(pose.pose[0]), number(pose.pose[1]), number(pose.pose[2]),
        pose.resets);
  }
  static std::string line(const Event& event, const Surroundings&) {
    return fmt::format("{{\"kind\":\"event\",\"stamp_ns\":{},\"event\":{},\"source\":{},\"text\":{}}}\n",
                       event.stamp.nanoseconds, quoted(event.kind), quoted(event.source), quoted(event.text));
  }
  std::string frame_line_;  // empty: the frame is not known yet
};

/// Degrees as NMEA writes them: ddmm.mmmmmm
std::string nmea_angle(double degrees, int digits) {
  const double size = std::abs(degrees);
  auto whole = static_cast<int>(size);
  double minutes = (size - whole) * 60;
  if (minutes >= 59.9999995) {  // rounding must not print 60
    minutes = 0;
    ++whole;
  }
  return fmt::format("{:0{}}{:010.7f}", whole, digits, minutes);
}

class NmeaWriter final : public ReportWriter {
 public:
  explicit NmeaWriter(std::string talker) : talker_(std::move(talker)) {
    if (talker_.size() != 2 || std::isupper(static_cast<unsigned char>(talker_[0])) == 0 ||
        std::isupper(static_cast<unsigned char>(talker_[1])) == 0)
      throw UsageError("NMEA: a talker has two capital letters, such as GN; '" + talker_ + "' is none");
  }
  [[nodiscard]] std::string write(const Report& report, const Surroundings& around) override {
    const auto* pose = std::get_if<LivePose>(&report);
    if (pose == nullptr || around.projection == nullptr) return {};
    const GeodeticPoint place = around.projection->to_geodetic(pose->pose.head<2>());
    const Stamp utc = convert(pose->stamp, around.scale, TimeScale::utc);
    const std::string date = formats::iso8601_from_stamp(utc);  // 2019-06-01T12:34:56.789Z
    const std::int64_t day_ns = 86'400'000'000'000;
    const std::int64_t of_day = ((utc.nanoseconds % day_ns) + day_ns) % day_ns;
    const std::int64_t ms = of_day / 1'000'000;
    const std::string time =
        fmt::format("{:02}{:02}{:02}.{:03}", ms / 3'600'000, ms / 60'000 % 60, ms / 1000 % 60, ms % 1000);
    const std::string position =
        fmt::format("{},{},{},{}", nmea_angle(place.latitude_deg, 2), place.latitude_deg < 0 ? 'S' : 'N',
                    nmea_angle(place.longitude_deg, 3), place.longitude_deg < 0 ? 'W' : 'E');
    const bool valid = pose->state != State::waiting && pose->state != State::lost;
    const bool reckoned = pose->state == State::dead_reckoning;
    const Eigen::Matrix2d spread = pose->covariance.topLeftCorner<2, 2>();
    const std::string course =
        pose->heading_known
            ? fmt::format("{:.2f}",
                          course_deg(pose->pose[2], around.projection->to_grid(place).convergence_rad))
            : "";
    constexpr double kKnot = 1852.0 / 3600;
    return sentence(fmt::format("GGA,{},{},{},,,,M,,M,,", time, position,
                                !valid     ? 0
                                : reckoned ? 6
                                           : 1)) +
           sentence(fmt::format("RMC,{},{},{},{:.2f},{},{}{}{},,,{}", time, valid ? 'A' : 'V', position,
                                std::abs(pose->speed_mps) / kKnot, course, date.substr(8, 2),
                                date.substr(5, 2), date.substr(2, 2),
                                !valid     ? 'N'
                                : reckoned ? 'E'
                                           : 'A')) +
           sentence(fmt::format("GST,{},,,,,{:.3f},{:.3f},", time, std::sqrt(spread(1, 1)),
                                std::sqrt(spread(0, 0))));
  }

 private:
  [[nodiscard]] std::string sentence(const std::string& body) const {
    const std::string text = "$" + talker_ + body;
    return text + nmea_checksum(text) + "\r\n";
  }
  std::string talker_;
};

class CsvWriter final : public ReportWriter {
 public:
  [[nodiscard]] std::string header() const override {
    return "time,x,y,heading,var_x,cov_xy,var_y,var_heading,latitude,longitude,state,resets\n";
  }
  [[nodiscard]] std::string write(const Report& report, const Surroundings& around) override {
    const auto* pose = std::get_if<LivePose>(&report);
    if (pose == nullptr || around.projection == nullptr) return {};
    const GeodeticPoint place = around.projection->to_geodetic(pose->pose.head<2>());
    const Eigen::Matrix3d& c = pose->covariance;
    return fmt::format("{}.{:09},{},{},{},{},{},{},{},{:.9f},{:.9f},{},{}\n",
                       pose->stamp.nanoseconds / 1'000'000'000, pose->stamp.nanoseconds % 1'000'000'000,
                       pose->pose[0], pose->pose[1],
                       pose->heading_known ? fmt::format("{}", pose->pose[2]) : "", c(0, 0), c(0, 1), c(1, 1),
                       pose->heading_known ? fmt::format("{}", c(2, 2)) : "", place.latitude_deg,
                       place.longitude_deg, to_string(pose->state), pose->resets);
  }
};

}  // namespace

std::string nmea_checksum(const std::string& sentence) {
  unsigned sum = 0;
  for (std::size_t i = 1; i < sentence.size(); ++i) sum ^= static_cast<unsigned char>(sentence[i]);
  return fmt::format("*{:02X}", sum);
}

std::unique_ptr<ReportWriter> make_json_writer() {
  return std::make_unique<JsonWriter>();
}
std::unique_ptr<ReportWriter> make_nmea_writer(const std::string& talker) {
  return std::make_unique<NmeaWriter>(talker);
}
std::unique_ptr<ReportWriter> make_csv_writer() {
  return std::make_unique<CsvWriter>();
}

}  // namespace waymark::live
