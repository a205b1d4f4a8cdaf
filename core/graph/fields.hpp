/// The field list of a type is its schema. Parsing, writing, `waymark info`, checks and fuzzing are
/// all based on it.
///
/// All data here are constant.
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// A named group of numbers in an edge record, as `waymark info` and the TYPE line of a .graph
/// file show it.
struct FieldInfo {
  std::string name;
  int size = 1;  ///< number of doubles

  friend bool operator==(const FieldInfo&, const FieldInfo&) = default;
};

/// A field of the edge struct E, with functions that read and set its numbers.
template <typename E>
struct Field {
  std::string_view name;
  int size;
  const double* (*read)(const E& edge);
  double* (*data)(E& edge);
};

namespace detail {

template <typename M>
struct MemberPointer;
template <typename E, typename V>
struct MemberPointer<V E::*> {
  using Class = E;
  using Value = V;
};

/// A vector or matrix of Eigen whose doubles lie in a row.
template <typename V>
concept FixedVector = requires(V& vector) {
  requires(V::SizeAtCompileTime > 0);
  { vector.data() } -> std::same_as<double*>;
};

}  // namespace detail

/// Makes a Field from a member that is a double or a fixed-size Eigen vector:
/// field<&EdgeSe2::measured>("measured"). For a member that E inherits, it is field<&Base::change,
/// E>("change").
template <auto Member, typename E = typename detail::MemberPointer<decltype(Member)>::Class>
[[nodiscard]] constexpr Field<E> field(std::string_view name) {
  using V = typename detail::MemberPointer<decltype(Member)>::Value;
  constexpr bool kIsNumber = std::is_same_v<V, double>;
  static_assert(kIsNumber || detail::FixedVector<V>,
                "a field is a double or a fixed-size Eigen vector: write double for an int, Eigen::Vector3d "
                "for a std::array<double, 3> or a pose");
  if constexpr (kIsNumber) {
    return {name, 1, [](const E& edge) -> const double* { return &(edge.*Member); },
            [](E& edge) -> double* { return &(edge.*Member); }};
  } else if constexpr (detail::FixedVector<V>) {
    return {name, V::SizeAtCompileTime, [](const E& edge) -> const double* { return (edge.*Member).data(); },
            [](E& edge) -> double* { return (edge.*Member).data(); }};
  } else {
    return {};
  }
}

}  // namespace waymark
