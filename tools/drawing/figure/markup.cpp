#include <cmath>

#include <fmt/format.h>

#include <waymark/formats/text/detail/xml_text.hpp>
#include <waymark/tools/drawing/figure/markup.hpp>

namespace waymark::drawing {
std::string escaped(std::string_view text) {
  return formats::xml_text(text);
}

std::string px(double value) {
  if (!std::isfinite(value)) return "0";
  const double tenths = std::round(value * 10);
  return fmt::format("{:g}", tenths == 0 ? 0.0 : tenths / 10);  // no minus zero
}

}  // namespace waymark::drawing
