#include <waymark/tools/evaluation/numbers/constant_offset.hpp>

#include <vector>

#include <waymark/types_se2/se2.hpp>

namespace waymark::evaluation {

OffsetTakenOut without_constant_offset(std::span<const Eigen::Vector2d> offsets,
                                       std::span<const std::optional<double>> directions_rad) {
  const TrackMetrics track = track_metrics(offsets, directions_rad);
  OffsetTakenOut result{.along_m = track.along.mean, .cross_m = track.cross.mean, .rest = {}};
  const Eigen::Vector2d constant(result.along_m, result.cross_m);
  std::vector<Eigen::Vector2d> rest;
  for (std::size_t i = 0; i < offsets.size(); ++i)
    if (directions_rad[i]) rest.emplace_back(offsets[i] - rotate(*directions_rad[i], constant));
  result.rest = position_metrics(rest);
  return result;
}

}  // namespace waymark::evaluation
