// error: error returns a vector of length kErrorDimension, also for one number
#include "refused/base.hpp"

struct EdgeWrong {
  static constexpr std::string_view kTag = "EDGE_WRONG";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() { return std::array{field<&EdgeWrong::measured>("measured")}; }
  template <typename T>
  T error(const Pose2<T>& pose) const {
    return pose.position[0] - T(measured);
  }
  double measured = 0;
};
template void use<EdgeWrong>();
