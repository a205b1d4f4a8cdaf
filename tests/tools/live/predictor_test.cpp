// The newest pose between two solutions: what the edges of the motion and of its sensors tell of it, and no more.
#include <array>

#include <catch2/catch.hpp>

#include <waymark/tools/live/estimator/window/predictor.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

namespace predictor_test {

using namespace waymark;
using namespace waymark::live;

namespace {

constexpr double kPose_m2 = 4;
constexpr double kHeading_rad2 = 1e-4;
constexpr double kStep_m2 = 1e-4;
constexpr double kSight_m2 = 0.01;

/// A pose at the origin, a landmark 5 m ahead and 2 m to the left; then a step of 1 m ahead, from where the landmark is
/// seen again.
struct Scene {
  Graph graph;
  VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1}, {5, 2});
  VertexIndex next = -1;

  void step_and_see() {
    next = graph.add_vertex<VertexSe2>(VertexId{2}, {1, 0, 0});
    const Eigen::Vector3d motion(1 / kStep_m2, 1 / kStep_m2, 1e8);
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {pose, next}, motion.asDiagonal());
    graph.add_edge(EdgeSe2Xy{{4, 2}}, {next, landmark}, Eigen::Matrix2d::Identity() / kSight_m2);
  }
};

Eigen::Matrix3d pose_covariance() {
  return Eigen::Vector3d(kPose_m2, kPose_m2, kHeading_rad2).asDiagonal();
}

/// Of the pose after the step: the heading moves it to the side.
Eigen::Matrix3d after_step() {
  Eigen::Matrix3d moved = Eigen::Matrix3d::Identity();
  moved(1, 2) = 1;
  return moved * pose_covariance() * moved.transpose() +
         Eigen::Matrix3d(Eigen::Vector3d(kStep_m2, kStep_m2, 1e-8).asDiagonal());
}

}  // namespace

TEST_CASE("predictor: a sight of a landmark whose covariance is not known says nothing of the pose") {
  Scene scene;
  Predictor predictor;
  predictor.begin(scene.graph, {{scene.pose}, pose_covariance()}, scene.pose);
  predictor.mark(scene.graph);
  scene.step_and_see();
  predictor.follow(scene.graph, scene.next);
  CHECK(predictor.covariance().isApprox(after_step(), 1e-6));
}

TEST_CASE("predictor: a sight of a landmark that is known as well as the pose enters with its covariance") {
  constexpr double kLandmark_m2 = 0.25;
  Scene scene;
  Predictor predictor;
  WindowTail tail{{scene.pose, scene.landmark}, Eigen::MatrixXd::Zero(5, 5)};
  tail.covariance.topLeftCorner<3, 3>() = pose_covariance();
  tail.covariance.bottomRightCorner<2, 2>() = kLandmark_m2 * Eigen::Matrix2d::Identity();
  predictor.begin(scene.graph, tail, scene.pose);
  predictor.mark(scene.graph);
  scene.step_and_see();
  predictor.follow(scene.graph, scene.next);
  // Kalman's update of the pose by R^T (l - p), with the landmark as part of the noise
  Eigen::Matrix<double, 2, 3> h;
  h << -1, 0, 2, 0, -1, -4;
  const Eigen::Matrix3d prior = after_step();
  const Eigen::Matrix2d noise = (kSight_m2 + kLandmark_m2) * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 3, 2> gain =
      prior * h.transpose() * (h * prior * h.transpose() + noise).inverse();
  const Eigen::Matrix3d expected = prior - gain * h * prior;
  CHECK(predictor.covariance().isApprox(expected, 1e-6));
}

}  // namespace predictor_test
