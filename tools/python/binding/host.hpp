/// Python as the host of a job: the lock of the interpreter is released while the job works, Ctrl-C ends
/// it, and its progress goes to a callback.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::python {

namespace py = pybind11;

/// Listens to one job. What a callback or a signal raises ends the job, and is raised again at its end.
class Host {
 public:
  /// @param progress called with a text, the number of the iteration and chi2, both None between
  /// optimisations; None: nobody is told
  explicit Host(py::object progress) : progress_(std::move(progress)) {}

  [[nodiscard]] program::Listener listener();
  /// Called at every step of an optimisation that has no console.
  void step(const IterationRecord& record);
  [[nodiscard]] const std::atomic<bool>& cancel() const { return cancel_; }

  /// Works without the lock of the interpreter.
  template <typename Work>
  [[nodiscard]] auto run(const Work& work) {
    try {
      auto result = [&] {
        const py::gil_scoped_release release;
        return work();
      }();
      raise();
      return result;
    } catch (const program::Interrupted&) {
      raise();
      throw;
    }
  }

  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// Lets signals and the callback speak. Takes the lock of the interpreter.
  void tell(const std::string& text, const IterationRecord* record);
  /// Raises what a signal or the callback has raised.
  void raise();

  py::object progress_;
  std::atomic<bool> cancel_{false};
  std::optional<py::error_already_set> failure_;
  std::vector<std::string> warnings_;
  std::vector<std::string> notes_;
};

}  // namespace waymark::python
