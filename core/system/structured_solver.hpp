/// A linear solver together with the structure that it works on, kept between optimisations.
#pragma once

#include <cstdint>
#include <span>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/system/structure.hpp>

namespace WAYMARK_EXPORT waymark {

/// Sees to it that the solver has analysed the pattern that the structure has now, and never
/// analyses one twice. The solver must outlive this object, and nobody else may call its analyze().
/// One thread at a time.
class StructuredSolver {
 public:
  explicit StructuredSolver(LinearSolver& solver) : solver_(solver) {}

  /// As the functions of Structure.
  void build(const Graph& graph, std::span<const char> held) { structure_.build(graph, held); }
  void extend(const Graph& graph, std::span<const char> held) { structure_.extend(graph, held); }
  void remove(const Graph& graph, const Removal& removal, std::span<const char> held) {
    structure_.remove(graph, removal, held);
  }

  [[nodiscard]] const Structure& structure() const { return structure_; }
  /// The solver, ready to factorise the structure's present pattern.
  [[nodiscard]] LinearSolver& analysed();

 private:
  LinearSolver& solver_;
  Structure structure_;
  std::uint64_t analysed_version_ = 0;  // a pattern that was made has version 1 or more
};

}  // namespace waymark
