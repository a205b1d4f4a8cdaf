#include <waymark/formats/logs/detail/gpx/gpx.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/common/position_stream.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>
#include <waymark/formats/logs/detail/common/table_accuracy.hpp>
#include <waymark/formats/text/detail/byte_order_mark.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/detail/xml_stream.hpp>
#include <waymark/formats/text/iso8601.hpp>

namespace waymark::formats {
namespace {

constexpr const char* kGpxFormat = "a GPX track";
constexpr std::size_t kLongestText = 64;  // longer than any number or date
// characters kept of a text: one more, so that a text that is too long is noticed
constexpr std::size_t kKept = kLongestText + 1;

/// The members of a point that are read.
enum Item : std::size_t {
  kTimeItem,
  kElevationItem,
  kGeoidHeightItem,
  kHdopItem,
  kFixItem,
  kSatellitesItem,
  kAgeItem,
  kSpeedItem,
  kCourseItem,
  kItems
};
struct ItemName {
  std::string_view name;
  bool in_extensions;  ///< also read in extensions
};
constexpr std::array<ItemName, kItems> kItemNames{{{"time", false},
                                                   {"ele", false},
                                                   {"geoidheight", false},
                                                   {"hdop", false},
                                                   {"fix", false},
                                                   {"sat", false},
                                                   {"ageofdgpsdata", false},
                                                   {"speed", true},
                                                   {"course", true}}};

std::string_view without_space(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// A point of a track, as texts.
struct Point {
  bool open = false;
  std::size_t depth = 0;
  std::size_t line = 0;
  std::size_t column = 0;
  std::string latitude;
  std::string longitude;
  std::array<std::string, kItems> items;  ///< empty: not given

  void reset() {
    latitude.clear();
    longitude.clear();
    for (std::string& item : items) item.clear();
  }
};

class GpxDecoder final : public LogDecoder, private XmlStream {
 public:
  GpxDecoder(std::string path, const LogRequest& request)
      : path_(std::move(path)), positions_(path_, request, nullptr) {}
  void take(std::string_view piece) override { XmlStream::take(piece); }
  void finish() override;

 private:
  void begin(std::string_view name, const char** attributes) override;
  void end(std::string_view name) override;
  void text(std::string_view part) override;

  void begin_point(const char** attributes);
  void begin_item(std::string_view name);
  void add_point();
  [[nodiscard]] std::optional<double> number(std::string_view text, std::string_view name, double smallest,
                                             double largest);
  [[nodiscard]] std::optional<double> number(Item item, double smallest, double largest) {
    return number(point_.items[item], kItemNames[item].name, smallest, largest);
  }
  void complain(const std::string& what);

  std::string path_;
  PositionStream positions_;
  Point point_;
  std::string* text_ = nullptr;  ///< destination of the current text; null: none
  std::string what_;             ///< the first error of the point; empty: none
  std::size_t track_points_ = 0;
  std::size_t route_points_ = 0;
  std::size_t waypoints_ = 0;
  bool any_height_ = false;
};

void GpxDecoder::begin(std::string_view name, const char** attributes) {
  text_ = nullptr;
  if (depth() == 1 && name != "gpx")
    throw InputError(fmt::format("{}: the root element is {}, expected 'gpx'", path_, quote_word(name)));
  if (point_.open) {
    begin_item(name);
  } else if (name == "trkpt") {
    begin_point(attributes);
    return;
  } else if (name == "rtept") {
    ++route_points_;
  } else if (name == "wpt") {
    ++waypoints_;
  } else {
    count_unknown(name);
  }
  for (; *attributes != nullptr; attributes += 2) count_unknown(*attributes);
}

void GpxDecoder::begin_point(const char** attributes) {
  point_.reset();
  point_.open = true;
  point_.depth = depth();
  point_.line = line();
  point_.column = column();
  for (; *attributes != nullptr; attributes += 2) {
    const std::string_view name = attributes[0];
    if (name == "lat") {
      point_.latitude = std::string_view(attributes[1]).substr(0, kKept);
    } else if (name == "lon") {
      point_.longitude = std::string_view(attributes[1]).substr(0, kKept);
    } else {
      count_unknown(name);
    }
  }
}

void GpxDecoder::begin_item(std::string_view name) {
  for (std::size_t item = 0; item < kItems; ++item) {
    if (name != kItemNames[item].name) continue;
    const bool is_child = depth() == point_.depth + 1;
    if ((is_child || kItemNames[item].in_extensions) && point_.items[item].empty())
      text_ = &point_.items[item];
    return;
  }
  count_unknown(name);
}

void GpxDecoder::text(std::string_view part) {
  if (text_ != nullptr && text_->size() < kKept) *text_ += part.substr(0, kKept - text_->size());
}

void GpxDecoder::end(std::string_view) {
  text_ = nullptr;
  if (!point_.open || depth() != point_.depth) return;
  point_.open = false;
  ++track_points_;
  ++data_.records;
  what_.clear();
  add_point();
  if (!what_.empty()) add_corrupt(data_, path_, point_.line, point_.column, "trkpt: " + what_);
}

void GpxDecoder::add_point() {
  if (without_space(point_.items[kFixItem]) == "none") {
    ++data_.without_fix;
    return;
  }
  constexpr double kAny = 1e6;
  const std::optional<double> latitude = number(point_.latitude, "lat", -90, 90);
  const std::optional<double> longitude = number(point_.longitude, "lon", -180, 360);
  const std::optional<double> elevation = number(kElevationItem, -kAny, kAny);
  const std::optional<double> geoid_height = number(kGeoidHeightItem, -kAny, kAny);
  const std::optional<double> hdop = number(kHdopItem, 0, kAny);
  const std::optional<double> speed = number(kSpeedItem, 0, 1000);
  const std::optional<double> course = number(kCourseItem, 0, 360);
  const std::optional<double> satellites = number(kSatellitesItem, 0, 999);
  const std::optional<double> age_s = number(kAgeItem, 0, kAny);
  const std::string_view time = without_space(point_.items[kTimeItem]);
  if (!latitude || !longitude) complain("without lat and lon");
  if (time.empty()) complain("without a time");
  std::optional<Stamp> stamp = stamp_from_iso8601(time);
  if (!stamp) complain(fmt::format("time: expected an ISO 8601 date, got {}", quote_word(time)));
  if (stamp) stamp = positions_.stamp(*stamp, TimeScale::utc);
  if (!stamp) complain("its time is too large for a stamp");
  if (!what_.empty()) return;

  GeodeticFix fix;
  fix.stamp = *stamp;
  fix.latitude_deg = *latitude;
  fix.longitude_deg = *longitude;
  if (elevation) fix.height_m = *elevation + geoid_height.value_or(0);
  fix.speed_mps = speed;
  if (course) fix.course_rad = *course * std::numbers::pi / 180;
  fix.line = point_.line;
  // none, 2d, 3d, dgps and pps, which is military
  const std::optional<TableQuality> quality = table_quality(without_space(point_.items[kFixItem]), "gga");
  if (quality) fix.told.quality = quality->quality;
  fix.told.hdop = hdop.value_or(0);
  fix.told.satellites = static_cast<int>(satellites.value_or(-1));
  fix.told.correction_age_s = age_s.value_or(fix.told.correction_age_s);
  const char* complaint = positions_.add(data_, fix, {});
  if (complaint != nullptr) return complain(complaint);
  any_height_ = any_height_ || (elevation && !geoid_height);
}

/// Reads a number. It is empty if there is no text. A wrong text is an error. A negative number is
/// ignored if it cannot be negative: telephones write -1 for "unknown".
std::optional<double> GpxDecoder::number(std::string_view text, std::string_view name, double smallest,
                                         double largest) {
  const std::string_view word = without_space(text);
  if (word.empty()) return std::nullopt;
  const bool whole = text.size() <= kLongestText;
  const std::optional<double> value = whole ? field_number(word) : std::nullopt;
  if (!value) complain(fmt::format("{}: expected a number, got {}", name, quote_word(word)));
  if (!value || (*value >= smallest && *value <= largest)) return value;
  if (smallest == 0 && *value < 0) return std::nullopt;
  complain(fmt::format("{}: {} is outside {} .. {}", name, *value, smallest, largest));
  return std::nullopt;
}

void GpxDecoder::complain(const std::string& what) {
  if (what_.empty()) what_ = what;
}

void GpxDecoder::finish() {
  XmlStream::finish();
  if (!trouble().empty()) {
    ++data_.records;
    add_corrupt(data_, path_, trouble_line(), trouble_column(), trouble() + "; the part before is used");
  }
  const auto count = [&](const char* kind, std::size_t points) {
    if (points > 0) data_.kinds[kind] = points;
  };
  count("trkpt", track_points_);
  count("rtept", route_points_);
  count("wpt", waypoints_);
  const auto note = [&](const std::string& text) { data_.notes.push_back(path_ + ": " + text); };
  if (route_points_ + waypoints_ > 0)
    note(fmt::format("{} route points and {} waypoints were skipped: they record no drive", route_points_,
                     waypoints_));
  if (any_height_) note("heights are elevations as GPX has them, as a rule above the geoid");
  positions_.finish(data_);
}

}  // namespace

std::unique_ptr<LogDecoder> GpxReader::open(const std::string& path, const LogRequest& request) const {
  require_positions(path, request, kGpxFormat);
  return std::make_unique<GpxDecoder>(path, request);
}

Recognition GpxReader::recognise(std::string_view head) const {
  head = without_byte_order_mark(head);
  const std::size_t start = head.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos || head[start] != '<') return {};
  const std::size_t root = head.find("<gpx");
  if (root == std::string_view::npos || root + 4 >= head.size()) return {};
  if (std::string_view(" \t\r\n>").find(head[root + 4]) == std::string_view::npos) return {};
  return {1, "an XML document with the element <gpx>"};
}

}  // namespace waymark::formats
