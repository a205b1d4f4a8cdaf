// A map of any bytes: ways with places on Earth, or a refusal that a terminal can show.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/map/geojson_map.hpp>

#include "targets.hpp"

namespace waymark_fuzz {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const waymark::formats::MapWay& way) {
  require(way.points.size() >= (way.kind == waymark::formats::WayKind::building ? 3U : 2U));
  for (const Eigen::Vector2d& point : way.points)
    require(std::abs(point.x()) <= 180 && std::abs(point.y()) <= 90);
}

}  // namespace

void fuzz_geojson_map(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  std::size_t ways = 0;
  try {
    const std::size_t told = waymark::formats::read_geojson_map(text, "fuzz.geojson", [&](auto&& way) {
      check(way);
      ++ways;
    });
    require(told == ways && told > 0);
  } catch (const waymark::InputError& error) {
    const std::string message = error.what();
    require(message.starts_with("fuzz.geojson:") && message.size() < 4000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
  }
}

}  // namespace waymark_fuzz
