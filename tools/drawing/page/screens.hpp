/// The drawings of a figure for screens of several widths. One drawing that is made larger and
/// smaller has letters that are too small on a telephone and too large on a wide screen.
#pragma once

#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::drawing {

/// A drawing of a figure, and the screens for which it is made.
struct DrawingForScreen {
  /// its class in the style sheet: "narrow" (below 600 px), "wide" (from 1200 px), or "usual"
  std::string screen{};
  std::string id{};
  int width = 0;     ///< px
  int height = 0;    ///< px
  double grain = 1;  ///< px

  /// Gives a figure the id, size and grain of this drawing.
  void apply(Figure& figure) const;
};

/// Returns the drawings of a figure: a narrow one, a wide one if the figure has the whole width of a
/// page, and the usual one last. The first two have a coarser grain, because a page holds them all;
/// the script draws them finely as soon as they are moved.
[[nodiscard]] std::vector<DrawingForScreen> drawings_for_screens(const Figure& figure);

}  // namespace waymark::drawing
