/// A linear solver and the structure that it works on, kept between optimisations.
#pragma once

#include <cstdint>
#include <span>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/system/structure.hpp>

namespace WAYMARK_EXPORT waymark {

/// Ensures that the solver has analysed the present pattern of the structure, and never analyses a
/// pattern twice. The solver must outlive this object, and no other code may call its analyze().
/// One thread at a time may use it.
class StructuredSolver {
 public:
  explicit StructuredSolver(LinearSolver& solver) : solver_(solver) {}

  /// These do what the functions of Structure do.
  void build(const Graph& graph, std::span<const char> held, bool growing = false) {
    structure_.build(graph, held, growing);
  }
  void extend(const Graph& graph, std::span<const char> held) { structure_.extend(graph, held); }
  void remove(const Graph& graph, const Removal& removal, std::span<const char> held) {
    structure_.remove(graph, removal, held);
  }

  [[nodiscard]] const Structure& structure() const { return structure_; }
  /// Returns the solver, ready to factorise the present pattern.
  [[nodiscard]] LinearSolver& analysed();

 private:
  LinearSolver& solver_;
  Structure structure_;
  std::uint64_t analysed_version_ = 0;  // a pattern that was made has version 1 or more
};

}  // namespace waymark
