#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/text/number_text.hpp>

namespace waymark::text {

std::string decimals(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::string readable(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

}  // namespace waymark::text
