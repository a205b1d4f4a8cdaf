// error: a field is a double or a fixed-size Eigen vector: write double for an int
#include "refused/base.hpp"

struct EdgeWrong {
  static constexpr std::string_view kTag = "EDGE_WRONG";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeWrong::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    return Eigen::Matrix<T, 1, 1>(pose.position[0]);
  }
  Eigen::VectorXd measured;
};
template void use<EdgeWrong>();
