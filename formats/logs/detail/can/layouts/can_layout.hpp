/// The layouts of logs of CAN frames, one frame per line.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/can_frame.hpp>

namespace waymark::formats {

/// Splits the lines of one log. It may keep what its head says.
class CanLayout {
 public:
  virtual ~CanLayout() = default;
  /// Splits the next line. Every line is given once and in order.
  /// @return views into the line
  [[nodiscard]] virtual CanLine split(std::string_view line) = 0;
  /// Returns the stamp of the line that was split last. Empty if it is no time.
  [[nodiscard]] virtual std::optional<Stamp> stamp(const CanLine& line) const = 0;
  /// "candump writes them", for messages.
  [[nodiscard]] virtual std::string_view program() const = 0;
  /// What the head of the log says about its stamps; one sentence each.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

[[nodiscard]] bool is_can_format(std::string_view format);

/// Returns a layout for one log: "candump" (can-utils), "asc" (Vector), "trc" (PEAK). Null: another format.
[[nodiscard]] std::unique_ptr<CanLayout> can_layout(std::string_view format);

/// Judges how many lines of a log's head are frames of a layout.
[[nodiscard]] Recognition recognise_can(std::string_view format, std::string_view head);

}  // namespace waymark::formats
