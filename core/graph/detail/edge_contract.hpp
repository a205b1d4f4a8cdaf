/// What the compiler asks of an edge type, in sentences. They stand before the first use of the
/// type, and a type that breaks one is not used any further: one sentence, and no page of templates.
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/edge.hpp>

namespace WAYMARK_EXPORT waymark {

/// The call error<T>(values of the vertices), and what it returns.
template <typename E, typename Vertices>
struct EdgeErrorCall;
template <typename E, typename... V>
struct EdgeErrorCall<E, VertexList<V...>> {
  static constexpr bool kIsTemplate = requires(const E& edge, const VertexValue<V>&... values) {
    edge.template error<double>(values...);
  };
  static constexpr bool kIsPlain = requires(const E& edge, const VertexValue<V>&... values) {
    edge.error(values...);
  };

  static auto result() {
    if constexpr (kIsTemplate) {
      return std::type_identity<std::remove_cvref_t<decltype(std::declval<const E&>().template error<double>(
          std::declval<const VertexValue<V>&>()...))>>();
    } else {
      return std::type_identity<void>();
    }
  }
  using Result = typename decltype(result())::type;
};

/// The length of a vector of Eigen; 0 for another type, Eigen::Dynamic if it is known at run time only.
template <typename V>
[[nodiscard]] consteval int length_of_vector() {
  if constexpr (requires { V::SizeAtCompileTime; }) {
    return V::SizeAtCompileTime;
  } else {
    return 0;
  }
}

/// The rules that an edge type keeps. Each holds if an earlier one is broken, so that one is told.
template <Edge E>
struct EdgeRules {
  using Call = EdgeErrorCall<E, typename E::Vertices>;
  static constexpr int kLength = length_of_vector<typename Call::Result>();
  static constexpr bool kIsGeneric = Call::kIsTemplate || !Call::kIsPlain;
  static constexpr bool kTakesVertices = Call::kIsTemplate || Call::kIsPlain;
  static constexpr bool kIsVector = !Call::kIsTemplate || kLength != 0;
  static constexpr bool kHasLength =
      !Call::kIsTemplate || !kIsVector || kLength == E::kErrorDimension || kLength == Eigen::Dynamic;
  static constexpr bool kKept = kIsGeneric && kTakesVertices && kIsVector && kHasLength;
};

/// Stops the compiler with a sentence at the first rule that an edge type breaks.
template <Edge E>
struct EdgeContract {
  static_assert(EdgeRules<E>::kIsGeneric,
                "error is generic in its scalar: template <typename T> Eigen::Matrix<T, kErrorDimension, 1> "
                "error(const Pose2<T>& pose) const");
  static_assert(
      EdgeRules<E>::kTakesVertices,
      "error is a const template <typename T> that takes the values of the vertices in the order of "
      "Vertices: Pose2<T> for VertexSe2, Vector2<T> for VertexXy, what V::at<T> returns for another V");
  static_assert(EdgeRules<E>::kIsVector,
                "error returns a vector of length kErrorDimension, also for one number: "
                "Eigen::Matrix<T, 1, 1>(number)");
  static_assert(EdgeRules<E>::kHasLength,
                "error returns a vector of another length than kErrorDimension says");
};

}  // namespace waymark
