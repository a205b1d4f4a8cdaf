#include <waymark/formats/logs/detail/rtklib/rtklib_header.hpp>

#include <array>
#include <cmath>

#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

struct LayoutNames {
  RtklibLayout layout;
  std::string_view first;     ///< name of the first position column
  std::string_view sigma;     ///< name of the first column of standard deviations
  std::string_view velocity;  ///< name of the first velocity column
};
constexpr std::array<LayoutNames, 4> kLayouts{{
    {RtklibLayout::degrees, "latitude(deg)", "sdn(m)", "vn(m/s)"},
    {RtklibLayout::sexagesimal, "latitude(d'\")", "sdn(m)", "vn(m/s)"},
    {RtklibLayout::ecef, "x-ecef(m)", "sdx(m)", "vx(m/s)"},
    {RtklibLayout::baseline, "e-baseline(m)", "sde(m)", "ve(m/s)"},
}};

/// Reads latitude, longitude and height; degrees are one field or three.
std::optional<GeodeticPlace> read_reference(std::string_view text) {
  RecordFields words;
  words.split_words(text);
  std::array<double, 7> number{};
  if (words.count() != 3 && words.count() != 7) return std::nullopt;
  for (std::size_t i = 0; i < words.count(); ++i) {
    const std::optional<double> value = field_number(words[i]);
    if (!value) return std::nullopt;
    number[i] = *value;
  }
  GeodeticPlace place{number[0], number[1], number[2]};
  if (words.count() == 7) {
    const auto degrees = [&](std::size_t at) {
      return std::copysign(std::abs(number[at]) + number[at + 1] / 60 + number[at + 2] / 3600, number[at]);
    };
    place = {degrees(0), degrees(3), number[6]};
  }
  // In x/y/z solutions the reference is in metres.
  if (std::abs(place.latitude_deg) > 90 || std::abs(place.longitude_deg) > 360) return std::nullopt;
  return place;
}

bool set_scale(RtklibHeader& header, std::string_view word) {
  if (word != "GPST" && word != "UTC" && word != "JST") return false;
  header.scale = word == "GPST" ? TimeScale::gps : TimeScale::utc;
  header.hours_ahead = word == "JST" ? 9 : 0;
  return true;
}

}  // namespace

bool RtklibHeader::take(std::string_view line) {
  line.remove_prefix(1);
  if (line.find("/height=") != std::string_view::npos)
    above_geoid = line.find("/geodetic") != std::string_view::npos;
  if (line.find("ref pos") != std::string_view::npos && line.find(':') != std::string_view::npos) {
    reference = read_reference(line.substr(line.find(':') + 1));
    return false;
  }
  RecordFields words;
  words.split_words(line);
  for (const LayoutNames& names : kLayouts) {
    if (words[1] != names.first || !set_scale(*this, words[0])) continue;
    layout = names.layout;
    const std::size_t shift =
        // fields of time and position up to a name, minus the names
        layout == RtklibLayout::sexagesimal ? 5 : 1;
    const auto place_of = [&](std::string_view name) -> std::size_t {
      for (std::size_t i = 4; i < words.count(); ++i) {
        if (words[i] == name) return i + shift;
      }
      return 0;
    };
    fields = words.count() + shift;
    quality = place_of("Q");
    sigma = place_of(names.sigma);
    velocity = place_of(names.velocity);
    names_columns = quality > 0;
    return names_columns;
  }
  return false;
}

}  // namespace waymark::formats
