#include <waymark/formats/logs/detail/gpsd/gpsd_report.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, static_cast<std::size_t>(GpsdNumber::count)> kNumberNames{
    "mode",  "status", "lat",   "lon", "altHAE", "alt",   "epx",    "epy",    "eph",
    "track", "epd",    "speed", "eps", "major",  "minor", "orient", "dgpsAge"};

/// Takes the events of the parser. A tree of objects (json::parse) would allocate for every member,
/// and copying it would recurse as deep as the text is nested.
class Collector {
 public:
  explicit Collector(GpsdReport& report) : report_(report) {}

  bool null() { return true; }
  bool boolean(bool value) { return other(value ? "true" : "false"); }
  bool number_integer(json::number_integer_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(json::number_unsigned_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool string(std::string& value) {
    if (depth_ != 1) return true;
    if (text_ != nullptr) {
      *text_ = std::move(value);
      return true;
    }
    return other('"' + shown_name(value) + '"');
  }
  bool binary(json::binary_t&) { return true; }
  bool start_object(std::size_t) {
    other("an object");
    ++depth_;
    return true;
  }
  bool end_object() { return leave(); }
  bool start_array(std::size_t) {
    other("an array");
    ++depth_;
    return true;
  }
  bool end_array() { return leave(); }
  bool key(const std::string& name) {
    if (depth_ != 1) return true;
    text_ = name == "class"     ? &report_.kind
            : name == "time"    ? &report_.time
            : name == "device"  ? &report_.device
            : name == "release" ? &report_.release
                                : nullptr;
    const auto* known = std::find(kNumberNames.begin(), kNumberNames.end(), name);
    member_ = known == kNumberNames.end()
                  ? nullptr
                  : &report_.numbers[static_cast<std::size_t>(known - kNumberNames.begin())];
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const json::exception& error) {
    constexpr int kOutOfRange = 406;
    if (error.id == kOutOfRange) throw BadGpsdLine{1, "a number is out of range"};
    throw BadGpsdLine{std::max<std::size_t>(1, position), "malformed JSON"};
  }

 private:
  bool leave() {
    --depth_;
    return true;
  }
  bool number(double value) {
    if (depth_ == 1 && member_ != nullptr) *member_ = {value, std::isfinite(value), {}};
    return true;
  }
  bool other(const std::string& what) {
    if (depth_ == 1 && member_ != nullptr) *member_ = {0, true, what};
    return true;
  }

  GpsdReport& report_;
  std::size_t depth_ = 0;
  std::string* text_ = nullptr;  ///< of the current member; null: the member is not read
  GpsdReport::Member* member_ = nullptr;
};

void replace(std::string& text, const std::string& later) {
  if (!later.empty()) text = later;
}

}  // namespace

std::optional<double> GpsdReport::number(GpsdNumber key) const {
  const Member& member = numbers[static_cast<std::size_t>(key)];
  if (!member.given) return std::nullopt;
  if (!member.not_a_number.empty())
    throw BadGpsdMember{fmt::format("{}: expected a number for '{}', got {}", kind,
                                    kNumberNames[static_cast<std::size_t>(key)], member.not_a_number)};
  return member.value;
}

void GpsdReport::update(const GpsdReport& later) {
  replace(time, later.time);
  replace(device, later.device);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (later.numbers[k].given) numbers[k] = later.numbers[k];
  }
}

std::string_view gpsd_class(std::string_view line) {
  constexpr std::size_t kLongestClass = 40;
  constexpr std::string_view kStart = "{\"class\":\"";
  if (!line.starts_with(kStart)) return {};
  line.remove_prefix(kStart.size());
  const std::size_t end = line.substr(0, kLongestClass).find('"');
  return end == std::string_view::npos ? std::string_view() : line.substr(0, end);
}

GpsdReport read_gpsd_report(std::string_view line) {
  GpsdReport report;
  Collector collector(report);
  json::sax_parse(line, &collector);
  return report;
}

}  // namespace waymark::formats
