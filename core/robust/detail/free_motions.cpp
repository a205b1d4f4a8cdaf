#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/robust/detail/free_motions.hpp>

namespace waymark::detail {
namespace {

constexpr double kRounding = 1e-6;

}  // namespace

FreeMotions FreeMotions::all(int count) {
  FreeMotions result;
  result.unanchored_ = count;
  return result;
}

FreeMotions FreeMotions::some(const Eigen::MatrixXd& motions, const RigidMotionView::Place& place,
                              const RigidMotionView::Place& frame) {
  Eigen::MatrixXd in_frame(3, motions.cols());
  const Eigen::Vector2d way = frame.centre - place.centre;
  for (Eigen::Index c = 0; c < motions.cols(); ++c) {
    const double turn = motions(2, c) / place.extent;
    in_frame.col(c) << motions(0, c) - turn * way.y(), motions(1, c) + turn * way.x(), turn * frame.extent;
  }
  FreeMotions result;
  result.some_ = singular_values(in_frame).left;
  return result;
}

bool FreeMotions::make_all_with(const FreeMotions& other) const {
  const Eigen::MatrixXd both = some_ * some_.transpose() + other.some_ * other.some_.transpose();
  return symmetric_eigenvalues(both)[0] > kRounding;
}

FreeMotions FreeMotions::shared_with(const FreeMotions& other) const {
  // Each counts as 1 in its own part, and one that both have as 2.
  const auto [counts, directions] =
      symmetric_eigen(some_ * some_.transpose() + other.some_ * other.some_.transpose());
  FreeMotions result;
  result.some_ = directions.rightCols((counts.array() > 2 - kRounding).count());
  return result;
}

}  // namespace waymark::detail
