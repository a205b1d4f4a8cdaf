// A vertex type: how far a receiver's clock is ahead, as a length. A vertex type is a struct of static
// functions. It stands in a header because any number of plugins may have edges on it: a type is known by its
// tag, so that two plugins that include this header mean one and the same vertex. Written out here; a state of
// one plain number may also derive from ScalarState (core/graph/scalar_state.hpp) and give tag and names alone.
#pragma once

#include <array>
#include <string_view>

#include <waymark/core/graph/vertex.hpp>

/// Clock error times the speed of light, m: what it adds to every pseudorange.
struct VertexClockBias {
  static constexpr std::string_view kTag = "VERTEX_CLOCK_BIAS";  // its word in .graph files
  static constexpr int kValueSize = 1;                           // numbers in a file
  static constexpr int kTangentSize = 1;                         // degrees of freedom
  static constexpr bool kLinearChart = true;                     // a step is added, nothing is wrapped
  static constexpr std::array<std::string_view, 1> value_names() { return {"clock_bias"}; }
  static constexpr std::array<std::string_view, 1> value_units() { return {"m"}; }  // reported with its sigma

  /// What the error of an edge sees: the value after a step delta. T is double or a dual number.
  template <typename T>
  static T at(const double* value, const T* delta) {
    return delta[0] + T(value[0]);
  }
  /// Takes a step, and its inverse: the step between two values.
  static void retract(double* value, const double* delta) { value[0] += delta[0]; }
  static void local(const double* from, const double* to, double* delta) { delta[0] = to[0] - from[0]; }
};
