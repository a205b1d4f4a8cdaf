/// The interface of linear backends. They factorise a sparse symmetric positive definite matrix and
/// solve with the factor.
///
/// Preconditions, which the caller of a backend ensures: analyze() comes before factorize(), a
/// successful factorize() before solve(), and spans have the sizes of the pattern. Spans and the
/// pattern are used only during a call. One thread at a time may use a backend; several backends
/// may run at the same time.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/block_pattern.hpp>
#include <waymark/core/registry/options.hpp>

namespace WAYMARK_EXPORT waymark {

class ThreadPool;

/// The outcome of a factorisation. A failure is normal: a damped method then increases the damping.
enum class FactorStatus {
  ok,
  not_positive_definite,  ///< a pivot was zero, negative or not finite
  out_of_memory
};

/// A linear backend. The matrix is given in elimination order, and a backend keeps that order.
class LinearSolver {
 public:
  virtual ~LinearSolver();
  /// Analyses the pattern. It is called again only if pattern.version has changed.
  virtual void analyze(const BlockPattern& pattern) = 0;
  /// Factorises the analysed pattern with these numbers (pattern.value_count() of them).
  [[nodiscard]] virtual FactorStatus factorize(std::span<const double> values) = 0;
  /// Solves A x = b with the last factor, which must be ok. b and x may be the same memory.
  virtual void solve(std::span<const double> b, std::span<double> x) = 0;
  /// Sets the threads for all later calls. A backend may ignore them. The bits of a result must not
  /// depend on them.
  virtual void set_threads(ThreadPool*) {}
  /// Returns how many numbers the factor has.
  [[nodiscard]] virtual std::int64_t factor_size() const = 0;
  /// Returns the backend's own choice ("simplicial", "supernodal"), for the Summary.
  [[nodiscard]] virtual std::string description() const = 0;
};

/// A registered backend.
struct LinearSolverType {
  std::string name;
  std::string description;
  std::string license;  ///< license of the code behind it, if it differs from that of Waymark
  std::function<std::unique_ptr<LinearSolver>(const CheckedOptions&)> make;
  std::vector<OptionInfo> options = {};
};

}  // namespace waymark
