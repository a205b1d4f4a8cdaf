/// The result of a fusion, as Python sees it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/program/jobs/drive/drive_run.hpp>

namespace waymark::python {

/// A run and what it said. The results of its modelings share it.
struct FinishedRun {
  std::shared_ptr<const TypeRegistry> registry;
  program::DriveRun run;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
};

/// The result of one modeling. It never changes, so its arrays may refer to it.
struct Fused {
  std::shared_ptr<const FinishedRun> all;
  std::size_t index = 0;

  [[nodiscard]] const program::ModelingRun& run() const { return all->run.modelings[index]; }
  [[nodiscard]] const formats::GraphDocument& document() const { return run().model->document; }
};

void bind_fused(pybind11::module_& module);

/// Adds fuse(): the function behind waymark.fuse() of Python.
void bind_fusion(pybind11::module_& module);

/// Returns the outcome of an optimisation as a dict.
[[nodiscard]] pybind11::dict summary_of(const MultiStartSummary& result);

}  // namespace waymark::python
