/// Exit codes of the program `waymark`, one per kind of failure. tools/README.md documents them;
/// `--help` and the man pages take them from here.
#pragma once

#include <array>

namespace waymark::program {

enum ExitCode {
  kSuccess = 0,
  kInternalError = 1,  ///< a defect of the program
  kUsageError = 2,     ///< unknown command, option, name or value
  kInputError = 3,     ///< a file or log is wrong or missing
  kNotConverged = 4,   ///< the result was written, but no minimum was reached
  kOutputError = 5,    ///< a result could not be written
  kPluginError = 6,    ///< code of a plugin failed
  kInterrupted = 130   ///< Ctrl-C: the best state so far was written
};

/// An exit code and its meaning.
struct ExitCodeMeaning {
  ExitCode code;
  const char* meaning;
};
inline constexpr std::array kExitCodeMeanings = {
    ExitCodeMeaning{kSuccess, "success"},
    ExitCodeMeaning{kInternalError, "internal error"},
    ExitCodeMeaning{kUsageError, "wrong usage"},
    ExitCodeMeaning{kInputError, "bad input"},
    ExitCodeMeaning{kNotConverged, "no convergence (the result is written and marked)"},
    ExitCodeMeaning{kOutputError, "output not written"},
    ExitCodeMeaning{kPluginError, "a plugin failed"},
    ExitCodeMeaning{kInterrupted, "interrupted (the best state so far is written)"}};

/// The words of an error by which a run says that it lacks memory. `fleet` runs such a drive again, with
/// more of it.
inline constexpr std::array kLackOfMemory = {"needs more memory than there is", "there is no memory left"};

}  // namespace waymark::program
