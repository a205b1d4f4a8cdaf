/// Whether sources of one kind agree. A source that contradicts two others that agree is named, and
/// left out for the time in which it does.
///
/// Time is cut into windows. In each window a source says one thing: where the vehicle was (absolute
/// sources), or how far it drove and turned (relative ones). How accurate a source is follows from how
/// far the sources are apart over the whole drive: var(a - b) = var(a) + var(b) for each two of them.
/// In each window the sources that agree are found by graduated non-convexity with a truncated quadratic
/// loss (Yang, Antonante, Tzoumas, Carlone, "Graduated Non-Convexity for Robust Spatial Perception",
/// RA-L 2020). With fewer than three sources nobody can tell which of them is wrong.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// What the sources say in one window; empty for a source that says nothing.
using Statements = std::vector<std::optional<Eigen::Vector2d>>;

/// Returns how accurate each source is: the standard deviation of each component, from the medians of
/// the differences between each two sources. Empty for a source that shares too few windows with two
/// others.
/// @param windows the statements in each, of the same number of sources
[[nodiscard]] std::vector<std::optional<Eigen::Vector2d>> accuracies_by_agreement(
    std::span<const Statements> windows);

/// Returns the sources that contradict the others in a window. At least two others must agree.
[[nodiscard]] std::vector<std::size_t> contradicting(
    const Statements& window, std::span<const std::optional<Eigen::Vector2d>> accuracies);

/// A time in which a source contradicts the others.
struct Disagreement {
  std::size_t source = 0;
  Stamp from;
  Stamp to;
  double away_m = 0;         ///< median distance from the mean of the others
  std::size_t readings = 0;  ///< that are left out
};

/// Rejects accepted fixes of absolute sources that contradict the others (reason "contradicts").
/// @param poses common to all sources, one for each fix: x, y [m, frame], heading [rad]. Their error
/// cancels.
/// @param voices of each Fix::source: sources with common errors have one voice
/// @returns Disagreement::source is a voice
std::vector<Disagreement> reject_contradictions(std::span<Fix> fixes, std::span<const Eigen::Vector3d> poses,
                                                std::span<const std::size_t> voices);

/// Leaves out samples of relative sources that contradict the others.
/// @param sources samples of each, sorted by stamp; a source may have none
std::vector<Disagreement> leave_out_contradictions(std::span<std::vector<OdometrySample>* const> sources);

/// Returns the warning. @param name of the source @param start of the drive
[[nodiscard]] std::string warning_of(const Disagreement& disagreement, const std::string& name, Stamp start);

}  // namespace waymark::drive
