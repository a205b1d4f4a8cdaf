/// The interface of linear backends: factorise a sparse symmetric positive definite matrix, solve with the
/// factor.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <waymark/core/linear/block_pattern.hpp>

namespace waymark {

class ThreadPool;

/// Outcome of a factorisation; failing is ordinary flow (a damped method then damps more).
enum class FactorStatus {
  ok,
  not_positive_definite,  ///< a pivot was zero, negative or not finite
  out_of_memory
};

/// A backend. The matrix comes in elimination order; a backend keeps that order.
class LinearSolver {
 public:
  virtual ~LinearSolver();
  /// Symbolic analysis; called again only when pattern.version changed.
  virtual void analyze(const BlockPattern& pattern) = 0;
  /// Numeric factorisation of the analysed pattern with these numbers (pattern.value_count() of them).
  [[nodiscard]] virtual FactorStatus factorize(std::span<const double> values) = 0;
  /// Solves A x = b with the last factor, which must be ok. b and x may be the same memory.
  virtual void solve(std::span<const double> b, std::span<double> x) = 0;
  /// Threads to work with from now on; a backend may ignore them. The bits of a result must not depend on it.
  virtual void set_threads(ThreadPool*) {}
  /// Numbers stored in the factor.
  [[nodiscard]] virtual std::int64_t factor_size() const = 0;
  /// What was chosen inside ("simplicial", "supernodal"), for the Summary.
  [[nodiscard]] virtual std::string description() const = 0;
};

/// A registered backend.
struct LinearSolverType {
  std::string name;
  std::string description;
  std::string license;  ///< of the code behind it, as far as it differs from Waymark's own
  std::function<std::unique_ptr<LinearSolver>()> make;
};

}  // namespace waymark
