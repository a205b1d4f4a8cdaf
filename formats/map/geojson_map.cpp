#include <waymark/formats/map/geojson_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>

namespace waymark::formats {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepestMap = 100;

/// Properties of features that are neither roads nor buildings.
constexpr std::array<std::string_view, 14> kOtherThings{
    "landuse", "natural", "leisure",   "boundary", "waterway", "railway",     "place",
    "power",   "barrier", "aerialway", "route",    "man_made", "admin_level", "amenity"};

/// One geometry, as far as it is read. Its type may come after its coordinates.
struct MapGeometry {
  bool closed = false;
  std::vector<std::vector<Eigen::Vector2d>> lines{};
};

/// What the properties of a feature say.
struct Tags {
  bool road = false;
  bool building = false;
  bool other = false;
};

/// Takes the events of the parser. A tree of objects (json::parse) of a town would be many times as
/// large as its text.
class MapReader {
 public:
  explicit MapReader(const std::function<void(MapWay&&)>& take) : take_(take) {}

  [[nodiscard]] std::size_t ways() const { return ways_; }
  [[nodiscard]] std::size_t features() const { return features_; }
  /// Why the reader stopped; empty: the text is no JSON.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }
  [[nodiscard]] std::size_t byte() const { return byte_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

  bool null() { return value({}); }
  bool boolean(bool yes) { return value(yes ? "yes" : "no"); }
  bool number_integer(json::number_integer_t number) { return coordinate(static_cast<double>(number)); }
  bool number_unsigned(json::number_unsigned_t number) { return coordinate(static_cast<double>(number)); }
  bool number_float(double number, const std::string&) { return coordinate(number); }
  bool string(std::string& text) {
    if (key_ == "type" && !levels_.empty()) levels_.back().geometry.closed = text.ends_with("Polygon");
    return value(text);
  }
  bool binary(json::binary_t&) { return true; }
  bool key(std::string& name) {
    key_ = std::move(name);
    return true;
  }

  bool start_object(std::size_t) {
    if (in_coordinates()) return stop("an object among coordinates");
    return enter({.name = std::exchange(key_, {})});
  }
  bool end_object() {
    Level done = std::move(levels_.back());
    levels_.pop_back();
    key_.clear();
    std::vector<MapGeometry>& upward = levels_.empty() ? at_root_ : levels_.back().within;
    if (!done.geometry.lines.empty()) upward.push_back(std::move(done.geometry));
    // Only features have properties, and may be inside no other feature.
    if (done.has_properties) {
      ++features_;
      give(done.within, done.tags);
    } else {
      upward.insert(upward.end(), std::make_move_iterator(done.within.begin()),
                    std::make_move_iterator(done.within.end()));
      if (levels_.empty()) give(at_root_, {});
    }
    return true;
  }
  bool start_array(std::size_t) {
    const bool begins = !in_coordinates() && key_ == "coordinates" && !levels_.empty() && !in_properties();
    if (begins || in_coordinates()) ++coordinate_depth_;
    if (begins) levels_.back().geometry.lines.emplace_back();
    position_.clear();
    return enter({.name = std::exchange(key_, {}), .is_array = true});
  }
  bool end_array() {
    std::vector<MapGeometry> within = std::move(levels_.back().within);
    levels_.pop_back();
    std::vector<MapGeometry>& upward = levels_.empty() ? at_root_ : levels_.back().within;
    upward.insert(upward.end(), std::make_move_iterator(within.begin()),
                  std::make_move_iterator(within.end()));
    if (!in_coordinates()) return true;
    std::vector<std::vector<Eigen::Vector2d>>& lines = geometry_level().geometry.lines;
    --coordinate_depth_;
    if (!position_.empty()) {
      if (!add_position(lines.back())) return false;
    } else if (!lines.back().empty()) {
      lines.emplace_back();  // the next ring or line
    }
    position_.clear();
    if (!in_coordinates() && lines.back().empty()) lines.pop_back();
    return true;
  }
  bool parse_error(std::size_t byte, const std::string&, const json::exception& error) {
    byte_ = byte > 0 ? byte - 1 : 0;
    reason_ = error.what();
    return false;
  }

 private:
  /// An object or array that is open.
  struct Level {
    std::string name{};  ///< the key in the object around it
    bool is_array = false;
    bool has_properties = false;
    MapGeometry geometry{};             ///< of this object
    std::vector<MapGeometry> within{};  ///< of the objects in it
    Tags tags{};
  };

  [[nodiscard]] bool in_coordinates() const { return coordinate_depth_ > 0; }
  [[nodiscard]] bool in_properties() const {
    return std::any_of(levels_.begin(), levels_.end(),
                       [](const Level& level) { return level.name == "properties"; });
  }
  /// The object whose coordinates are read: below the arrays of its coordinates.
  [[nodiscard]] Level& geometry_level() {
    return *std::find_if(levels_.rbegin(), levels_.rend(),
                         [](const Level& level) { return !level.is_array; });
  }
  bool stop(std::string complaint) {
    complaint_ = std::move(complaint);
    return false;
  }
  bool enter(Level level) {
    if (levels_.size() == kDeepestMap)
      return stop(fmt::format("lists and objects are nested more than {} deep", kDeepestMap));
    if (level.name == "properties" && !levels_.empty()) levels_.back().has_properties = true;
    levels_.push_back(std::move(level));
    return true;
  }
  bool coordinate(double number) {
    if (!in_coordinates()) return value("number");
    position_.push_back(number);
    return position_.size() < 10 || stop("a position of more than 9 numbers");
  }
  bool add_position(std::vector<Eigen::Vector2d>& line) {
    if (position_.size() < 2) return stop("a position has fewer than two numbers");
    const double longitude = position_[0];
    const double latitude = position_[1];
    if (!(std::abs(longitude) <= 180 && std::abs(latitude) <= 90))
      return stop(fmt::format(
          "[{}, {}] is no longitude and latitude in degrees; convert the file to WGS84, for example with "
          "'ogr2ogr -t_srs EPSG:4326 out.geojson IN'",
          longitude, latitude));
    line.emplace_back(longitude, latitude);
    return true;
  }
  /// A value that is no part of coordinates.
  bool value(std::string_view text) {
    if (in_coordinates()) return stop("something else than numbers among coordinates");
    if (key_ == "properties" && !levels_.empty()) levels_.back().has_properties = true;  // null
    if (levels_.size() < 2 || levels_.back().name != "properties" || text.empty() || text == "no")
      return true;
    Tags& tags = levels_[levels_.size() - 2].tags;
    if (key_ == "highway") tags.road = true;
    if (key_ == "building") tags.building = true;
    if (std::find(kOtherThings.begin(), kOtherThings.end(), key_) != kOtherThings.end()) tags.other = true;
    return true;
  }
  void give(std::vector<MapGeometry>& geometries, const Tags& tags) {
    for (MapGeometry& geometry : geometries) {
      const bool is_building = geometry.closed && !tags.road;
      const bool is_named = is_building ? tags.building : tags.road;
      // osmium exports the outline of a building as a line, too.
      if (!is_named && (tags.other || (tags.building && !geometry.closed))) continue;
      for (auto& line : geometry.lines) {
        if (line.size() < (is_building ? 3U : 2U)) continue;
        ++ways_;
        take_({is_building ? WayKind::building : WayKind::road, std::move(line)});
      }
    }
    geometries.clear();
  }

  const std::function<void(MapWay&&)>& take_;
  std::vector<Level> levels_;
  std::vector<MapGeometry> at_root_;
  std::string key_;
  int coordinate_depth_ = 0;
  std::vector<double> position_;
  std::size_t ways_ = 0;
  std::size_t features_ = 0;
  std::string complaint_;
  std::string reason_;
  std::size_t byte_ = 0;
};

/// Counts the bytes that the parser has read, so that an error has a place.
class CountedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountedText(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  CountedText& operator++() {
    ++at_;
    if (reached_ != nullptr) *reached_ = at_;
    return *this;
  }
  CountedText operator++(int) {
    CountedText before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountedText& a, const CountedText& b) { return a.at_ == b.at_; }
  friend bool operator!=(const CountedText& a, const CountedText& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  const char** reached_;
};

[[noreturn]] void fail_at(std::string_view text, std::size_t byte, const std::string& name,
                          const std::string& why) {
  const std::string_view before = text.substr(0, byte);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t begin = before.find_last_of('\n') + 1;  // npos + 1 is 0
  throw InputError(fmt::format("{}:{}:{}: {}", name, line, before.size() - begin + 1, why));
}

/// Returns a message of the library without its number, not longer than a line or two, and with nothing
/// that steers a terminal: it repeats the text that was read.
std::string shortened(std::string why) {
  constexpr std::size_t kLongest = 200;
  const std::size_t prefix = why.find(": ");
  if (prefix != std::string::npos) why.erase(0, prefix + 2);
  if (why.size() > kLongest) why = why.substr(0, kLongest) + "...";
  std::replace_if(
      why.begin(), why.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return why;
}

}  // namespace

std::size_t read_geojson_map(std::string_view text, const std::string& name,
                             const std::function<void(MapWay&&)>& take) {
  MapReader reader(take);
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* reached = begin;
  const bool whole = json::sax_parse(CountedText(begin, &reached), CountedText(end, nullptr), &reader);
  if (!whole && !reader.complaint().empty())
    fail_at(text, static_cast<std::size_t>(reached - begin), name, reader.complaint());
  if (!whole)
    fail_at(text, std::min(reader.byte(), text.size()), name, "is no JSON: " + shortened(reader.reason()));
  if (reader.ways() == 0)
    throw InputError(fmt::format(
        "{}: has neither roads nor buildings ({} features): GeoJSON with lines and polygons is expected, "
        "for example from 'osmium export'",
        name, reader.features()));
  return reader.ways();
}

}  // namespace waymark::formats
