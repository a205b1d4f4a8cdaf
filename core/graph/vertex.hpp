/// Vertices: the unknowns. A vertex type is a struct of static functions (concept Vertex). At run
/// time it is represented by its VertexType, which is found by tag and never by address.
///
/// Types have no state. Any number of threads may call their functions, on any memory of
/// the right size.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/base/guard.hpp>

namespace WAYMARK_EXPORT waymark {

/// The name of a vertex in a file: any int64, written VertexId{7}. Ids and indices do not convert
/// into each other.
enum class VertexId : std::int64_t {};
/// The place of a vertex in its graph: 0, 1, 2, ... in insertion order.
using VertexIndex = std::int32_t;

/// Returns the number of an id, for messages and files.
[[nodiscard]] constexpr std::int64_t to_number(VertexId id) {
  return static_cast<std::int64_t>(id);
}
[[nodiscard]] inline std::string to_string(VertexId id) {
  return std::to_string(to_number(id));
}

/// The members of a vertex type V:
/// @code
///   V::kTag            std::string_view, its word in .graph files
///   V::kValueSize      doubles that hold a value;  V::kTangentSize  degrees of freedom
///   V::value_names()   names of the numbers of a value, container of strings
///   V::Value<T>        the value in the form that errors of edges take, generic in the scalar
///   V::at<T>(const double* value, const T* delta) -> Value<T>: the value retracted by delta
///   V::retract(double* value, const double* delta)
///                      value := value [+] delta, normalised: by a delta of 0, numbers such as
///                      those of a quaternion of any length but 0 become a value
///   V::local(const double* from, const double* to, double* delta)
///                      delta with from [+] delta == to
/// @endcode
/// Invariants (tested for every registered type): retract by 0 is the identity on normalised
/// values; local(v, v) = 0; local(v, retract(v, d)) = d for small d.
///
/// Optional members:
/// - `V::value_units()`: the unit of each number, for types whose numbers are no coordinates. A
///   state with units and without a place in the plane is reported with its sigma after a run.
/// - `V::kDense = true`: the state touches very many edges (calibration). Its columns are
///   ordered last.
/// - `V::kLinearChart = true`: promises local(r, x [+] d) = local(r, x) + d, so the retraction is a
///   plain addition. Gaussian priors then use the identity as Jacobian of local(), and Ceres uses a
///   plain parameter block.
/// - `V::kHeight = true`: the one number is the height of a point of the vehicle above the ellipsoid,
///   m. With stamps and a truth that has heights, a run tells its error.
/// - `V::position(const double*) -> Vector2d`: the place of the vertex in the plane.
/// - `V::rigid_motion(const double* value, const Vector2d& centre, double extent, double*
///   columns)`: the change of the value under a rigid motion of the plane. The columns are
///   kTangentSize x 3, column-major: along x, along y, and a turn about centre by 1/extent rad.
///   Types without position and rigid_motion do not take part in the gauge test.
/// - `V::carry<R>(const double* from, const double* to, Matrix<double, R, kTangentSize>& m)`: m :=
///   m T, where T maps the change of `from` to the change of `to` if both move rigidly together.
///   Relative edges (kRelative) between two such vertices are linearised in half the time.
template <typename V>
concept Vertex = requires(double* value, const double* constant) {
  { V::kTag } -> std::convertible_to<std::string_view>;
  { V::kValueSize } -> std::convertible_to<int>;
  { V::kTangentSize } -> std::convertible_to<int>;
  V::value_names();
  V::template at<double>(constant, constant);
  V::retract(value, constant);
  V::local(constant, constant, value);
};

/// The value of a vertex of type V in the form that errors and users get: Pose2<double>,
/// Eigen::Vector2d, double.
template <Vertex V>
using VertexValue = decltype(V::template at<double>(nullptr, nullptr));

/// Returns the value for V::kValueSize numbers.
template <Vertex V>
[[nodiscard]] VertexValue<V> value_from_numbers(const double* numbers) {
  constexpr std::array<double, V::kTangentSize> kZero{};
  return V::template at<double>(numbers, kZero.data());
}

/// Returns the numbers of a value, normalised like the result of the retraction: a heading is in
/// (-pi, pi]. A value is a number, an Eigen vector, or a type with a function vector() that
/// returns one.
template <Vertex V>
[[nodiscard]] std::array<double, V::kValueSize> numbers_of_value(const VertexValue<V>& value) {
  std::array<double, V::kValueSize> numbers;
  Eigen::Map<Eigen::Matrix<double, V::kValueSize, 1>> vector(numbers.data());
  if constexpr (std::convertible_to<VertexValue<V>, double>) {
    vector[0] = value;
  } else if constexpr (requires { value.vector(); }) {
    vector = value.vector();
  } else {
    vector = value;
  }
  constexpr std::array<double, V::kTangentSize> kZero{};
  V::retract(numbers.data(), kZero.data());
  return numbers;
}

/// A vertex type at run time.
struct VertexType {
  std::string tag;
  int value_size = 0;
  int tangent_size = 0;
  std::vector<std::string> value_names;
  std::vector<std::string> value_units;  ///< empty: the type does not state them
  bool dense = false;
  bool height = false;        ///< the value is a height of the vehicle
  bool linear_chart = false;  ///< local(r, x [+] d) = local(r, x) + d: true for additive types

  void (*retract)(double* value, const double* delta) = nullptr;
  void (*local)(const double* from, const double* to, double* delta) = nullptr;
  /// null: it has no place in the plane
  Eigen::Vector2d (*position)(const double* value) = nullptr;
  void (*rigid_motion)(const double* value, const Eigen::Vector2d& centre, double extent,
                       double* columns) = nullptr;
};

namespace detail {

/// The functions of a type, guarded for plugins.
template <Vertex V>
void retract_guarded(double* value, const double* delta) {
  guarded([] { return std::string(std::string_view(V::kTag)) + ": retract"; }, V::kTag,
          [&] { V::retract(value, delta); });
}
template <Vertex V>
void local_guarded(const double* from, const double* to, double* delta) {
  guarded([] { return std::string(std::string_view(V::kTag)) + ": local"; }, V::kTag,
          [&] { V::local(from, to, delta); });
}
template <Vertex V>
Eigen::Vector2d position_guarded(const double* value) {
  return guarded([] { return std::string(std::string_view(V::kTag)) + ": position"; }, V::kTag,
                 [&]() -> Eigen::Vector2d { return V::position(value); });
}
template <Vertex V>
void rigid_motion_guarded(const double* value, const Eigen::Vector2d& centre, double extent,
                          double* columns) {
  guarded([] { return std::string(std::string_view(V::kTag)) + ": rigid_motion"; }, V::kTag,
          [&] { V::rigid_motion(value, centre, extent, columns); });
}

}  // namespace detail

template <Vertex V>
[[nodiscard]] VertexType make_vertex_type() {
  VertexType type;
  type.tag = std::string(std::string_view(V::kTag));
  type.value_size = V::kValueSize;
  type.tangent_size = V::kTangentSize;
  for (const auto& name : V::value_names()) type.value_names.emplace_back(name);
  if constexpr (requires { V::value_units(); }) {
    for (const auto& unit : V::value_units()) type.value_units.emplace_back(unit);
  }
  if constexpr (requires { V::kDense; }) type.dense = V::kDense;
  if constexpr (requires { V::kHeight; }) type.height = V::kHeight;
  if constexpr (requires { V::kLinearChart; }) type.linear_chart = V::kLinearChart;
  type.retract = &detail::retract_guarded<V>;
  type.local = &detail::local_guarded<V>;
  if constexpr (requires { V::rigid_motion; }) {
    type.position = &detail::position_guarded<V>;
    type.rigid_motion = &detail::rigid_motion_guarded<V>;
  }
  return type;
}

}  // namespace waymark
