#include <waymark/tools/evaluation/numbers/relative_pose_error.hpp>

#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::evaluation {
namespace {

Pose2<double> as_pose2(const Eigen::Vector3d& pose) {
  return {pose[0], pose[1], pose[2]};
}

}  // namespace

RelativePoseError relative_pose_error(std::span<const Eigen::Vector3d> truth,
                                      std::span<const Eigen::Vector3d> estimated, double distance_m) {
  if (truth.size() != estimated.size())
    throw UsageError("relative pose error: truth and estimate have different lengths");
  std::vector<double> translations;
  std::vector<double> rotations;
  std::size_t begin = truth.size();  // of the motion; none yet
  double path_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) path_m += (truth[i] - truth[i - 1]).head<2>().norm();
    if (path_m < distance_m) continue;
    path_m = 0;
    if (begin < truth.size()) {
      const Pose2<double> wanted = between(as_pose2(truth[begin]), as_pose2(truth[i]));
      const Pose2<double> found = between(as_pose2(estimated[begin]), as_pose2(estimated[i]));
      const Vector3<double> error = between(wanted, found).vector();
      translations.push_back(error.head<2>().norm());
      rotations.push_back(std::abs(wrap_angle(error[2])));
    }
    begin = i;
  }
  return {distance_m, scalar_statistics(translations), scalar_statistics(rotations)};
}

}  // namespace waymark::evaluation
