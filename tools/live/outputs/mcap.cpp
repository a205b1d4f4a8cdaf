#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/ros/wire_text.hpp>
#include <waymark/tools/live/outputs/lines.hpp>

namespace waymark::live {
namespace {

// Neither chunks nor an index: a reader may connect at any time.
using formats::mcap_record;
using formats::McapOpcode;
using formats::wire_bytes;
using formats::wire_text;

/// A topic, and the JSON schema of its messages.
struct Topic {
  std::string_view name;
  std::string_view schema_name;
  std::string_view schema;
};

constexpr std::string_view kObject = R"({"type":"object"})";
/// The kinds of lines of JSON, and where the vehicle is in the form that Foxglove draws on a map.
constexpr std::array kTopics{
    Topic{"/frame", "waymark.Frame", kObject},
    Topic{"/pose", "waymark.Pose",
          R"({"type":"object","properties":{"stamp_ns":{"type":"integer"},"state":{"type":"string"},)"
          R"("x_m":{"type":"number"},"y_m":{"type":"number"},"heading_rad":{"type":["number","null"]},)"
          R"("covariance":{"type":"array","items":{"type":"number"}},"latitude_deg":{"type":"number"},)"
          R"("longitude_deg":{"type":"number"},"course_deg":{"type":"number"},"smooth":{"type":"array",)"
          R"("items":{"type":"number"}},"speed_mps":{"type":"number"},"yaw_rate_radps":{"type":"number"},)"
          R"("corrected":{"type":"boolean"},"resets":{"type":"integer"},"fix_age_s":{"type":"number"},)"
          R"("radius95_m":{"type":"number"}}})"},
    Topic{"/settled", "waymark.Settled",
          R"({"type":"object","properties":{"stamp_ns":{"type":"integer"},"x_m":{"type":"number"},)"
          R"("y_m":{"type":"number"},"heading_rad":{"type":"number"},"resets":{"type":"integer"}}})"},
    Topic{"/event", "waymark.Event",
          R"({"type":"object","properties":{"stamp_ns":{"type":"integer"},"event":{"type":"string"},)"
          R"("source":{"type":"string"},"text":{"type":"string"}}})"},
    Topic{
        "/location", "foxglove.LocationFix",
        R"({"type":"object","properties":{"timestamp":{"type":"object","properties":{"sec":{"type":"integer"},)"
        R"("nsec":{"type":"integer"}}},"frame_id":{"type":"string"},"latitude":{"type":"number"},)"
        R"("longitude":{"type":"number"},"altitude":{"type":"number"},"position_covariance":{"type":"array",)"
        R"("items":{"type":"number"}},"position_covariance_type":{"type":"integer"}}})"}};
constexpr std::size_t kLocation = 4;

class McapWriter final : public ReportWriter {
 public:
  [[nodiscard]] std::string header() const override {
    std::string bytes = std::string(formats::kMcapMagic) +
                        mcap_record(McapOpcode::header, wire_text("") + wire_text("waymark live"));
    for (std::size_t i = 0; i < kTopics.size(); ++i) {
      const auto id = static_cast<std::uint16_t>(i + 1);
      bytes += mcap_record(McapOpcode::schema, wire_bytes(id) + wire_text(kTopics[i].schema_name) +
                                                   wire_text("jsonschema") + wire_text(kTopics[i].schema));
      bytes += mcap_record(McapOpcode::channel, wire_bytes(id) + wire_bytes(id) + wire_text(kTopics[i].name) +
                                                    wire_text("json") + wire_bytes(std::uint32_t{0}));
    }
    return bytes;
  }

  [[nodiscard]] std::string write(const Report& report, const Surroundings& around) override {
    const Stamp own = std::visit([](const auto& one) { return one.stamp; }, report);
    const Stamp utc = convert(own, around.scale, TimeScale::unix_time);
    std::string bytes;
    const std::string lines = json_->write(report, around);
    for (std::size_t begin = 0; begin < lines.size();) {
      const std::size_t end = lines.find('\n', begin);
      const std::string_view line = std::string_view(lines).substr(begin, end - begin);
      bytes += message(topic_of(line), utc, line);
      begin = end + 1;
    }
    if (const auto* pose = std::get_if<LivePose>(&report); pose != nullptr && around.projection != nullptr)
      bytes += message(kLocation, utc, location(*pose, utc, around));
    return bytes;
  }

  [[nodiscard]] std::string footer() const override {
    return mcap_record(McapOpcode::data_end, wire_bytes(std::uint32_t{0})) +
           mcap_record(McapOpcode::footer, wire_bytes(std::uint64_t{0}) + wire_bytes(std::uint64_t{0}) +
                                               wire_bytes(std::uint32_t{0})) +
           std::string(formats::kMcapMagic);
  }

 private:
  /// {"kind":"pose",... belongs to the topic "/pose".
  static std::size_t topic_of(std::string_view line) {
    constexpr std::string_view kBegin = "{\"kind\":\"";
    const std::string_view kind = line.substr(kBegin.size(), line.find('"', kBegin.size()) - kBegin.size());
    const auto found = std::find_if(kTopics.begin(), kTopics.end(),
                                    [&](const Topic& topic) { return topic.name.substr(1) == kind; });
    return static_cast<std::size_t>(found - kTopics.begin());
  }
  std::string message(std::size_t topic, Stamp utc, std::string_view data) {
    const auto time = wire_bytes(static_cast<std::uint64_t>(std::max<std::int64_t>(utc.nanoseconds, 0)));
    return mcap_record(McapOpcode::message, wire_bytes(static_cast<std::uint16_t>(topic + 1)) +
                                                wire_bytes(sequence_[topic]++) + time + time +
                                                std::string(data));
  }
  /// East and north of the grid stand for those of the ellipsoid: the convergence is left out.
  static std::string location(const LivePose& pose, Stamp utc, const Surroundings& around) {
    const GeodeticPoint place = around.projection->to_geodetic(pose.pose.head<2>());
    const Eigen::Matrix3d& c = pose.covariance;
    return fmt::format(
        "{{\"timestamp\":{{\"sec\":{},\"nsec\":{}}},\"frame_id\":\"map\",\"latitude\":{:.9f},\"longitude\":{:.9f},"
        "\"altitude\":0,\"position_covariance\":[{},{},0,{},{},0,0,0,0],\"position_covariance_type\":2}}",
        utc.nanoseconds / 1'000'000'000, utc.nanoseconds % 1'000'000'000, place.latitude_deg,
        place.longitude_deg, c(0, 0), c(0, 1), c(0, 1), c(1, 1));
  }

  std::unique_ptr<ReportWriter> json_ = make_json_writer();
  std::array<std::uint32_t, kTopics.size()> sequence_{};
};

}  // namespace

std::unique_ptr<ReportWriter> make_mcap_writer() {
  return std::make_unique<McapWriter>();
}

}  // namespace waymark::live
