#include <waymark/core/registry/detail/guarded_models.hpp>

#include <utility>

#include <waymark/core/base/guard.hpp>
#include <waymark/core/registry/detail/added_check.hpp>

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
    call([&](Model& model) { model.extend(input, graph); });
    const std::string flaw = added.flaw(graph);
    if (!flaw.empty()) throw PluginError(who_.text() + ": added " + flaw, who_.name);
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
    call([](Algorithm& model) { model.reset(); });
  }
  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                       double decrement_bound, Step& step) override {
    return call([&](Algorithm& model) { return model.propose(equations, solver, decrement_bound, step); });
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
    call([&](LinearSolver& model) { model.solve(b, x); });
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
