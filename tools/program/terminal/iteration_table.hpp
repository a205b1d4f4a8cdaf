/// Shows the steps of the optimizer: one line each with -v, otherwise a progress line
/// on a terminal.
#pragma once

#include <string>

#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// Is called for every step of consecutive optimisations. With -v each of them begins
/// with a heading.
class IterationTable {
 public:
  /// @param work name of the work that it is a part of, before the progress line; may be empty
  explicit IterationTable(const Console& console, std::string work = {});

  void add(const IterationRecord& record);

 private:
  const Console& console_;
  std::string work_;
  ProgressMeter meter_;
  int last_ = 0;
};

}  // namespace waymark::program
