#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/can/layouts/peak_trc.hpp>
#include <waymark/formats/logs/detail/can/layouts/vector_asc.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>

namespace waymark::formats {
namespace {

/// Lines of candump (can-utils). See split_can_line().
class CandumpLayout final : public CanLayout {
 public:
  CanLine split(std::string_view line) override { return split_can_line(line); }
  [[nodiscard]] std::optional<Stamp> stamp(const CanLine& line) const override {
    return can_stamp(line.stamp);
  }
  [[nodiscard]] std::string_view program() const override { return "candump writes them"; }
};

}  // namespace

bool is_can_format(std::string_view format) {
  return format == "candump" || format == "asc" || format == "trc";
}

std::unique_ptr<CanLayout> can_layout(std::string_view format) {
  if (format == "candump") return std::make_unique<CandumpLayout>();
  if (format == "asc") return vector_asc();
  if (format == "trc") return peak_trc();
  return nullptr;
}

Recognition recognise_can(std::string_view format, std::string_view head) {
  const std::unique_ptr<CanLayout> layout = can_layout(format);
  HeadLines lines(head);
  std::size_t frames = 0;
  std::size_t beside = 0;
  CanData data;
  while (lines.next()) {
    const CanLine taken = layout->split(lines.line());
    const bool sound = taken.kind == FrameKind::remote || taken.kind == FrameKind::error ||
                       (taken.kind == FrameKind::data && read_can_data(taken, data).empty());
    beside += taken.kind == FrameKind::beside;
    if (sound && layout->stamp(taken)) ++frames;
  }
  const std::size_t rest = lines.count() - beside;
  if (2 * frames <= rest) return {};
  return {static_cast<double>(frames) / static_cast<double>(rest),
          fmt::format("{} of {} lines are CAN frames as {}", frames, rest, layout->program())};
}

}  // namespace waymark::formats
