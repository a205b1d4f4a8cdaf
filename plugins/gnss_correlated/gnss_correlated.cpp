#include <waymark/plugins/gnss_correlated/gnss_bias.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

namespace waymark::plugins::gnss_correlated {
namespace {

/// Degrees of freedom of the white part. Student's t in two dimensions costs
///   6 log(1 + q / 4) = rho(1.5 q),  rho(s) = 6 log(1 + s / 6):
/// Cauchy's loss of scale sqrt(6) on 1.5 times the information.
constexpr double kStudentInformation = 1.5;
const double kStudentScale = std::sqrt(6.0);
/// Standard deviation over scale: sqrt(nu / (nu - 2)).
const double kStudentDeviation = std::sqrt(2.0);

using Bias = GaussMarkovProcess<VertexGnssBias, EdgeGnssBiasDecay, EdgeGnssBiasBetween>;
using Multipath = GaussMarkovProcess<VertexGnssMultipath, EdgeGnssMultipathDecay, EdgeGnssMultipathBetween>;

struct ErrorModel {
  double white_m = 0;
  double multipath_m = 0;
  double multipath_time_s = 0;
  double bias_floor_m = 0;
  double bias_share = 0;
  double bias_per_accuracy = 0;
  double bias_time_s = 0;
  double accuracy_exponent = 0;
  double accuracy_exponent_sigma = 0;
  double kind_exponent = 0;
  double reference_accuracy_m = 0;  // 0: that of the coarsest kind
  bool heavy_tails = true;

  /// Returns how much larger the errors of a kind of solution are than those that the sigmas hold for.
  /// Between kinds the claims count nearly as they are: a fixed ambiguity is worth its centimetres.
  [[nodiscard]] double kind_scale(const ClaimedAccuracies& claimed, SolutionKind kind) const {
    const double reference_m = reference_accuracy_m > 0 ? reference_accuracy_m : claimed.reference_m();
    const double median_m = claimed.of(kind);
    return reference_m > 0 && median_m > 0 ? std::pow(median_m / reference_m, kind_exponent) : 1;
  }

  /// Returns the sigma of what the bias of a kind of solution is at the start, beside bias_m(). It is in
  /// proportion to the white noise. A constant offset of all fixes is one that no fix reveals, so this sigma
  /// takes no part in the estimation of the noise; that of a bias which wanders does.
  [[nodiscard]] double first_bias_m(const ClaimedAccuracies& claimed, SolutionKind kind) const {
    return bias_share * white_m * kind_scale(claimed, kind);
  }

  /// Returns the sigma of the bias of a kind of solution.
  [[nodiscard]] double bias_m(const ClaimedAccuracies& claimed, SolutionKind kind) const {
    const double median_m = claimed.of(kind);
    const double floor_m = median_m > 0 ? std::min(bias_floor_m, bias_per_accuracy * median_m) : bias_floor_m;
    return std::hypot(floor_m, bias_share * multipath_m * kind_scale(claimed, kind));
  }

  /// Returns the slow error of fixes like this one, from the first of them on. What a lasting jump leaves open makes it
  /// larger, and it wanders no faster.
  [[nodiscard]] Bias bias_of(const Fix& fix, const ClaimedAccuracies& claimed) const {
    const SolutionKind kind = kind_of(fix.told.quality);
    const double usual_m = bias_m(claimed, kind);
    const double sigma_m = std::hypot(usual_m, fix.jump_sigma_m);
    const double widened = usual_m > 0 ? std::pow(sigma_m / usual_m, 2) : 1;
    return {sigma_m, widened * bias_time_s, first_bias_m(claimed, kind)};
  }

  /// Returns the symmetric root of a fix's relative covariance. Within a kind of solution the claimed
  /// accuracies are used relative to their median: receivers know which fix is worse better than they know
  /// how bad it is. A stand-in for a claim says nothing.
  [[nodiscard]] Eigen::Matrix2d relative_root(const Fix& fix, const ClaimedAccuracies& claimed) const {
    const SolutionKind kind = kind_of(fix.told.quality);
    const double scale = kind_scale(claimed, kind);
    const double median_m = claimed.of(kind);
    if (!fix.accuracy_claimed || !(median_m > 0)) return scale * Eigen::Matrix2d::Identity();
    const auto [variances, directions] = symmetric_eigen(fix.covariance);
    const Eigen::Vector2d errors =
        (variances.cwiseMax(0).cwiseSqrt() / median_m).unaryExpr([this](double claim) {
          return relative_error(claim);
        });
    return directions * (scale * errors).asDiagonal() * directions.transpose();
  }

  /// Returns the deviation of the errors of a claim over that of the median claim, both at once: over claim^p for a
  /// normal p it is claim^mean exp(deviation^2 log^2 claim). A claim that is larger than all before is beyond what the
  /// drive has told of p; its errors are not taken for larger than it says. @param claim over the median
  [[nodiscard]] double relative_error(double claim) const {
    constexpr double kSmallest = 0.3;
    constexpr double kLargest = 30;
    const double expected = std::pow(std::clamp(claim, kSmallest, kLargest), accuracy_exponent);
    const double logarithm = std::log(std::max(claim, kSmallest));
    const double widened = expected * std::exp(std::pow(accuracy_exponent_sigma * logarithm, 2));
    return std::min(widened, std::max({expected, claim, 1.0}));
  }
};

/// measured = antenna + bias + multipath + white noise: see README.md.
class GnssCorrelated final : public GnssModeling {
 public:
  GnssCorrelated(const ErrorModel& model, double time_offset_sigma_s)
      : model_(model), time_offset_sigma_s_(time_offset_sigma_s) {}

  [[nodiscard]] std::vector<ExpectedError> lasting_errors(std::span<const Fix> fixes,
                                                          const Graph& minimum) const override {
    std::vector<ExpectedError> errors;
    for (const Fix& fix : fixes) {
      ExpectedError& error = errors.emplace_back();
      const Eigen::Matrix2d root = model_.relative_root(fix, claimed_);
      if (multipath_) multipath_->add_expectation(fix.stamp, minimum, model_.multipath_m * root, error);
      if (const auto bias = biases_.find(bias_key(fix)); bias != biases_.end())
        bias->second.add_expectation(fix.stamp, minimum, Eigen::Matrix2d::Identity(), error);
      else
        error.rest += std::pow(model_.bias_of(fix, claimed_).first_sigma(), 2) * Eigen::Matrix2d::Identity();
      const double white = model_.white_m * (model_.heavy_tails ? kStudentDeviation : 1);
      error.rest += white * white * root * root;
    }
    return errors;
  }

  void extend(const GnssInput& input, Graph& graph) override {
    if (input.fixes.empty()) return;
    require_moments(input);
    const VertexIndex origin = origin_.in_or(graph, [&] { return add_origin(graph); });
    const VertexIndex offset =
        offset_.in_or(graph, [&] { return make_offset(graph, input.moments.front().assumed_offset_s); });
    const std::optional<Loss> loss =
        input.loss || !model_.heavy_tails ? input.loss : builtin_loss("cauchy", kStudentScale);
    const double peak = model_.heavy_tails ? kStudentInformation : 1;
    claimed_ = input.claimed.kinds() > 0 ? input.claimed : claimed_accuracies(input.fixes);
    if (!multipath_) multipath_ = Multipath(1, model_.multipath_time_s);
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      const Fix& fix = input.fixes[i];
      const Eigen::Matrix2d root = model_.relative_root(fix, claimed_);
      Bias& bias = biases_.try_emplace(bias_key(fix), model_.bias_of(fix, claimed_)).first->second;
      const VertexIndex pose = pose_vertex(fix, graph);
      EdgeGnssPositionCorrelated edge;
      edge.measured = fix.position;
      edge.antenna = input.moments[i].antenna;
      edge.velocity = velocity_in_frame(input.moments[i], graph.value(pose)[2]);
      edge.assumed_offset = input.moments[i].assumed_offset_s;
      edge.scale = model_.multipath_m * Eigen::Vector3d(root(0, 0), root(0, 1), root(1, 1));
      const Eigen::Matrix2d information = peak * (model_.white_m * model_.white_m * root * root).inverse();
      graph.add_edge(edge,
                     {origin, pose, offset, bias.at(fix.stamp, graph), multipath_->at(fix.stamp, graph)},
                     0.5 * (information + information.transpose()), loss);
    }
  }

 private:
  /// What fixes of one slow error have in common.
  using BiasKey = std::tuple<int, SolutionKind, int>;
  [[nodiscard]] static BiasKey bias_key(const Fix& fix) {
    return {fix.source, kind_of(fix.told.quality), fix.level};
  }

  [[nodiscard]] VertexIndex make_offset(Graph& graph, double assumed_s) const {
    if (time_offset_sigma_s_ > 0) return add_time_offset(graph, time_offset_sigma_s_, assumed_s);
    const VertexIndex none = graph.add_vertex<VertexTimeOffset>(graph.free_id(), {assumed_s});
    graph.set_fixed(none, true);
    return none;
  }

  ErrorModel model_;
  double time_offset_sigma_s_;
  ClaimedAccuracies claimed_;
  KeptVertex origin_;
  KeptVertex offset_;
  /// Sources in a group share the error of the seconds. Each has a bias of its own: a constant difference
  /// between two antennas would otherwise turn the vehicle. So has each kind of solution, and each side of a jump.
  std::optional<Multipath> multipath_;
  std::map<BiasKey, Bias> biases_;
};

std::vector<OptionInfo> options() {
  return {
      {"white_sigma", "1.5", "m", OptionRange{1e-3, 1e3}, "scale of the error that is new in every fix",
       NoisePrior{1.5, 0.7, false, true}},
      {"tails", "student", "", OptionWords{"student", "normal"},
       "distribution of the error that is new in every fix: 'student', Student's t of four degrees "
       "of freedom, or 'normal'"},
      {"multipath_sigma", "3", "m", OptionRange{1e-3, 1e3}, "sigma of the error that lasts for seconds",
       NoisePrior{3, 0.7, false, true}},
      {"multipath_time", "30", "s", OptionRange{1, 1e4}, "correlation time of the multipath error",
       NoisePrior{30, 0.4}},
      {"bias_floor", "1.1", "m", OptionRange{1e-3, 1e3},
       "smallest sigma of the error that lasts for minutes"},
      {"bias_per_accuracy", "1.5", "", OptionRange{0.01, 1e6},
       "largest bias_floor, in medians of the claimed accuracies: a receiver that claims centimetres is "
       "not off by metres"},
      {"bias_share", "0.75", "", OptionRange{0, 10},
       "share of multipath_sigma that is added to bias_floor in quadrature"},
      {"bias_time", "2000", "s", OptionRange{1, 1e6}, "correlation time of the bias"},
      {"accuracy_exponent", "0.5", "", OptionRange{0, 1},
       "weight of the claimed accuracies: 0 ignores them, 1 takes them as they are",
       NoisePrior{0.5, 0.3, true}},
      {"accuracy_exponent_sigma", "0", "", OptionRange{0, 1},
       "how well accuracy_exponent is known: the errors of a fix are those that are expected over a normal distribution "
       "of it, at most as large as claimed"},
      {"kind_exponent", "1", "", OptionRange{0, 2},
       "weight of the claims between kinds of solutions (code, float, fixed): the errors of a kind are as "
       "the ratio of its median claim to that of the coarsest kind, to this power",
       NoisePrior{1, 0.3, true, false, true}},
      {"reference_accuracy", "0", "m", OptionRange{0, 1e6},
       "median claim of the fixes that white_sigma and multipath_sigma hold for; 0: that of the coarsest kind of "
       "solution so far"},
      {"time_offset", "off", "", OptionWords{"off", "constant"},
       "delay of the fixes against the odometry: 'off', or 'constant' (estimated)"},
      {"time_offset_sigma", "0.3", "s", OptionRange{1e-6, 100}, "sigma of the prior of time_offset about 0"},
  };
}

std::unique_ptr<GnssModeling> make(const CheckedOptions& options) {
  ErrorModel model;
  model.white_m = options.number("white_sigma");
  model.multipath_m = options.number("multipath_sigma");
  model.multipath_time_s = options.number("multipath_time");
  model.bias_floor_m = options.number("bias_floor");
  model.bias_per_accuracy = options.number("bias_per_accuracy");
  model.bias_share = options.number("bias_share");
  model.bias_time_s = options.number("bias_time");
  model.accuracy_exponent = options.number("accuracy_exponent");
  model.accuracy_exponent_sigma = options.number("accuracy_exponent_sigma");
  model.reference_accuracy_m = options.number("reference_accuracy");
  model.kind_exponent = options.number("kind_exponent");
  model.heavy_tails = options.word("tails") == "student";
  const bool has_offset = options.word("time_offset") == "constant";
  return std::make_unique<GnssCorrelated>(model, has_offset ? options.number("time_offset_sigma") : 0);
}

void register_types(TypeRegistry& registry) {
  registry.add_vertex<VertexGnssBias>();
  registry.add_vertex<VertexGnssMultipath>();
  registry.add_edge<EdgeGnssBiasDecay>();
  registry.add_edge<EdgeGnssMultipathDecay>();
  registry.add_edge<EdgeGnssBiasBetween>();
  registry.add_edge<EdgeGnssMultipathBetween>();
  registry.add_edge<EdgeGnssPositionCorrelated>();
  registry.add_gnss_modeling({"correlated",
                              "fixes with biases that last, heavy-tailed noise and a latency (the default)",
                              options(), make, true, true});
}

}  // namespace
}  // namespace waymark::plugins::gnss_correlated

WAYMARK_PLUGIN(gnss_correlated, "0.1.0", waymark::plugins::gnss_correlated::register_types);
