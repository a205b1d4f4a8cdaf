/// The field list of a type is its schema. Parsing, writing, `waymark info`, checks and fuzzing are
/// all based on it.
///
/// All data here are constant.
#pragma once

#include <string>
#include <string_view>
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

}  // namespace detail

/// Makes a Field from a member that is a double or a fixed-size Eigen vector:
/// field<&EdgeSe2::measured>("measured"). For a member that E inherits, it is field<&Base::change,
/// E>("change").
template <auto Member, typename E = typename detail::MemberPointer<decltype(Member)>::Class>
[[nodiscard]] constexpr auto field(std::string_view name) {
  using V = typename detail::MemberPointer<decltype(Member)>::Value;
  if constexpr (std::is_same_v<V, double>) {
    return Field<E>{name, 1, [](const E& edge) -> const double* { return &(edge.*Member); },
                    [](E& edge) -> double* { return &(edge.*Member); }};
  } else {
    static_assert(V::SizeAtCompileTime > 0, "a field is a double or a fixed-size Eigen vector");
    return Field<E>{name, V::SizeAtCompileTime,
                    [](const E& edge) -> const double* { return (edge.*Member).data(); },
                    [](E& edge) -> double* { return (edge.*Member).data(); }};
  }
}

}  // namespace waymark
