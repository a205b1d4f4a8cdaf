// error: error is a const template <typename T> that takes the values of the vertices
#include "refused/base.hpp"

struct EdgeWrong {
  static constexpr std::string_view kTag = "EDGE_WRONG";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeWrong::measured>("measured")}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) {
    return Eigen::Matrix<T, 1, 1>(pose.position[0] - T(measured));
  }
  double measured = 0;
};
template void use<EdgeWrong>();
