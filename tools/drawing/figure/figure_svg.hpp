/// A figure drawn as SVG.
#pragma once

#include <string>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/drawing/figure/view.hpp>

namespace waymark::drawing {

/// An SVG 1.1 document with its style inside: for a paper, an editor, a browser.
[[nodiscard]] std::string figure_svg(const Figure& figure);

/// The same drawing as an element of an HTML page, which has the style (figure_style) itself.
[[nodiscard]] std::string inline_svg(const Figure& figure);

/// Style sheet of the drawings.
[[nodiscard]] std::string figure_style();

/// What `inline_svg` shows, for who moves it.
[[nodiscard]] View drawn_view(const Figure& figure);

}  // namespace waymark::drawing
