/// Exit codes of the program `waymark`: one per kind of failure. Documented in README.md and `waymark
/// --help`.
#pragma once

namespace waymark {

enum ExitCode {
  kSuccess = 0,
  kInternalError = 1,  ///< a defect of the program
  kUsageError = 2,     ///< unknown command, option, name or value
  kInputError = 3,     ///< a file or log is wrong or missing
  kNotConverged = 4,   ///< the result was written, but no minimum was reached
  kOutputError = 5,    ///< a result could not be written
  kInterrupted = 130   ///< Ctrl-C: the best state so far was written
};

}  // namespace waymark
