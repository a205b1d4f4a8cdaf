// error: error is generic in its scalar: template <typename T>
#include "refused/base.hpp"

struct EdgeWrong {
  static constexpr std::string_view kTag = "EDGE_WRONG";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeWrong::measured>("measured")}; }
  Eigen::Matrix<double, 1, 1> error(const Pose2<double>& pose) const {
    return Eigen::Matrix<double, 1, 1>(pose.position[0] - measured);
  }
  double measured = 0;
};
template void use<EdgeWrong>();
