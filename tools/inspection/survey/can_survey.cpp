#include <waymark/formats/logs/detail/common/unit_words.hpp>
#include <waymark/tools/inspection/survey/can_survey.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace waymark::inspection {
namespace {

constexpr std::size_t kStandardIds = 2048;

/// n frames have n - 1 intervals.
double rate_of(std::size_t count, Stamp first, Stamp last) {
  const double seconds = last.seconds() - first.seconds();
  return seconds > 0 && count > 1 ? static_cast<double>(count - 1) / seconds : 0;
}

/// Proposes the quantity of a signal in the form of a table column. Message and unit may say more
/// than its name.
ColumnProposal propose_signal(const formats::DbcMessage& message, const formats::DbcSignal& signal) {
  const std::string_view unit = formats::known_unit(signal.unit);
  ColumnProposal proposal =
      propose_quantity(unit.empty() ? signal.name : fmt::format("{} [{}]", signal.name, unit));
  const std::vector<std::string> words = words_of(message.name);
  const auto says = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (proposal.quantity == "time")  // the logger stamps frames, so this is another clock
    proposal.quantity = (says("gnss") || says("gps")) && !signal.unit.empty() ? "gnss_time" : "";
  if (proposal.quantity == "heading" && (says("gnss") || says("gps"))) proposal.quantity = "course";
  if (proposal.quantity.empty()) return {};
  proposal.unit_known = !unit.empty() || proposal.unit_known;
  // The DBC states the unit; the reader uses it and notes it.
  proposal.unit = unit.empty() ? proposal.unit : std::string();
  const bool without = proposal.quantity == "valid" || proposal.quantity == "reverse" ||
                       proposal.quantity.starts_with("wheel_ticks");
  if (proposal.unit_known || without) return proposal;
  const std::string remark = proposal.quantity + "? The DBC names no unit that is known";
  proposal = {};
  proposal.remark = remark;
  return proposal;
}

}  // namespace

CanSurvey::CanSurvey(const std::string& path, std::string_view format, formats::Dbc dbc)
    : formats::LineDecoder(path, {}),
      layout_(formats::can_layout(format)),
      dbc_(std::move(dbc)),
      table_(dbc_),
      standard_(kStandardIds, -1) {
  for (const formats::DbcMessage& message : dbc_.messages) signals_.emplace_back(message.signals.size());
}

CanSurvey::Id* CanSurvey::id_of(std::uint32_t id) {
  std::size_t index = ids_.size();
  if (id < kStandardIds) {
    if (standard_[id] >= 0) return &ids_[static_cast<std::size_t>(standard_[id])];
    standard_[id] = static_cast<std::int32_t>(index);
  } else {
    const auto found = extended_.find(id);
    if (found != extended_.end()) return &ids_[found->second];
    if (extended_.size() >= kMostIds) return nullptr;
    extended_.emplace(id, index);
  }
  ids_.push_back({id, 0, formats::kMostFrameBytes, 0, {}, {}, table_.find(id)});
  return &ids_.back();
}

void CanSurvey::take_line(std::string_view line, std::size_t number) {
  if (line.empty()) return;
  const formats::CanLine taken = layout_->split(line);
  if (taken.kind == formats::FrameKind::beside) return;
  ++data_.records;
  if (taken.kind == formats::FrameKind::none) return corrupt(number, taken.column, std::string(taken.what));
  interfaces_.count(taken.interface);
  if (taken.kind != formats::FrameKind::data) {
    ++data_.kinds[taken.kind == formats::FrameKind::remote ? "remote frames" : "error frames"];
    return;
  }
  const std::optional<Stamp> stamp = layout_->stamp(taken);
  if (!stamp) return corrupt(number, 1, fmt::format("'{}' is no time in decimal seconds", taken.stamp));
  if (const std::string_view what = formats::read_can_data(taken, data_bytes_); !what.empty())
    return corrupt(number, 1, std::string(what));
  ++frames_;
  stamps_.add(*stamp, number);
  Id* id = id_of(taken.id);
  if (id == nullptr) {
    ++data_.kinds["ids beyond the table"];
    return;
  }
  if (id->frames++ == 0) id->first = *stamp;
  id->last = *stamp;
  id->shortest = std::min(id->shortest, data_bytes_.size);
  id->longest = std::max(id->longest, data_bytes_.size);
  for (std::uint32_t i = id->message; i != formats::MessageTable::kUnknown; i = table_.next(i))
    take_signals(i, *stamp);
}

void CanSurvey::take_signals(std::uint32_t message, Stamp stamp) {
  const formats::DbcMessage& layout = dbc_.messages[message];
  for (std::size_t i = 0; i < layout.signals.size(); ++i) {
    const formats::DbcSignal& signal = layout.signals[i];
    if (!signal.trouble.empty() || !layout.holds(signal, data_bytes_) ||
        data_bytes_.size < signal.bytes_needed() || !layout.is_available(signal, data_bytes_))
      continue;
    Signal& seen = signals_[message][i];
    if (seen.values++ == 0) seen.first = stamp;
    seen.last = stamp;
    const double value = signal.value(data_bytes_);
    if (std::isfinite(value)) seen.range.add(value);
  }
}

std::string CanSurvey::name_of(const Id& id) const {
  const std::string number = id.id >= formats::kExtendedFrame
                                 ? fmt::format("{:08X}", id.id & ~formats::kExtendedFrame)
                                 : fmt::format("{:03X}", id.id);
  return id.message == formats::MessageTable::kUnknown
             ? number
             : fmt::format("{} {}", number, dbc_.messages[id.message].name);
}

CanSummary CanSurvey::summary() const {
  CanSummary result;
  result.frames = frames_;
  result.stamps = stamps_;
  result.interfaces = interfaces_.summary();
  std::vector<Id> ids = ids_;
  std::stable_sort(ids.begin(), ids.end(), [](const Id& a, const Id& b) { return a.frames > b.frames; });
  for (const Id& id : ids) {
    ColumnSummary column;
    column.name = name_of(id);
    column.values = id.frames;
    column.rate_hz = rate_of(id.frames, id.first, id.last);
    column.detail = id.shortest >= id.longest ? fmt::format("{} bytes", id.longest)
                                              : fmt::format("{} to {} bytes", id.shortest, id.longest);
    result.ids.push_back(std::move(column));
  }
  for (std::size_t m = 0; m < dbc_.messages.size(); ++m) {
    const formats::DbcMessage& message = dbc_.messages[m];
    for (std::size_t s = 0; s < message.signals.size(); ++s) {
      const Signal& seen = signals_[m][s];
      if (seen.values == 0) continue;
      ColumnSummary column;
      column.name = message.name + "." + message.signals[s].name;
      column.values = seen.values;
      column.range = seen.range;
      column.unit = message.signals[s].unit;
      column.rate_hz = rate_of(seen.values, seen.first, seen.last);
      column.proposal = propose_signal(message, message.signals[s]);
      result.signals.push_back(std::move(column));
    }
  }
  keep_one_each(result.signals, true);
  return result;
}

}  // namespace waymark::inspection
