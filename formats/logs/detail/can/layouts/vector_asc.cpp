#include <waymark/formats/logs/detail/can/layouts/vector_asc.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/can/layouts/can_cursor.hpp>
#include <waymark/formats/text/detail/date_time.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

/// Abbreviated months of a German Windows that differ from the English ones.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kGermanMonths{
    {{"Mrz", "Mar"}, {"Mai", "May"}, {"Okt", "Oct"}, {"Dez", "Dec"}}};

/// Reads "Mon Jul 26 10:14:15.000 am 2021". Empty if it is no such date.
std::optional<Stamp> asc_date(std::string_view text) {
  CanCursor cursor{text};
  (void)cursor.next_word();  // the day of the week, in any language
  std::string_view month = cursor.next_word();
  for (const auto& [german, english] : kGermanMonths)
    if (month == german) month = english;
  const std::string_view day = cursor.next_word();
  const std::string_view time = cursor.next_word();
  std::string_view year = cursor.next_word();
  std::string half;
  if (year == "am" || year == "pm" || year == "AM" || year == "PM") {
    half = fmt::format(" {}", year);
    year = cursor.next_word();
  }
  return date_time_from_text(fmt::format("{}-{}-{} {}{}", day, month, year, time, half), DateOrder::dmy);
}

class VectorAsc final : public CanLayout {
 public:
  CanLine split(std::string_view line) override;
  [[nodiscard]] std::optional<Stamp> stamp(const CanLine& line) const override;
  [[nodiscard]] std::vector<std::string> notes() const override;
  [[nodiscard]] std::string_view program() const override { return "Vector's ASC logs have them"; }

 private:
  void begin_block(std::string_view first_stamp);
  void take_head(CanCursor cursor, std::string_view first);
  [[nodiscard]] CanLine classic(CanLine result, CanCursor cursor) const;
  [[nodiscard]] CanLine flexible(CanLine result, CanCursor cursor) const;
  [[nodiscard]] bool read_id(std::string_view text, CanLine& result) const;
  [[nodiscard]] CanLine with_data(CanLine result, CanCursor cursor, std::string_view size, int base) const;

  int base_ = 16;
  bool relative_ = false;
  std::string date_;              ///< the text of started_
  std::optional<Stamp> started_;  ///< the origin of the stamps
  std::string block_;             ///< date of a trigger block whose first event has not come
  std::int64_t elapsed_ = 0;      ///< of relative stamps: their sum, nanoseconds
};

CanLine VectorAsc::split(std::string_view line) {
  CanCursor cursor{line};
  const std::string_view first = cursor.next_word();
  CanLine result;
  result.kind = FrameKind::beside;
  const bool event = !first.empty() && first.front() >= '0' && first.front() <= '9';
  if (!event) {
    take_head(cursor, first);
    return result;
  }
  result.stamp = first;
  if (!block_.empty()) begin_block(first);
  if (relative_) {
    const std::optional<Stamp> step = can_stamp(first);
    if (!step || __builtin_add_overflow(elapsed_, step->nanoseconds, &elapsed_))
      return can_trouble(cursor.word_at, "the time is no decimal number");
  }
  result.interface = cursor.next_word();
  if (result.interface == "CANFD") {
    result.interface = cursor.next_word();
    return flexible(result, cursor);
  }
  // Other events, and those of other buses ("L1"), have no channel number here.
  if (!unsigned_number(result.interface, 10)) return result;
  return classic(result, cursor);
}

/// A trigger block tells when it begins. Its stamps count from the log's date, but some programs let
/// them count from the block.
void VectorAsc::begin_block(std::string_view first_stamp) {
  constexpr std::int64_t kBeginning = 1'000'000'000;
  const std::optional<Stamp> stamp = can_stamp(first_stamp);
  if (const std::optional<Stamp> date = asc_date(block_); date && stamp && stamp->nanoseconds < kBeginning) {
    started_ = date;
    date_ = block_;
  }
  block_.clear();
}

/// "date Mon Jul 26 ...", "base hex  timestamps absolute".
void VectorAsc::take_head(CanCursor cursor, std::string_view first) {
  if (first == "date") {
    cursor.skip_blanks();
    date_ = cursor.rest();
    started_ = asc_date(date_);
  } else if (first == "Begin") {
    if (cursor.next_word() == "Triggerblock") {
      cursor.skip_blanks();
      block_ = cursor.rest();
    }
  } else if (first == "base") {
    base_ = cursor.next_word() == "dec" ? 10 : 16;
    if (cursor.next_word() == "timestamps") relative_ = cursor.next_word() == "relative";
  }
}

/// "7E8 Rx d 8 03 41 ...", "ErrorFrame", "Statistic: ..." behind the channel.
CanLine VectorAsc::classic(CanLine result, CanCursor cursor) const {
  const std::string_view id = cursor.next_word();
  if (id == "ErrorFrame") {
    result.kind = FrameKind::error;
    return result;
  }
  const std::size_t id_at = cursor.word_at;
  const std::string_view direction = cursor.next_word();
  if (direction != "Rx" && direction != "Tx" && direction != "TxRq") return result;
  if (!read_id(id, result))
    return can_trouble(id_at, "the id is no number up to 7FF, or 1FFFFFFFx (a log with names is not read)");
  const std::string_view kind = cursor.next_word();
  if (kind == "r") {
    result.kind = FrameKind::remote;
    return result;
  }
  if (kind != "d")
    return can_trouble(cursor.word_at, "expected 'd' (data) or 'r' (remote) after the direction");
  const std::string_view size = cursor.next_word();
  return with_data(result, cursor, size, base_);
}

/// "Rx 123 [name] brs esi dlc length bytes" behind the channel: CAN FD.
CanLine VectorAsc::flexible(CanLine result, CanCursor cursor) const {
  (void)cursor.next_word();  // the direction
  const std::string_view id = cursor.next_word();
  if (id == "ErrorFrame") {
    result.kind = FrameKind::error;
    return result;
  }
  if (!read_id(id, result)) return can_trouble(cursor.word_at, "the id is no number up to 7FF, or 1FFFFFFFx");
  const std::string_view name_or_rate = cursor.next_word();
  if (name_or_rate != "0" && name_or_rate != "1") (void)cursor.next_word();
  (void)cursor.next_word();  // ESI
  (void)cursor.next_word();  // DLC
  const std::string_view size = cursor.next_word();
  return with_data(result, cursor, size, 10);
}

bool VectorAsc::read_id(std::string_view text, CanLine& result) const {
  const bool extended = text.ends_with('x') || text.ends_with('X');
  if (extended) text.remove_suffix(1);
  const std::optional<std::uint32_t> id = unsigned_number(text, base_);
  if (!id || *id > (extended ? kMostExtendedId : kMostStandardId)) return false;
  result.id = extended ? *id | kExtendedFrame : *id;
  return true;
}

/// @param cursor behind the text of the size
CanLine VectorAsc::with_data(CanLine result, CanCursor cursor, std::string_view size, int base) const {
  const std::optional<std::uint32_t> bytes = unsigned_number(size, base);
  if (!bytes || *bytes > kMostFrameBytes)
    return can_trouble(cursor.at - size.size(), "expected a length of 0 to 64 bytes");
  result.kind = FrameKind::data;
  result.listed_size = static_cast<int>(*bytes);
  result.decimal = base_ == 10;
  result.data = cursor.rest();
  return result;
}

std::optional<Stamp> VectorAsc::stamp(const CanLine& line) const {
  std::optional<Stamp> stamp = relative_ ? Stamp{elapsed_} : can_stamp(line.stamp);
  if (stamp && started_ &&
      __builtin_add_overflow(stamp->nanoseconds, started_->nanoseconds, &stamp->nanoseconds))
    return std::nullopt;
  return stamp;
}

std::vector<std::string> VectorAsc::notes() const {
  if (started_)
    return {
        fmt::format("stamps count from the log's date, {}, which is local time without a zone; "
                    "'time: {{offset: SECONDS}}' moves them",
                    shown_name(date_))};
  return {"stamps count from the start of the measurement; the log tells no date of it that is understood"};
}

}  // namespace

std::unique_ptr<CanLayout> vector_asc() {
  return std::make_unique<VectorAsc>();
}

}  // namespace waymark::formats
