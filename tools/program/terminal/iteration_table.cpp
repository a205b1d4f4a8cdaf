#include <waymark/tools/program/terminal/iteration_table.hpp>

#include <fmt/format.h>

namespace waymark::program {
namespace {

// 80 columns. All except the time are numbers without unit: chi2, its actual and predicted
// decrease, and the largest gradient in units of the sigma of its unknown.
constexpr const char* kHeading =
    "  no  step               chi2    decrease   predicted  gradient  taken  time [s]";

std::string line_of(const IterationRecord& r) {
  return fmt::format("{:>4}  {:<7}  {:>14.9g}  {:>10.4g}  {:>10.4g}  {:>8.3g}  {:<5}  {:>8.3f}", r.iteration,
                     r.kind, r.chi2, r.decrease, r.predicted_decrease, r.gradient, r.accepted ? "yes" : "no",
                     r.seconds);
}

}  // namespace

IterationTable::IterationTable(const Console& console, std::string work)
    : console_(console), work_(std::move(work)) {}

void IterationTable::add(const IterationRecord& record) {
  if (console_.step(work_, record)) return;
  const bool first = record.iteration <= last_ || last_ == 0;
  if (first) meter_.restart();
  last_ = record.iteration;
  if (console_.verbosity() > 0) {
    const text::TextLook look = console_.look(true);
    if (first) console_.detail(text::painted(kHeading, text::Tone::heading, look));
    console_.detail(record.accepted ? line_of(record)
                                    : text::painted(line_of(record), text::Tone::dim, look));
    return;
  }
  meter_.update(record.iteration);
  if (!meter_.due()) return;
  const std::string line = iteration_progress(record.iteration, record.chi2, meter_);
  console_.progress(work_.empty() ? line : work_ + "  " + line);
}

}  // namespace waymark::program
