#include <waymark/formats/logs/detail/can/dbc_multiplexing.hpp>

#include <vector>

#include <fmt/format.h>

namespace waymark::formats {
namespace {

/// A signal is unreadable if its multiplexer is, or if it depends on itself.
void check_multiplexers(const DbcMessage& message, const std::string& path, DbcSignal& signal) {
  const DbcSignal* outer = &signal;
  for (std::size_t steps = 0; signal.trouble.empty() && outer->multiplexer; ++steps) {
    outer = &message.signals[*outer->multiplexer];
    signal.trouble = outer->trouble;
    if (steps > message.signals.size())
      signal.trouble = fmt::format("{}:{}:1: SG_ {}: its multiplexers depend on each other in a circle", path,
                                   signal.line, signal.name);
  }
}

}  // namespace

void resolve_multiplexing(DbcMessage& message, const std::string& path) {
  std::vector<std::size_t> roots;
  std::size_t multiplexers = 0;
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const DbcSignal& signal = message.signals[i];
    if (signal.multiplexes) ++multiplexers;
    if (signal.multiplexes && signal.when.empty()) roots.push_back(i);
  }
  for (DbcSignal& signal : message.signals) {
    if (signal.when.empty() || signal.multiplexer || !signal.trouble.empty()) continue;
    const std::string place = fmt::format("{}:{}:1: SG_ {}: ", path, signal.line, signal.name);
    // In extended multiplexing, "m3M" usually depends on the only "M". The file must state the
    // multiplexer of a plain "m3".
    if (roots.empty()) {
      signal.trouble =
          fmt::format("{}the signal is multiplexed, but {} has no multiplexer (M)", place, message.name);
    } else if (roots.size() > 1 || (multiplexers > 1 && !signal.multiplexes)) {
      signal.trouble =
          fmt::format("{}{} has several multiplexers: a line SG_MUL_VAL_ must say which one is meant", place,
                      message.name);
    } else {
      signal.multiplexer = roots.front();
    }
  }
  for (DbcSignal& signal : message.signals) check_multiplexers(message, path, signal);
}

}  // namespace waymark::formats
