/// The description of a figure before it is drawn: axes, and series of marks in the units
/// of the axes.
///
/// One description serves three outputs: a stand-alone SVG (figure_svg.hpp), its numbers as CSV
/// (figure_csv.hpp), and a figure of a page that can be moved and zoomed (page.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waymark::drawing {

/// How the numbers of a series are drawn.
enum class Mark {
  line,    ///< through (x, y) in order; a number that is not finite interrupts it
  points,  ///< at (x, y), with a bar from `low` to `high` on the y axis if these are given
  band,    ///< between `low` and `high` over x
  spans,   ///< over the whole height, between `low` and `high` on the x axis
  /// horizontal, from the axis to x in row y; `low` and `high` are the spread on the x axis
  bars,
  cells,  ///< squares of side 1 with a corner at (x, y); `weight` in (0, 1] is the darkness
  areas   ///< closed rings through (x, y), filled; a number that is not finite ends a ring
};

/// The role of a series. Each role has its own colour, dash pattern and marker (look.hpp). So a
/// series looks the same in every figure, and can be recognised in grey too.
enum class Look {
  raw,
  fused,
  truth,
  rejected,
  withheld,
  reference,
  first,
  second,
  third,
  fourth,
  road,     ///< of a map beneath a trajectory
  building  ///< likewise
};

struct Series {
  std::string name{};  ///< its name in the legend; empty: it has no entry
  Mark mark = Mark::line;
  Look look = Look::fused;
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> low{};
  std::vector<double> high{};
  std::vector<double> weight{};
  /// Seconds since the start of the drive for each point, ascending. The cursor that links all
  /// figures finds points by these times. Empty: not linked.
  std::vector<double> time{};
  /// The note of each point, an index into `notes`. -1 or an empty vector: no note.
  std::vector<int> note{};
  std::vector<std::string> notes{};
  bool in_view = true;  ///< false: the axes need not hold it, as a map beneath a trajectory
};

struct Axis {
  std::string title{};  ///< "position error"
  std::string unit{};   ///< "m"; empty: a pure number
  bool logarithmic = false;
  std::optional<double> low{};   ///< begin of the axis; empty: the data decide
  std::optional<double> high{};  ///< end of the axis
  /// The names of the rows of a bar figure, from the top. The numbers of the axis are
  /// their indices.
  std::vector<std::string> categories{};
};

/// Where the points of a map are on Earth, and how well they are known. The page tells it at the
/// cursor. All columns have one length, or are empty if they are not known.
struct Places {
  std::vector<double> time{};  ///< s since the start, ascending
  std::vector<double> x{};     ///< in the units of the axes
  std::vector<double> y{};
  std::vector<double> latitude_deg{};  ///< WGS84
  std::vector<double> longitude_deg{};
  std::vector<double> xx{};  ///< covariance of the position, squared units of the axes
  std::vector<double> xy{};
  std::vector<double> yy{};
  std::vector<int> quality{};  ///< of the fix, an index into `qualities`; empty: not told
  std::vector<std::string> qualities{};
  std::optional<double> start_utc_s{};  ///< POSIX time of the start; empty: the date is not known
};

/// How a figure can be moved on a page.
enum class Motion {
  still,  ///< not at all
  x,      ///< along x, together with all figures with the same `link`; y adapts to the visible part
  map     ///< both ways at one scale: a metre is equally long in x and y
};

struct Figure {
  std::string id;           ///< for its files and its place on a page: [a-z0-9-]
  std::string title;        ///< a few words
  std::string description;  ///< the caption: what the figure shows, and how it is computed
  Axis x;
  Axis y;
  std::vector<Series> series;
  Motion motion = Motion::still;
  std::string link{};              ///< figures with the same name move along x together
  bool geographic = false;         ///< has a scale bar and a north arrow (y is north, metres)
  bool downwards = false;          ///< y grows downwards, like the rows of a matrix
  std::optional<Places> places{};  ///< of a map
  int width = 880;                 ///< px, with axes and legend
  int height = 300;                ///< px
  double grain = 1;                ///< px; smaller details of lines and markers are not drawn
};

/// Returns "position error [m]", or "share" without a unit.
[[nodiscard]] std::string heading(const Axis& axis);

}  // namespace waymark::drawing
