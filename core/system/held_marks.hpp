/// Marks of vertices that the gauge holds: one byte per vertex says whether it is free, held, or held
/// in some coordinates of its tangent only.
#pragma once

namespace waymark {

/// The vertex keeps its value, and is no unknown.
inline constexpr char kWhollyHeld = 1;

/// Coordinates of the tangent that a mark can name.
inline constexpr int kMarkedCoordinates = 6;

/// Returns the mark of one coordinate of the tangent, in [0, kMarkedCoordinates). Marks are joined by `|`.
[[nodiscard]] constexpr char mark_of_coordinate(int coordinate) {
  return static_cast<char>(2 << coordinate);
}

[[nodiscard]] constexpr bool is_wholly_held(char mark) {
  return (mark & kWhollyHeld) != 0;
}

[[nodiscard]] constexpr bool holds_coordinate(char mark, int coordinate) {
  return (mark & mark_of_coordinate(coordinate)) != 0;
}

}  // namespace waymark
