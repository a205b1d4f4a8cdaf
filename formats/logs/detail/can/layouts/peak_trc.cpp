#include <waymark/formats/logs/detail/can/layouts/peak_trc.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/can/layouts/can_cursor.hpp>
#include <waymark/formats/logs/detail/csv/table_time.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kVersion = ";$FILEVERSION=";
constexpr std::string_view kStart = ";$STARTTIME=";
constexpr std::string_view kTrcColumns = ";$COLUMNS=";

/// The columns of a version, by the letters of ";$COLUMNS=": N number, O time offset, T type, B bus,
/// I id, d direction, R reserved, l length in bytes, L length code, D data. Before version 2 the
/// direction is also the type.
std::string_view columns_of(std::string_view version) {
  if (version == "1.0") return "NOILD";
  if (version == "1.1") return "NOdILD";
  if (version == "1.2") return "NOBdILD";
  if (version == "1.3") return "NOBdIRLD";
  return "NOTIdlD";
}

/// Length codes 9 to 15 of CAN FD.
constexpr std::array<int, 7> kLongSizes{12, 16, 20, 24, 32, 48, 64};

class PeakTrc final : public CanLayout {
 public:
  CanLine split(std::string_view line) override;
  [[nodiscard]] std::optional<Stamp> stamp(const CanLine& line) const override;
  [[nodiscard]] std::vector<std::string> notes() const override;
  [[nodiscard]] std::string_view program() const override { return "PEAK's TRC logs have them"; }

 private:
  void take_head(std::string_view line);
  [[nodiscard]] bool take_word(char column, std::string_view word, CanLine& result) const;

  std::string columns_{columns_of("1.0")};
  std::optional<Stamp> started_;
};

CanLine PeakTrc::split(std::string_view line) {
  CanLine result;
  result.kind = FrameKind::beside;
  CanCursor cursor{line};
  cursor.skip_blanks();
  if (cursor.at_end()) return result;
  if (cursor.peek() == ';') {
    take_head(cursor.rest());
    return result;
  }
  result.kind = FrameKind::data;
  result.stamp = line.substr(0, 0);  // a damaged head may name no column of times
  for (const char column : columns_) {
    if (column == 'D') break;
    const std::string_view word = cursor.next_word();
    if (!take_word(column, word, result))
      return can_trouble(cursor.word_at, "expected a frame as the head of the log describes it");
    if (result.kind == FrameKind::beside || result.kind == FrameKind::error) return result;
  }
  if (result.interface.empty()) result.interface = "1";
  cursor.skip_blanks();
  result.data = cursor.rest();
  if (result.data.starts_with("RTR")) result.kind = FrameKind::remote;
  return result;
}

void PeakTrc::take_head(std::string_view line) {
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  if (line.starts_with(kVersion)) {
    columns_ = columns_of(line.substr(kVersion.size()));
  } else if (line.starts_with(kStart)) {
    const std::optional<TableInstant> start = instant_from_field(line.substr(kStart.size()), "excel", 0);
    if (start) started_ = start->stamp;
  } else if (line.starts_with(kTrcColumns)) {
    columns_ = line.substr(kTrcColumns.size());
    std::erase(columns_, ',');
  }
}

/// @return false if the word cannot stand in its column
bool PeakTrc::take_word(char column, std::string_view word, CanLine& result) const {
  if (word.empty()) return false;
  switch (column) {
    case 'N':  // "12)" or "12"
      return word.front() >= '0' && word.front() <= '9';
    case 'O':
      result.stamp = word;
      return true;
    case 'B':
      result.interface = word;
      return true;
    case 'T':
      if (word == "RR") result.kind = FrameKind::remote;
      if (word == "ER") result.kind = FrameKind::error;
      if (word == "ST" || word == "EC" || word == "EV") result.kind = FrameKind::beside;
      return true;
    case 'd':
      if (word == "Error") result.kind = FrameKind::error;
      if (word == "Warng" || word == "Warn") result.kind = FrameKind::beside;
      return true;
    case 'I': {
      const std::optional<std::uint32_t> id = unsigned_number(word, 16);
      const bool extended = word.size() > 4;
      if (!id || *id > (extended ? kMostExtendedId : kMostStandardId)) {
        // Before version 1.1, warnings and errors are frames of the id FFFFFFFF.
        if (word == "FFFFFFFF") result.kind = FrameKind::error;
        return word == "FFFFFFFF";
      }
      result.id = extended ? *id | kExtendedFrame : *id;
      return true;
    }
    case 'l':
    case 'L': {
      const std::optional<std::uint32_t> size = unsigned_number(word, 10);
      if (!size || *size > kMostFrameBytes) return false;
      const bool code = column == 'L' && *size > 8;
      if (code && *size > 15) return false;
      result.listed_size = code ? kLongSizes[*size - 9] : static_cast<int>(*size);
      return true;
    }
    default:
      return true;
  }
}

std::optional<Stamp> PeakTrc::stamp(const CanLine& line) const {
  std::optional<Stamp> stamp = can_stamp(line.stamp);
  if (!stamp) return std::nullopt;
  constexpr std::int64_t kMillisecondsOfSecond = 1000;
  stamp->nanoseconds /= kMillisecondsOfSecond;
  if (started_ && __builtin_add_overflow(stamp->nanoseconds, started_->nanoseconds, &stamp->nanoseconds))
    return std::nullopt;
  return stamp;
}

std::vector<std::string> PeakTrc::notes() const {
  if (started_)
    return {
        "stamps count from the log's start, which is local time without a zone; 'time: {offset: "
        "SECONDS}' moves them"};
  return {"stamps count from the start of the log, which tells no date"};
}

}  // namespace

std::unique_ptr<CanLayout> peak_trc() {
  return std::make_unique<PeakTrc>();
}

}  // namespace waymark::formats
