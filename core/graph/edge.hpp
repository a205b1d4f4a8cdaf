/// Edges: what was measured. The author of an edge type writes one function and a field list.
/// @code
///   struct EdgeRange {
///     static constexpr std::string_view kTag = "EDGE_RANGE";
///     static constexpr std::string_view kForm = "range";  // how the error is formed, printed beside chi2
///     static constexpr int kErrorDimension = 1;
///     using Vertices = VertexList<VertexSe2, VertexXy>;
///     static constexpr auto fields() { return std::array{field<&EdgeRange::measured>("measured")}; }
///     template <typename T>
///     Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& landmark) const;
///     double measured = 0;
///   };
/// @endcode
/// Derivatives are taken by dual numbers unless the type also gives
/// @code
///   void linearize(const Pose2<double>&, const Vector2<double>&, Error& e, Jacobian<3>& J0, Jacobian<2>& J1)
///   const;
/// @endcode
/// with J_k the derivative of the error by the tangent vector of vertex k. The conformance tests compare the
/// two. Two more things may be told:
/// - `static constexpr bool kRelative = true;`
///       the error stays when all vertices undergo one rigid motion of the plane (tested): the gauge test
///       need not look, and between two vertices that carry (vertex.hpp) J_1 alone gives H and g
/// - `void prepare();` called once when the fields are set: keeps what depends on the measurement alone
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/fields.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace waymark {

/// The vertex types an edge joins, in the order in which its error takes them; dimensions may be mixed.
template <Vertex... V>
struct VertexList {
  static constexpr int kSize = sizeof...(V);
  using Types = std::tuple<V...>;
  template <int K>
  using Type = std::tuple_element_t<K, Types>;
  static constexpr int kTangentSize = (V::kTangentSize + ...);
};

template <typename E>
concept Edge = requires {
  { E::kTag } -> std::convertible_to<std::string_view>;
  { E::kErrorDimension } -> std::convertible_to<int>;
  typename E::Vertices;
  E::fields();
};

class EdgeBatchBase;

/// An edge type at run time. `arity` is the number of vertices, kRuntimeArity where each edge has its own.
struct EdgeType {
  static constexpr int kRuntimeArity = -1;

  std::string tag;
  std::string form;  ///< how the error is formed: "(t, theta)", "log", "position", ...
  int arity = 0;
  std::vector<std::string> vertex_tags;  ///< arity entries; empty for run-time arity
  int error_dimension = 0;               ///< 0 for run-time arity: the sum of the vertices' tangent sizes
  std::vector<FieldInfo> fields;         ///< without the information matrix, which every edge has
  bool relative = false;                 ///< the error does not change under a common rigid motion
  std::function<std::unique_ptr<EdgeBatchBase>()> make_batch;

  /// Numbers in the field list together.
  [[nodiscard]] int field_size() const;
};

}  // namespace waymark
