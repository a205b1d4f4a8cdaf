/// A figure of a report before it is drawn: axes, and series of marks in the units of the axes.
///
/// One description serves three outputs: a stand-alone SVG (figure_svg.hpp), its numbers as CSV
/// (figure_csv.hpp), and a figure of a page that can be moved and zoomed (page.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waymark::drawing {

/// How the numbers of a series become marks.
enum class Mark {
  line,    ///< through (x, y) in order; a number that is not finite breaks it
  points,  ///< at (x, y); where `low` and `high` are given, with a bar between these two on the y axis
  band,    ///< between `low` and `high` over x
  spans,   ///< the whole height between `low` and `high` on the x axis
  bars,    ///< horizontal, from the axis to x in row y; `low` and `high` are the spread on the x axis
  cells    ///< squares of side 1 with their corner at (x, y); `weight` in (0, 1] says how dark
};

/// What a series stands for. Gives it a colour, a dash pattern and a marker of its own (look.hpp), so that it
/// is known again in every figure, and in grey.
enum class Look { raw, fused, truth, rejected, withheld, reference, first, second, third, fourth };

struct Series {
  std::string name{};  ///< in the legend; empty: not there
  Mark mark = Mark::line;
  Look look = Look::fused;
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> low{};
  std::vector<double> high{};
  std::vector<double> weight{};
  /// Seconds since the drive's start of each point, ascending: the cursor that is linked through all figures
  /// finds it by them. Empty: not linked.
  std::vector<double> time{};
  /// What is to be read at each point, an index into `notes`; empty: nothing, and so for -1.
  std::vector<int> note{};
  std::vector<std::string> notes{};
};

struct Axis {
  std::string title{};  ///< "position error"
  std::string unit{};   ///< "m"; empty: a pure number
  bool logarithmic = false;
  std::optional<double> low{};   ///< where the axis shall begin; empty: at the data
  std::optional<double> high{};  ///< where it shall end
  /// Names of the rows of bars, from the top; the numbers of the axis are their indices.
  std::vector<std::string> categories{};
};

/// How a figure moves on a page.
enum class Motion {
  still,  ///< not at all
  x,      ///< along x, together with all figures of its `link`; y follows what is seen
  map     ///< both ways at one scale: a metre is as long in x as in y
};

struct Figure {
  std::string id;           ///< of its files and its place on a page: [a-z0-9-]
  std::string title;        ///< a few words
  std::string description;  ///< a caption: what is seen, and how it is formed
  Axis x;
  Axis y;
  std::vector<Series> series;
  Motion motion = Motion::still;
  std::string link{};       ///< figures of one name move along x together
  bool geographic = false;  ///< has a scale bar and a north arrow (y is north, metres)
  bool downwards = false;   ///< y grows downwards, as the rows of a matrix
  int width = 880;          ///< px, with axes and legend
  int height = 300;         ///< px
};

/// "position error [m]", "share".
[[nodiscard]] std::string heading(const Axis& axis);

}  // namespace waymark::drawing
