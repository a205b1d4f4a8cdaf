/// The optimizer's steps as they come: a line each with -v, else a line of progress on a terminal.
#pragma once

#include <string>

#include <waymark/core/optimize/summary.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// To be told of every step of one optimisation after the other. With -v each begins with a heading.
class IterationTable {
 public:
  /// @param work  what it is part of, before the line of progress; may be empty
  explicit IterationTable(const Console& console, std::string work = {});

  void add(const IterationRecord& record);

 private:
  const Console& console_;
  std::string work_;
  ProgressMeter meter_;
  int last_ = 0;
};

}  // namespace waymark::program
