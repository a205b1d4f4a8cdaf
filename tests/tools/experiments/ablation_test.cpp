// The ablation and the consistency study: the settings, the pooling of figures, the effect of inflation.
#include <cmath>
#include <set>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/reproduction/experiment/ablation.hpp>
#include <waymark/tools/reproduction/experiment/consistency_study.hpp>
#include <waymark/tools/reproduction/experiment/outlier_treatment.hpp>

#include "support/registry.hpp"

namespace ablation_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::evaluation;
using namespace waymark::reproduction;
using Catch::Contains;

namespace {

Fix fix_at(double seconds, int source = 0) {
  Fix fix;
  fix.stamp = Stamp::from_seconds(seconds);
  fix.source = source;
  fix.covariance = Eigen::Matrix2d::Identity();
  return fix;
}

EpochResult residual(double nu, FixStatus status = FixStatus::accepted) {
  EpochResult result;
  result.nu = nu;
  result.status = status;
  return result;
}

Outcome judged(const std::string& setting, double rmse_m, double nees, double coverage) {
  Outcome outcome;
  outcome.setting.name = setting;
  outcome.ending.converged = true;
  TruthEvaluation truth;
  truth.fused.position.rmse_m = rmse_m;
  truth.consistency.emplace();
  truth.consistency->nees_mean = nees;
  truth.consistency->coverage = coverage;
  outcome.evaluation.truth = truth;
  return outcome;
}

}  // namespace

TEST_CASE("ablation: the default setting states nothing: all of it is the modeling's, as in run") {
  const Setting setting = default_setting();
  CHECK(setting.fusion == drive::FusionSettings());
  CHECK(setting.fusion.modeling_options.empty());
  CHECK_FALSE(setting.fusion.gate.enabled.has_value());
  CHECK_FALSE(setting.fusion.calibration.has_value());
  CHECK_FALSE(setting.fusion.estimates_noise.has_value());
  for (const Setting& other : our_settings()) {
    CHECK(other.fusion.gate.enabled.has_value());
    CHECK(other.fusion.calibration == Options());
    CHECK(other.fusion.estimates_noise == false);
  }
}

TEST_CASE("ablation: each ingredient differs from the default in one thing, and every name is its own") {
  const Setting standard = default_setting();
  std::set<std::string> names;
  std::set<std::string> titles;
  int switched = 0;
  for (const Ablation& ablation : ablations()) {
    const Setting& setting = ablation.setting;
    INFO(setting.name);
    CHECK(names.insert(setting.name).second);
    CHECK(titles.insert(ablation.title).second);
    if (setting.fusion.modeling != standard.fusion.modeling || setting.name == standard.name) continue;
    ++switched;
    drive::FusionSettings rest = setting.fusion;
    rest.modeling_options = standard.fusion.modeling_options;
    CHECK((setting.fusion.modeling_options != standard.fusion.modeling_options) +
              !(rest == standard.fusion) ==
          1);
    CHECK(setting.fusion.loss.empty());
  }
  CHECK(switched == 12);
  CHECK(names.contains(kWhiteReference));
  // Every registered loss has a line.
  for (const LossType& loss : builtin_losses()) CHECK(names.contains("white/" + loss.name));
}

TEST_CASE("ablation: the options that the ablation states are there, and each state can be left out") {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const Ablation& ablation : ablations()) {
    INFO(ablation.setting.name);
    CHECK_NOTHROW((void)registry.make_gnss_modeling(ablation.setting.fusion.modeling,
                                                    ablation.setting.fusion.modeling_options));
    CHECK_NOTHROW((void)drive::loss_of_fixes(ablation.setting.fusion.loss, registry));
    const auto& calibration = ablation.setting.fusion.calibration;
    if (ablation.setting.name.starts_with("waymark/no_") && calibration)
      CHECK(calibration->size() + 1 == default_calibration().size());
  }
}

TEST_CASE("ablation: a factor up and the same factor down are no change on the average") {
  CHECK(mean_change_percent({2, 0.5}, {1, 1}) == Approx(0).margin(1e-12));
  CHECK(mean_change_percent({1.1, 2.2}, {1, 2}) == Approx(10));
  CHECK(mean_change_percent({1.1, kUndefined}, {1, 1}) ==
        Approx(10));  // drives without a figure are left out
  CHECK(std::isnan(mean_change_percent({kUndefined}, {1})));
  CHECK(std::isnan(mean_change_percent({}, {})));
}

TEST_CASE(
    "ablation: inflation multiplies a covariance by the mean of nu over 2 about it, and never shrinks it") {
  const std::vector<Fix> fixes = {fix_at(0), fix_at(10), fix_at(20), fix_at(20, 1), fix_at(100), fix_at(101)};
  const std::vector<EpochResult> residuals = {residual(8),          residual(4),
                                              residual(0),          residual(200),
                                              residual(kUndefined), residual(50, FixStatus::rejected)};
  const std::vector<Fix> inflated = inflate_fixes(fixes, residuals);
  REQUIRE(inflated.size() == fixes.size());
  const double expected[] = {(8.0 + 4.0) / 2 / 2, (8.0 + 4.0 + 0.0) / 3 / 2, 1, 100, 1, 1};
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    INFO(i);
    CHECK(inflated[i].covariance.isApprox(expected[i] * Eigen::Matrix2d::Identity()));
  }
  CHECK_THROWS_AS(inflate_fixes(fixes, {}), UsageError);
}

TEST_CASE("ablation: the consistency study takes presets in turn and leaves no seed out") {
  const std::vector<Draw> draws =
      consistency_draws(std::vector<std::string>{"highway", "urban", "paper-1"}, 5);
  REQUIRE(draws.size() == 5);
  const char* presets[] = {"highway", "urban", "paper-1", "highway", "urban"};
  for (std::size_t i = 0; i < draws.size(); ++i) {
    CHECK(draws[i].preset == presets[i]);
    CHECK(draws[i].seed == 1000 + i);
  }
}

TEST_CASE("ablation: pooled means count every drive once, with the standard error of independent drives") {
  const PooledMean mean = pooled_mean({1, 3, 5});
  CHECK(mean.mean == Approx(3));
  CHECK(mean.standard_error == Approx(2 / std::sqrt(3.0)));
  CHECK(std::isnan(pooled_mean({1}).standard_error));
  CHECK(std::isnan(pooled_mean({}).mean));

  std::vector<DriveResult> drives(2);
  drives[0].group = "highway";
  drives[0].outcomes = {judged(kDefaultModel, 3, 1, 1), judged("ours_g1", 5, 40, 0.1)};
  drives[1].group = "urban";
  drives[1].outcomes = {judged(kDefaultModel, 4, 3, 0.9)};
  const text::Table table = consistency_report(drives, "").tables.front();
  const std::vector<std::string>& together = table.rows.at(4);
  CHECK(together == std::vector<std::string>{"together", "default", "2", "2", "2.00", "1.00", "95.0", "5.0",
                                             "3.54"});  // sqrt((9 + 16) / 2)
  CHECK(table.rows.at(5)[3] == "1");                    // ours_g1 has a result on one of two
}

TEST_CASE("ablation: a drive of the ablation is judged by truth, or by the fixes kept out") {
  DriveResult with_truth;
  with_truth.name = "A";
  with_truth.outcomes = {judged(kDefaultModel, 2, 2, 0.95), judged(kWhiteReference, 4, 40, 0.1)};
  DriveResult without;
  without.name = "B";
  Outcome outcome;
  outcome.setting.name = kDefaultModel;
  outcome.ending.converged = true;
  outcome.evaluation.at_withheld.push_back({});
  outcome.evaluation.at_withheld.back().label = "fused";
  outcome.evaluation.at_withheld.back().at_fixes.rmse_m = 7;
  without.withheld.push_back({"outages", {outcome}});
  const ReproductionReport report = ablation_report({with_truth, without}, "");
  const text::Table& errors = report.tables.front();
  CHECK(errors.columns[1] == "A");
  CHECK(errors.columns[2] == "B: outages");
  CHECK(errors.rows[0] == std::vector<std::string>{"default", "2.00", "7.00", "0.0", "-50.0"});
  CHECK(report.tables.back().columns.size() == 2);  // no NEES without truth
  CHECK_THAT(report_markdown(report), Contains("# One part changed at a time"));
  CHECK_THAT(report_json(report, {with_truth}), Contains("waymark-ablation"));
}

}  // namespace ablation_test
