/// Colour, dash pattern, marker and hatching of each look. Each of these alone
/// distinguishes the looks.
#pragma once

#include <span>
#include <string_view>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

struct LookStyle {
  Look look;
  std::string_view name;  ///< name of its class in the style sheet
  /// from the palette of Okabe and Ito, which colour-blind readers can distinguish
  std::string_view colour;
  std::string_view dash;    ///< SVG stroke-dasharray of a line; empty: solid
  std::string_view marker;  ///< relative SVG path about a point, px
  std::string_view hatch;   ///< SVG path of strokes in a tile of 6 x 6 px, over bars; empty: none
};

[[nodiscard]] std::span<const LookStyle> all_looks();
[[nodiscard]] const LookStyle& style_of(Look look);

/// Returns looks for the systems of a comparison, in turn. @param index from 0; after the last look
/// the first one follows
[[nodiscard]] Look look_of_system(std::size_t index);

}  // namespace waymark::drawing
