/// Finds out what a candump log contains: ids and, with a DBC, signals.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>
#include <waymark/formats/logs/detail/can/can_tables.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/tools/inspection/survey/table_survey.hpp>

namespace waymark::inspection {

struct CanSummary {
  std::size_t frames = 0;
  StampSeries stamps;
  std::string interfaces;          ///< "can0 (1200 frames)"
  std::vector<ColumnSummary> ids;  ///< by number of frames; with names if the DBC has them
  /// "MESSAGE.SIGNAL" of messages that occurred, in the order of the DBC
  std::vector<ColumnSummary> signals;
};

/// At most this many ids are counted. A bus has hundreds at most, but a damaged log may
/// have any number.
inline constexpr std::size_t kMostIds = 4096;

/// Takes a log of CAN frames line by line. It proposes a signal for every quantity that the name of a
/// signal indicates.
class CanSurvey final : public formats::LineDecoder {
 public:
  /// @param format of formats::can_layout()
  CanSurvey(const std::string& path, std::string_view format, formats::Dbc dbc);
  [[nodiscard]] CanSummary summary() const;

 private:
  struct Id {
    std::uint32_t id = 0;
    std::size_t frames = 0;
    std::size_t shortest = formats::kMostFrameBytes, longest = 0;
    Stamp first, last;
    std::uint32_t message = formats::MessageTable::kUnknown;
  };
  struct Signal {
    std::size_t values = 0;
    Range range;
    Stamp first, last;
  };
  void take_line(std::string_view line, std::size_t number) override;
  [[nodiscard]] Id* id_of(std::uint32_t id);
  void take_signals(std::uint32_t message, Stamp stamp);
  [[nodiscard]] std::string name_of(const Id& id) const;

  std::unique_ptr<formats::CanLayout> layout_;
  formats::Dbc dbc_;
  formats::MessageTable table_;
  std::vector<std::vector<Signal>> signals_;  ///< by message
  std::vector<Id> ids_;
  std::vector<std::int32_t> standard_;  ///< index in ids_ for each id below 2048; -1: none
  std::unordered_map<std::uint32_t, std::size_t> extended_;
  formats::Interfaces interfaces_;
  StampSeries stamps_;
  std::size_t frames_ = 0;
  formats::CanData data_bytes_;
};

}  // namespace waymark::inspection
