#include <waymark/formats/logs/detail/can/can_log.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/can/can_fixes.hpp>
#include <waymark/formats/logs/detail/can/can_frame.hpp>
#include <waymark/formats/logs/detail/can/can_signals.hpp>
#include <waymark/formats/logs/detail/can/can_tables.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/detail/can/dbc_set.hpp>
#include <waymark/formats/logs/detail/can/layouts/can_layout.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

/// The year 2106, when 32 bits of seconds end. A number beyond it is no date.
constexpr std::int64_t kLastDate = 4'294'967'295'000'000'000;

/// The wanted signals of one message, and its counts.
struct MessageUse {
  std::size_t frames = 0;
  std::vector<std::size_t> bound;  ///< indices of its BoundSignals
  /// counted only for wanted messages
  std::array<std::size_t, kMostInterfaces + 1> by_interface{};
};

class CanLogDecoder final : public LineDecoder {
 public:
  CanLogDecoder(const std::string& path, const LogRequest& log_request, std::string_view format)
      : LineDecoder(path, log_request),
        layout_(can_layout(format)),
        dbc_(dbc_of(log_request)),
        table_(dbc_),
        quantities_(signal_quantities(request())),
        bound_(bind_signals(dbc_, quantities_, request(), path + ": ", data_.notes)),
        outside_(bound_.size()),
        uses_(dbc_.messages.size()) {
    offset_ = std::llround(request().time_offset_s * 1e9);
    for (std::size_t i = 0; i < bound_.size(); ++i) uses_[bound_[i].message].bound.push_back(i);
    const StreamKind stream = request().stream;
    if (stream == StreamKind::gnss || stream == StreamKind::truth)
      fixes_.emplace(quantities_, bound_, request(), this->path(), data_);
    data_.readings.columns = request().readings.size();
  }

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;
  void take_message(const MessageUse& use, const CanLine& line, std::string_view text, std::size_t number);
  void take_values(Stamp stamp, std::size_t number);
  void take_clock(const DbcSignal& signal, std::size_t index, Stamp stamp);
  [[nodiscard]] double value_of(const DbcSignal& signal, std::size_t index);
  [[nodiscard]] std::string described(const BoundSignal& bound) const;
  [[nodiscard]] std::optional<Stamp> stamp_of(const CanLine& line) const;
  void bad_line(std::size_t number, std::size_t column, const std::string& what) {
    ++data_.records;
    corrupt(number, column, what);
  }
  void note_interfaces();
  [[noreturn]] void refuse_silence() const;

  std::unique_ptr<CanLayout> layout_;
  Dbc dbc_;
  MessageTable table_;
  std::vector<Quantity> quantities_;
  std::vector<BoundSignal> bound_;
  std::vector<std::size_t> outside_;  ///< by BoundSignal: values outside the range
  std::vector<MessageUse> uses_;      ///< one entry per message
  std::optional<FixAssembler> fixes_;
  std::int64_t offset_ = 0;
  Interfaces interfaces_;
  std::size_t unknown_ = 0, remote_ = 0, errors_ = 0;
  bool any_frame_ = false;
  CanData frame_;
  std::vector<SignalValue> values_;  ///< of the current frame
};

void CanLogDecoder::take_line(std::string_view line, std::size_t number) {
  if (line.empty()) return;
  const CanLine taken = layout_->split(line);
  if (taken.kind == FrameKind::none) return bad_line(number, taken.column, std::string(taken.what));
  if (taken.kind == FrameKind::beside) return;
  any_frame_ = true;
  const std::size_t interface = interfaces_.count(taken.interface);
  if (taken.kind == FrameKind::remote) {
    ++remote_;
    return;
  }
  if (taken.kind == FrameKind::error) {
    ++errors_;
    return;
  }
  std::uint32_t message = table_.find(taken.id);
  if (message == MessageTable::kUnknown) ++unknown_;
  for (; message != MessageTable::kUnknown; message = table_.next(message)) {
    MessageUse& use = uses_[message];
    ++use.frames;
    if (use.bound.empty()) continue;
    ++use.by_interface[interface];
    take_message(use, taken, line, number);
  }
}

void CanLogDecoder::take_message(const MessageUse& use, const CanLine& line, std::string_view text,
                                 std::size_t number) {
  const auto column = [&](std::string_view part) {
    return static_cast<std::size_t>(part.data() - text.data()) + 1;
  };
  const std::optional<Stamp> stamp = stamp_of(line);
  if (!stamp)
    return bad_line(number, column(line.stamp),
                    fmt::format("{} is no time in decimal seconds", quote_field(line.stamp)));
  if (const std::string_view what = read_can_data(line, frame_); !what.empty())
    return bad_line(number, column(line.data), std::string(what));
  values_.clear();
  for (const std::size_t index : use.bound) {
    const BoundSignal& bound = bound_[index];
    const DbcMessage& message = dbc_.messages[bound.message];
    const DbcSignal& signal = message.signals[bound.signal];
    if (!bound.interface.empty() && bound.interface != line.interface) continue;
    if (!message.holds(signal, frame_)) continue;
    if (frame_.size < signal.bytes_needed())
      return bad_line(number, column(line.data),
                      fmt::format("{}: {} bytes, but the signal {} needs {}", message.name, frame_.size,
                                  signal.name, signal.bytes_needed()));
    if (quantities_[bound.quantity].name == "gnss_time") {
      take_clock(signal, index, *stamp);
    } else if (message.is_available(signal, frame_)) {
      values_.push_back({bound.quantity, value_of(signal, index)});
    } else {
      ++outside_[index];
      values_.push_back({bound.quantity, kNoNumber});
    }
  }
  if (!values_.empty()) take_values(*stamp, number);
}

void CanLogDecoder::take_values(Stamp stamp, std::size_t number) {
  if (fixes_) return fixes_->take(stamp, number, values_);
  ++data_.records;
  // The readings have the quantities of these streams except `time`, which comes from the log.
  SensorTable& table = data_.readings;
  const std::size_t row = table.values.size();
  table.stamps.push_back(stamp);
  table.values.resize(row + table.columns, kNoNumber);
  for (const SignalValue& signal : values_) table.values[row + signal.quantity] = signal.value;
}

/// Returns the quantity in a frame. If it is outside its range, it is counted, and the
/// result is NaN.
double CanLogDecoder::value_of(const DbcSignal& signal, std::size_t index) {
  const BoundSignal& bound = bound_[index];
  const Quantity& quantity = quantities_[bound.quantity];
  const double told = signal.value(frame_);
  if (bound.missing == told) return kNoNumber;
  const double value = bound.factor * told;
  if (std::isfinite(value) && value >= quantity.smallest && value <= quantity.largest)
    return value + bound.offset;
  ++outside_[index];
  return kNoNumber;
}

void CanLogDecoder::take_clock(const DbcSignal& signal, std::size_t index, Stamp stamp) {
  std::int64_t multiplier = 1'000'000'000;
  for (int power = bound_[index].time_power; power < 0; ++power) multiplier /= 10;
  const std::optional<std::int64_t> told = signal.integer(frame_, multiplier);
  if (!told || *told <= 0 || *told > kLastDate) {
    ++outside_[index];
    return;
  }
  data_.clocks.push_back({stamp, convert(Stamp{*told}, TimeScale::utc, request().time_scale)});
}

std::optional<Stamp> CanLogDecoder::stamp_of(const CanLine& line) const {
  std::optional<Stamp> stamp = layout_->stamp(line);
  if (stamp && __builtin_add_overflow(stamp->nanoseconds, offset_, &stamp->nanoseconds)) return std::nullopt;
  return stamp;
}

void CanLogDecoder::end() {
  if (fixes_) fixes_->finish();
  for (const std::string& text : layout_->notes()) note(text);
  if (!request().companions.contains("dbc"))
    note("no DBC is stated: the messages of OBD-II and J1939 are known");
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    if (outside_[i] == 0) continue;
    const Quantity& quantity = quantities_[bound_[i].quantity];
    note(fmt::format("{}: {} values of signal {} are outside its range or not available; they are ignored",
                     quantity.name, outside_[i],
                     dbc_.messages[bound_[i].message].signals[bound_[i].signal].name));
  }
  note_interfaces();
  if (any_frame_ && data_.records == 0) refuse_silence();
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    if (uses_[i].frames > 0) data_.kinds[dbc_.messages[i].name] = uses_[i].frames;
  }
  if (unknown_ > 0) data_.kinds["not in the DBC"] = unknown_;
  if (remote_ > 0) data_.kinds["remote frames"] = remote_;
  if (errors_ > 0) data_.kinds["error frames"] = errors_;
}

/// "WHEEL_SPEEDS (id AA)", "WHEEL_SPEEDS (id AA) on can0".
std::string CanLogDecoder::described(const BoundSignal& bound) const {
  const DbcMessage& message = dbc_.messages[bound.message];
  return fmt::format("{} (id {:X}){}", message.name, message.id & ~kExtendedFrame,
                     bound.interface.empty() ? std::string() : " on " + bound.interface);
}

void CanLogDecoder::note_interfaces() {
  if (const std::string summary = interfaces_.summary(); !summary.empty()) note("interfaces: " + summary);
  for (const BoundSignal& bound : bound_) {
    const MessageUse& use = uses_[bound.message];
    const DbcMessage& message = dbc_.messages[bound.message];
    const std::string quantity(quantities_[bound.quantity].name);
    std::size_t on_stated = 0;
    std::size_t first = use.by_interface.size();
    for (std::size_t i = use.by_interface.size(); i-- > 0;) {
      if (use.by_interface[i] == 0) continue;
      first = i;
      if (bound.interface.empty() || interfaces_.name(i) == bound.interface) on_stated += use.by_interface[i];
    }
    if (on_stated == 0) note(fmt::format("{}: the log has no frame of {}", quantity, described(bound)));
    const auto sources = std::count_if(use.by_interface.begin(), use.by_interface.end(),
                                       [](std::size_t count) { return count > 0; });
    if (sources > 1 && bound.interface.empty())
      note(fmt::format("{}: {} is on several interfaces ({}); all are read, '{}:{}.{}' chooses one", quantity,
                       message.name, interfaces_.summary(use.by_interface), interfaces_.name(first),
                       message.name, message.signals[bound.signal].name));
  }
}

/// No frame had a wanted signal: the message lists the signals, and the frames that the log has.
void CanLogDecoder::refuse_silence() const {
  std::string wanted;
  for (const BoundSignal& bound : bound_) {
    const std::string message = described(bound);
    if (wanted.find(message) == std::string::npos) wanted += (wanted.empty() ? "" : ", ") + message;
  }
  throw InputError(fmt::format("{}: no frame holds a signal that is needed ({}); the log has {}", path(),
                               wanted, interfaces_.summary()));
}

}  // namespace

std::unique_ptr<LogDecoder> CanLogReader::open(const std::string& path, const LogRequest& request) const {
  require_companions(path, request, "a log of CAN frames", "dbc");
  return std::make_unique<CanLogDecoder>(path, request, format_);
}

Recognition CanLogReader::recognise(std::string_view head) const {
  return recognise_can(format_, head);
}

}  // namespace waymark::formats
