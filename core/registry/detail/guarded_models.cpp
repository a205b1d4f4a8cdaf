#include <waymark/core/registry/detail/guarded_models.hpp>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/guard.hpp>
#include <waymark/core/registry/detail/added_check.hpp>
#include <waymark/core/system/normal_equations.hpp>

namespace waymark {
namespace {

/// Keeps a model and who it is.
template <typename Model>
class GuardedModel : public Model {
 public:
  GuardedModel(Guarded who, std::unique_ptr<Model> model) : who_(std::move(who)), model_(std::move(model)) {}

 protected:
  template <typename Call>
  decltype(auto) call(const Call& call) const {
    return guarded([&] { return who_.text(); }, who_.name, [&]() -> decltype(auto) { return call(*model_); });
  }

  /// Lets the model add to a graph. What it adds must be usable.
  template <typename Input>
  void extend_graph(const Input& input, Graph& graph) {
    const detail::AddedCheck added(graph);
    call([&](Model& model) {
      try {
        model.extend(input, graph);
      } catch (const UsageError& error) {  // of the graph, which the model uses, or of its own
        throw UsageError(who_.text() + ": " + error.what());
      }
    });
    const std::string flaw = added.flaw(graph);
    if (!flaw.empty()) throw PluginError(who_.text() + ": added " + flaw, who_.name);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw PluginError(who_.text() + ": " + what, who_.name);
  }

 private:
  Guarded who_;
  std::unique_ptr<Model> model_;
};

class GuardedOdometry final : public GuardedModel<OdometryModel> {
 public:
  using GuardedModel::GuardedModel;
  void extend(const OdometryInput& input, Graph& graph) override { extend_graph(input, graph); }
  [[nodiscard]] double standstill_speed() const override {
    return call([](const OdometryModel& model) { return model.standstill_speed(); });
  }
};

class GuardedModeling final : public GuardedModel<GnssModeling> {
 public:
  using GuardedModel::GuardedModel;
  void extend(const GnssInput& input, Graph& graph) override { extend_graph(input, graph); }
  [[nodiscard]] std::vector<ExpectedError> lasting_errors(std::span<const Fix> fixes,
                                                          const Graph& minimum) const override {
    return call([&](const GnssModeling& model) { return model.lasting_errors(fixes, minimum); });
  }
};

class GuardedSensor final : public GuardedModel<SensorModel> {
 public:
  using GuardedModel::GuardedModel;
  void check_drive(std::span<const Fix> fixes, const SensorTable& readings) const override {
    call([&](const SensorModel& model) { model.check_drive(fixes, readings); });
  }
  [[nodiscard]] std::vector<RoughPosition> rough_positions(const SensorTable& readings) const override {
    return call([&](const SensorModel& model) { return model.rough_positions(readings); });
  }
  void extend(const SensorInput& input, Graph& graph) override { extend_graph(input, graph); }
};

class GuardedAlgorithm final : public GuardedModel<Algorithm> {
 public:
  using GuardedModel::GuardedModel;
  void reset() override {
    has_retreated_ = false;
    call([](Algorithm& model) { model.reset(); });
  }
  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                       double decrement_bound, Step& step) override {
    const ProposalStatus status =
        call([&](Algorithm& model) { return model.propose(equations, solver, decrement_bound, step); });
    if (status == ProposalStatus::ok) require_sound(step, equations.gradient().size(), decrement_bound);
    if (status == ProposalStatus::retreat && has_retreated_)
      fail("goes back to the lowest chi2 again without a step between");
    has_retreated_ = status == ProposalStatus::retreat;
    return status;
  }
  [[nodiscard]] bool acceptable(double gain_ratio) const override {
    return call([&](const Algorithm& model) { return model.acceptable(gain_ratio); });
  }
  void accepted(const Step& step, double gain_ratio) override {
    call([&](Algorithm& model) { model.accepted(step, gain_ratio); });
  }
  void rejected(const Step& step, double gain_ratio) override {
    call([&](Algorithm& model) { model.rejected(step, gain_ratio); });
  }

 private:
  /// The loop takes a step as it is, and believes what it promises.
  void require_sound(const Step& step, Eigen::Index unknowns, double decrement_bound) const {
    if (step.delta.size() != unknowns)
      fail("proposed a step of " + std::to_string(step.delta.size()) + " numbers for " +
           std::to_string(unknowns) + " unknowns");
    if (!step.delta.allFinite()) fail("proposed a step that is not finite");
    if (std::isnan(step.predicted_decrease) || step.predicted_decrease < -decrement_bound)
      fail("proposed a step that raises chi2 by its own model; check its sign");
    if (step.full_newton && !(step.newton_decrement >= -decrement_bound))
      fail("tells a Newton decrement below 0, or none, with a full Newton step; check its sign");
  }

  bool has_retreated_ = false;
};

class GuardedSolver final : public GuardedModel<LinearSolver> {
 public:
  using GuardedModel::GuardedModel;
  void analyze(const BlockPattern& pattern) override {
    call([&](LinearSolver& model) { model.analyze(pattern); });
  }
  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    return call([&](LinearSolver& model) { return model.factorize(values); });
  }
  void solve(std::span<const double> b, std::span<double> x) override {
    right_.assign(b.begin(), b.end());  // x may be in its place
    call([&](LinearSolver& model) { model.solve(b, x); });
    require_sound(x);
  }
  void set_threads(ThreadPool* threads) override {
    call([&](LinearSolver& model) { model.set_threads(threads); });
  }
  [[nodiscard]] std::int64_t factor_size() const override {
    return call([](const LinearSolver& model) { return model.factor_size(); });
  }
  [[nodiscard]] std::string description() const override {
    return call([](const LinearSolver& model) { return model.description(); });
  }

 private:
  /// A positive definite matrix has b^T H^-1 b > 0.
  void require_sound(std::span<const double> x) const {
    constexpr double kRounding = 1e-6;  // of b and x, where H is nearly singular
    const auto n = static_cast<Eigen::Index>(x.size());
    const Eigen::Map<const Eigen::VectorXd> solution(x.data(), n);
    const Eigen::Map<const Eigen::VectorXd> right(right_.data(), n);
    if (!solution.allFinite()) fail("solved H x = b by an x that is not finite");
    if (solution.dot(right) < -kRounding * solution.norm() * right.norm())
      fail("solved H x = b by an x with b^T x < 0, although H is positive definite; check its sign");
  }

  std::vector<double> right_;
};

/// A factory that returns nothing is a defect of its plugin.
template <typename Result, typename Model>
std::unique_ptr<Model> guarded_with(Guarded who, std::unique_ptr<Model> model) {
  if (model == nullptr) throw PluginError(who.text() + ": its factory returned nothing", who.name);
  return std::make_unique<Result>(std::move(who), std::move(model));
}

}  // namespace

std::string Guarded::text() const {
  return (origin == "waymark" ? "" : "plugin '" + origin + "': ") + kind + " '" + name + "'";
}

std::unique_ptr<OdometryModel> guarded_model(Guarded who, std::unique_ptr<OdometryModel> model) {
  return guarded_with<GuardedOdometry>(std::move(who), std::move(model));
}
std::unique_ptr<GnssModeling> guarded_model(Guarded who, std::unique_ptr<GnssModeling> model) {
  return guarded_with<GuardedModeling>(std::move(who), std::move(model));
}
std::unique_ptr<SensorModel> guarded_model(Guarded who, std::unique_ptr<SensorModel> model) {
  return guarded_with<GuardedSensor>(std::move(who), std::move(model));
}
std::unique_ptr<Algorithm> guarded_model(Guarded who, std::unique_ptr<Algorithm> model) {
  return guarded_with<GuardedAlgorithm>(std::move(who), std::move(model));
}
std::unique_ptr<LinearSolver> guarded_model(Guarded who, std::unique_ptr<LinearSolver> model) {
  return guarded_with<GuardedSolver>(std::move(who), std::move(model));
}

}  // namespace waymark
