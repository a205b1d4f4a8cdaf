// error: an edge type has kTag, kErrorDimension, Vertices and fields()
#include "refused/base.hpp"

struct EdgeWrong {
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeWrong::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    return Eigen::Matrix<T, 1, 1>(pose.position[0]);
  }
  double measured = 0;
};
template void use<EdgeWrong>();
