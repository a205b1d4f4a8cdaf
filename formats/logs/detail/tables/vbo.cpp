#include <waymark/formats/logs/detail/tables/vbo.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/csv/csv_table.hpp>
#include <waymark/formats/logs/detail/csv/table_time.hpp>
#include <waymark/formats/logs/detail/tables/table_inside.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kCreated = "File created on ";
constexpr std::string_view kNames = "[column names]";
constexpr std::string_view kData = "[data]";
/// `sats` holds flags from this one on: brake trigger, differential.
constexpr int kFirstFlag = 64;

const std::array<KnownColumn, 6> kVboColumns{{
    {"time", "hms", "", {"time"}},
    {"latitude", "min", "", {"lat", "latitude"}},
    {"longitude", "min", "positive_west", {"long", "longitude"}},
    {"speed", "km/h", "", {"velocity"}},
    {"course", "deg", "", {"heading"}},
    {"height", "m", "", {"height"}},
}};

class VboDecoder final : public TableInside {
 public:
  using TableInside::TableInside;

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;
  void begin(std::string_view names, std::size_t number);
  [[nodiscard]] bool has_satellites(std::string_view row);

  enum class Part { head, names, between, data };
  Part part_ = Part::head;
  std::optional<Stamp> created_;  ///< the day
  std::optional<std::size_t> satellites_;
  std::vector<std::string_view> fields_;
};

void VboDecoder::take_line(std::string_view line, std::size_t number) {
  if (line.starts_with(kCreated)) {
    const std::string_view rest = line.substr(kCreated.size());
    if (const auto day = date_from_field(rest.substr(0, rest.find(' ')), "dmy")) created_ = day->stamp;
  }
  if (line.starts_with('[')) {
    part_ = line.starts_with(kNames) ? Part::names : line.starts_with(kData) ? Part::data : Part::between;
    return;
  }
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  if (part_ == Part::names && !is_open()) return begin(line, number);
  if (part_ != Part::data) return;
  if (!is_open())
    throw InputError(fmt::format("{}:{}: data before the section '{}'", path(), number, kNames));
  if (has_satellites(line)) return give_row(line, number);
  ++data_.records;
  ++data_.without_fix;
}

void VboDecoder::begin(std::string_view names, std::size_t number) {
  (void)split_fields(names, ' ', fields_);
  const auto place = std::find(fields_.begin(), fields_.end(), "sats");
  if (place != fields_.end()) satellites_ = static_cast<std::size_t>(place - fields_.begin());
  LogRequest inner = request();
  if (!inner.date && created_) {
    inner.date = created_;
    note("the date is that of the file's first line, which is local; 'time: {date: ...}' states the UTC one");
  }
  open_table(names, number, kVboColumns, ' ', TimeScale::utc, std::move(inner));
}

bool VboDecoder::has_satellites(std::string_view row) {
  if (!satellites_ || !split_fields(row, ' ', fields_) || fields_.size() <= *satellites_) return true;
  const std::string_view field = fields_[*satellites_];
  int count = 1;
  std::from_chars(field.data(), field.data() + field.size(), count);
  return count % kFirstFlag != 0;
}

void VboDecoder::end() {
  if (!is_open()) throw InputError(fmt::format("{}: the file has no section '{}'", path(), kNames));
  finish_table();
}

}  // namespace

std::unique_ptr<LogDecoder> VboReader::open(const std::string& path, const LogRequest& request) const {
  require_streams(path, request, "a VBO file", {StreamKind::gnss, StreamKind::truth});
  require_companions(path, request, "a VBO file");
  return std::make_unique<VboDecoder>(path, request);
}

Recognition VboReader::recognise(std::string_view head) const {
  if (head.find(kNames) == std::string_view::npos) return {};
  return {0.95, "it has the section '[column names]' of a VBO file"};
}

}  // namespace waymark::formats
