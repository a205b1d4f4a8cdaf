/// Edges: the measurements. The author of an edge type writes one function and a field list.
/// @code
///   struct EdgeRange {
///     static constexpr std::string_view kTag = "EDGE_RANGE";
///     static constexpr std::string_view kForm = "range";  // optional: form of the error, for reports
///     static constexpr int kErrorDimension = 1;
///     using Vertices = VertexList<VertexSe2, VertexXy>;
///     static constexpr auto fields() {
///       return std::array{field<&EdgeRange::measured>("measured")};
///     }
///     template <typename T>
///     Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const Vector2<T>& landmark) const;
///     double measured = 0;
///   };
/// @endcode
/// Dual numbers give the derivatives, unless the type also has
/// @code
///   void linearize(const Pose2<double>&, const Vector2<double>&, Error& e, Jacobian<3>& J0,
///                  Jacobian<2>& J1) const;
/// @endcode
/// where J_k is the derivative of the error by the tangent vector of vertex k. The conformance
/// tests compare both. A type may have three more members:
/// - `static constexpr bool kRelative = true;` promises that the error does not change if all
///   vertices undergo one rigid motion of the plane (tested). The gauge test then skips such edges.
///   If both vertex types have carry() (vertex.hpp), J_0 is derived from J_1.
/// - `void prepare();` is called once after the fields are set. It stores what depends only on the
///   measurement.
/// - `Sight sight() const;` says where the second vertex, a point, is seen from the first one, a pose
///   (core/base/sight.hpp). Initial guesses place points by it; the error must be zero there (tested).
///
/// An edge is a plain value that a graph copies. error(), linearize(), prepare() and sight() must not keep
/// state elsewhere, because several threads call them at the same time.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/fields.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace WAYMARK_EXPORT waymark {

/// The vertex types that an edge joins, in the order of the arguments of its error. Their
/// dimensions may differ.
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

/// How many numbers a vertex type has.
struct VertexSizes {
  int value = 0;
  int tangent = 0;

  friend bool operator==(const VertexSizes&, const VertexSizes&) = default;
};

/// An edge type at run time. `arity` is the number of vertices, or kRuntimeArity if each edge has
/// its own number.
struct EdgeType {
  static constexpr int kRuntimeArity = -1;

  std::string tag;
  std::string form;  ///< form of the error: "(t, theta)", "log", "position", ...
  int arity = 0;
  std::vector<std::string> vertex_tags;  ///< arity entries; empty for run-time arity
  /// of the same vertices, as the edge was compiled with them; empty: it takes any
  std::vector<VertexSizes> vertex_sizes;
  /// 0 for run-time arity: the sum of the tangent sizes of the vertices
  int error_dimension = 0;
  std::vector<FieldInfo> fields;  ///< without the information matrix, which every edge has
  bool relative = false;          ///< a common rigid motion does not change the error
  std::function<std::unique_ptr<EdgeBatchBase>()> make_batch;

  /// Returns how many numbers the field list has.
  [[nodiscard]] int field_size() const;
};

/// @throws UsageError if an edge was compiled with another vertex type of the tag of its k-th vertex
void check_sizes(const EdgeType& edge, std::size_t k, const VertexType& vertex);

}  // namespace waymark
