/// Loads a module in a child process first: a damaged one ends the child and not the host.
#pragma once

#include <functional>
#include <string>

namespace waymark {

/// Calls `load` in a child process without output, and waits for its end. What `load` throws there is
/// ignored, because the host is told the same when it loads the module itself. It does nothing if
/// the host has several threads: one of them may hold a lock that the child would wait for.
/// @throws UsageError "FILE: loading it ends a process by signal 11 (...)" and the like, also after
/// 20 s
void try_in_child(const std::string& file, const std::function<void()>& load);

}  // namespace waymark
