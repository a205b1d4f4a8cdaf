/// Draws a figure as SVG.
#pragma once

#include <string>
#include <string_view>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// Returns an SVG 1.1 document that includes its style, for a paper, an editor or a browser.
[[nodiscard]] std::string figure_svg(const Figure& figure);

/// Returns the same drawing as an element of an HTML page. The page must have the style
/// (figure_style).
/// @param screen a class of the element: the screens that show it
[[nodiscard]] std::string inline_svg(const Figure& figure, std::string_view screen);

/// Returns the style sheet of the drawings.
[[nodiscard]] std::string figure_style();

/// Returns the view that `inline_svg` draws, for the script that moves it.
[[nodiscard]] View drawn_view(const Figure& figure);

}  // namespace waymark::drawing
