/// The messages of NovAtel that are read, and the places of their fields (OEM7 Commands and Logs).
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace waymark::formats {

/// The place of a field that a message does not have.
inline constexpr std::size_t kNoField = 99;

/// The places of the fields of a message: 0-based fields of its body.
struct NovatelLayout {
  std::string_view name;
  /// rank of its positions as fixes: the best kind so far is read; 0: no position
  int gnss_rank;
  int truth_rank;      ///< rank of its positions as truth
  std::size_t fields;  ///< the body has at least so many
  std::size_t status;
  std::size_t type = kNoField;
  std::size_t latitude = 2;  ///< then longitude, height
  std::size_t undulation = kNoField;
  std::size_t datum = kNoField;
  std::size_t sigma = kNoField;     ///< of latitude, then of longitude
  std::size_t velocity = kNoField;  ///< north, then east
  std::size_t velocity_sigma = kNoField;
  std::size_t azimuth = kNoField;
};

[[nodiscard]] constexpr NovatelLayout novatel_best(std::string_view name, int gnss_rank, int truth_rank) {
  return {.name = name,
          .gnss_rank = gnss_rank,
          .truth_rank = truth_rank,
          .fields = 10,
          .status = 0,
          .type = 1,
          .undulation = 5,
          .datum = 6,
          .sigma = 7};
}
[[nodiscard]] constexpr NovatelLayout novatel_inertial(std::string_view name, int gnss_rank, int truth_rank) {
  return {.name = name,
          .gnss_rank = gnss_rank,
          .truth_rank = truth_rank,
          .fields = 12,
          .status = 11,
          .velocity = 5,
          .azimuth = 10};
}
inline constexpr std::array<NovatelLayout, 7> kNovatelLayouts{{
    novatel_best("BESTGNSSPOSA", 5, 1),
    novatel_best("BESTGPSPOSA", 5, 1),
    novatel_best("BESTPOSA", 4, 2),
    {.name = "INSPVAXA",
     .gnss_rank = 3,
     .truth_rank = 5,
     .fields = 20,
     .status = 0,
     .type = 1,
     .undulation = 5,
     .sigma = 12,
     .velocity = 6,
     .velocity_sigma = 15,
     .azimuth = 11},
    novatel_inertial("INSPVAA", 2, 4),
    novatel_inertial("INSPVASA", 1, 3),
    {.name = "BESTVELA", .gnss_rank = 0, .truth_rank = 0, .fields = 7, .status = 0, .type = 1},
}};

/// Returns null for a message that is not read.
[[nodiscard]] inline const NovatelLayout* novatel_layout(std::string_view name) {
  for (const NovatelLayout& layout : kNovatelLayouts) {
    if (layout.name == name) return &layout;
  }
  return nullptr;
}

/// Returns the quality of a position type (OEM7 Commands and Logs, "Position or Velocity Type").
[[nodiscard]] inline FixQuality novatel_quality(std::string_view type) {
  const auto has = [type](std::string_view part) { return type.find(part) != std::string_view::npos; };
  if (type.ends_with("_INT") || has("RTKFIXED")) return FixQuality::fixed;
  if (type.ends_with("_FLOAT") || has("RTKFLOAT") || has("PPP")) return FixQuality::floating;
  if (has("PSRDIFF") || has("WAAS") || has("SBAS") || has("CDGPS") || has("OMNISTAR"))
    return FixQuality::differential;
  if (type == "SINGLE" || has("PSRSP")) return FixQuality::single;
  if (type == "PROPAGATED" || type == "INS") return FixQuality::dead_reckoned;
  return type == "FIXEDPOS" ? FixQuality::manual : FixQuality::unknown;
}

/// Tells whether a solution status, GNSS or inertial, means that there is a position.
[[nodiscard]] inline bool novatel_has_solution(std::string_view status) {
  for (const std::string_view yes : {"SOL_COMPUTED", "INS_SOLUTION_GOOD", "INS_SOLUTION_FREE",
                                     "INS_ALIGNMENT_COMPLETE", "INS_HIGH_VARIANCE"}) {
    if (status == yes) return true;
  }
  return false;
}

}  // namespace waymark::formats
