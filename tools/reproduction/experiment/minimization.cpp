#include <fmt/format.h>

#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/reproduction/experiment/minimization.hpp>

namespace waymark::reproduction {
namespace {

/// The rule of g2o, as an observer that cancels the run.
class GainRule {
 public:
  explicit GainRule(const std::atomic<bool>* outer) : outer_(outer) {}

  void observe(const IterationRecord& record) {
    if (outer_ != nullptr && outer_->load()) stop_ = true;
    attempts_ = record.accepted ? 0 : attempts_ + 1;
    if (attempts_ >= kGainAttempts)
      end(fmt::format("{} steps in a row did not lower chi2", attempts_), false);
    if (!record.accepted) return;
    ++taken_;
    const double gain = record.decrease / record.chi2;
    // In g2o the first iteration has no gain: the rule starts from the chi2 after it.
    if (taken_ > 1 && gain >= 0 && gain < kGain)
      end(fmt::format("a {} step lowered chi2 by {:.2g} of it", record.kind, gain), true);
    if (taken_ >= kGainIterations) end(fmt::format("{} iterations", taken_), false);
  }

  [[nodiscard]] bool ended() const { return !message_.empty(); }
  [[nodiscard]] bool converged() const { return converged_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::atomic<bool>* token() const { return &stop_; }

 private:
  void end(std::string message, bool converged) {
    if (ended()) return;
    message_ = std::move(message);
    converged_ = converged;
    stop_ = true;
  }

  const std::atomic<bool>* outer_;
  std::atomic<bool> stop_{false};
  int taken_ = 0;
  int attempts_ = 0;
  bool converged_ = false;
  std::string message_;
};

}  // namespace

Ending describe(const Summary& summary) {
  Ending ending;
  ending.converged = summary.converged();
  ending.message = summary.message;
  for (const IterationRecord& record : summary.records)
    ++(record.accepted ? ending.iterations : ending.rejected_steps);
  ending.initial_chi2 = summary.initial_chi2;
  ending.chi2 = summary.final_chi2;
  return ending;
}

Ending minimize(Graph& graph, const Setting& setting, const TypeRegistry& registry,
                const std::atomic<bool>* cancel) {
  const drive::Minimization& how = setting.fusion.minimization;
  if (setting.stopping == StoppingRule::full_steps)
    return describe(drive::minimize(graph, how, registry, {.cancel = cancel}).summary);
  GainRule rule(cancel);
  const Minimizer search = [](Graph& of, Algorithm& algorithm, LinearSolver& solver,
                              OptimizerOptions options) {
    options.max_iterations = kGainIterations * kGainAttempts;
    options.decrement_tolerance = 1e-300;  // only the rule of g2o ends the run
    options.gradient_tolerance = 0;
    options.step_tolerance = 0;
    return optimize(of, algorithm, solver, options);
  };
  const drive::MinimizationWatch watch{
      .observer = [&rule](const IterationRecord& record) { rule.observe(record); }, .cancel = rule.token()};
  Ending ending = describe(drive::minimize(graph, how, registry, watch, search).summary);
  if (rule.ended()) {
    ending.converged = rule.converged();
    ending.message = rule.message();
  }
  return ending;
}

}  // namespace waymark::reproduction
