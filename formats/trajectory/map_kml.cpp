#include <array>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/text/detail/xml_text.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/trajectory/detail/map_places.hpp>

// OGC 07-147r2 fixes the order of the elements: name, visibility, description, time, styleUrl,
// geometry. Colours are aabbggrr.

namespace waymark::formats {
namespace {

/// The appearance of the fixes of a status.
struct FixStyle {
  FixStatus status;
  std::string_view color;
  std::string_view icon;  ///< shapes that Google Earth includes
};
constexpr std::array<FixStyle, 3> kFixStyles = {{{FixStatus::accepted, "ff4db34d", "placemark_circle"},
                                                 {FixStatus::rejected, "ff2827d6", "forbidden"},
                                                 {FixStatus::withheld, "ffb4771f", "placemark_square"}}};

class KmlWriter {
 public:
  KmlWriter(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes, TimeScale scale)
      : points_(points), fixes_(fixes), dates_(points, fixes, scale) {}

  [[nodiscard]] std::string write(std::string_view name) && {
    out_ = R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2">
<Document>
)";
    append("<name>{}</name><open>1</open>\n", xml_text(name));
    append_styles();
    if (points_.size() > 1) append_fused_line();
    append_raw_lines();
    if (points_.size() > 1 && dates_.known()) append_track();
    for (const FixStyle& style : kFixStyles) append_folder(to_string(style.status));
    out_ += "</Document>\n</kml>\n";
    return std::move(out_);
  }

 private:
  template <typename... Arguments>
  void append(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }

  void append_styles() {
    constexpr std::string_view kLine =
        "<Style id=\"{}\"><LineStyle><color>{}</color><width>{}</width></LineStyle></Style>\n";
    append(kLine, "fused", "ff2ca02c", 4);
    append(kLine, "raw", "ff0e7fff", 2);
    for (const FixStyle& style : kFixStyles) {
      append(
          "<Style id=\"{}\"><IconStyle><color>{}</color><scale>0.6</scale><Icon><href>"
          "http://maps.google.com/mapfiles/kml/shapes/{}.png</href></Icon></IconStyle>"
          "<LabelStyle><scale>0</scale></LabelStyle></Style>\n",
          to_string(style.status), style.color, style.icon);
    }
  }

  void append_coordinates(const MapPlace& place, char separator) {
    append("{:.9f}{}{:.9f}", place.longitude_deg, separator, place.latitude_deg);
  }

  void append_fused_line() {
    out_ +=
        "<Placemark><name>fused</name><styleUrl>#fused</styleUrl><LineString><tessellate>1</tessellate>"
        "<coordinates>\n";
    for (std::size_t i = 0; i < points_.size(); ++i) {
      append_coordinates(place_of("KML", points_, i), ',');
      out_ += '\n';
    }
    out_ += "</coordinates></LineString></Placemark>\n";
  }

  /// Adds the fixes of each receiver in turn, whatever their status.
  void append_raw_lines() {
    std::set<int> sources;
    for (const FixPoint& fix : fixes_) sources.insert(fix.source);
    for (const int source : sources) {
      std::vector<std::size_t> members;
      for (std::size_t i = 0; i < fixes_.size(); ++i) {
        if (fixes_[i].source == source) members.push_back(i);
      }
      if (members.size() < 2) continue;
      const std::string number = sources.size() > 1 ? fmt::format(", receiver {}", source + 1) : "";
      append(
          "<Placemark><name>raw GNSS{}</name><styleUrl>#raw</styleUrl><LineString><tessellate>1</tessellate>"
          "<coordinates>\n",
          number);
      for (const std::size_t i : members) {
        append_coordinates(place_of("KML", fixes_, i), ',');
        out_ += '\n';
      }
      out_ += "</coordinates></LineString></Placemark>\n";
    }
  }

  /// The track is hidden at first: it would cover the line, and a time slider hides all
  /// other moments.
  void append_track() {
    std::vector<std::size_t> kept = {0};
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const bool last = i + 1 == points_.size();
      if (last || seconds_between(points_[kept.back()].stamp, points_[i].stamp) >= 1) kept.push_back(i);
    }
    out_ +=
        "<Placemark><name>fused, by time</name><visibility>0</visibility><description>a pose a second"
        "</description><styleUrl>#fused</styleUrl><gx:Track><altitudeMode>clampToGround</altitudeMode>\n";
    for (const std::size_t i : kept) append("<when>{}</when>\n", dates_.text(points_[i].stamp));
    for (const std::size_t i : kept) {
      out_ += "<gx:coord>";
      append_coordinates(place_of("KML", points_, i), ' ');
      out_ += " 0</gx:coord>\n";
    }
    out_ += "</gx:Track></Placemark>\n";
  }

  void append_folder(std::string_view status) {
    bool open = false;
    for (std::size_t i = 0; i < fixes_.size(); ++i) {
      if (fixes_[i].status != status) continue;
      if (!open) append("<Folder><name>fixes {}</name>\n", status);
      open = true;
      append_fix(i);
    }
    if (open) out_ += "</Folder>\n";
  }

  void append_fix(std::size_t i) {
    const FixPoint& fix = fixes_[i];
    const std::string when =
        dates_.known() ? dates_.text(fix.stamp) : fmt::format("{} s", decimal_seconds(fix.stamp));
    append("<Placemark><name>fix {}</name><description>{}, {}</description>", i + 1, xml_text(verdict(fix)),
           when);
    if (dates_.known()) append("<TimeStamp><when>{}</when></TimeStamp>", when);
    append("<styleUrl>#{}</styleUrl><Point><coordinates>", fix.status);
    append_coordinates(place_of("KML", fixes_, i), ',');
    out_ += "</coordinates></Point></Placemark>\n";
  }

  std::span<const TrajectoryPoint> points_;
  std::span<const FixPoint> fixes_;
  MapDates dates_;
  std::string out_;
};

}  // namespace

std::string trajectory_kml(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes,
                           std::string_view name, TimeScale scale) {
  return KmlWriter(points, fixes, scale).write(name);
}

}  // namespace waymark::formats
