#include <waymark/tools/program/jobs/evaluation/document_evaluation.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/poses_at_fixes.hpp>
#include <waymark/tools/drive/model/provenance.hpp>

namespace waymark::program {
namespace {

std::string spanned(Stamp first, Stamp last) {
  return fmt::format("from {} s to {} s", formats::decimal_seconds(first), formats::decimal_seconds(last));
}

/// Adds where on Earth the raw and fused positions are, if the frame is known.
void add_places(const formats::GraphDocument& document, const evaluation::EvaluationInput& input,
                evaluation::Evaluation& evaluation) {
  if (!document.frame || document.frame->zone == 0) return;
  const drive::Projection projection(*document.frame);
  for (std::size_t i = 0; i < evaluation.epochs.size(); ++i) {
    evaluation.epochs[i].fused_place = projection.to_geodetic(input.fused[i].pose.head<2>());
    if (!input.fixes.empty())
      evaluation.epochs[i].raw_place = projection.to_geodetic(input.fixes[i].position);
  }
}

}  // namespace

evaluation::Prediction as_prediction(std::string label, drive::PosesAtWithheld at) {
  return {.label = std::move(label),
          .poses = std::move(at.poses),
          .position_covariances = std::move(at.position_covariances)};
}

evaluation::Evaluation evaluate_document(const formats::GraphDocument& document,
                                         const std::vector<TruthPose>& truth,
                                         const std::vector<evaluation::Prediction>& further) {
  evaluation::EvaluationInput input;
  input.fused = drive::evaluated_poses(document);
  input.when_measured = drive::poses_when_measured(document);
  input.heights_m = drive::evaluated_heights(document);
  input.fixes = document.fixes;
  input.truth = truth;
  input.truth_reference_m = document.truth_reference_m;
  input.independent_errors = std::none_of(document.provenance.begin(), document.provenance.end(),
                                          [](const auto& entry) { return entry.first == drive::kFixErrors; });
  input.frame = document.frame.value_or(Frame());
  input.max_stamp_offset_s = drive::kLargestSnap;  // a fix may share the node of an odometry sample
  const auto covariances = drive::evaluated_covariances(document);
  if (std::all_of(covariances.begin(), covariances.end(), [](const auto& c) { return c.has_value(); })) {
    for (const auto& covariance : covariances) input.position_covariances.push_back(*covariance);
  }
  const auto headings = drive::evaluated_heading_sigmas(document);
  if (std::all_of(headings.begin(), headings.end(), [](const auto& sigma) { return sigma.has_value(); })) {
    for (const auto& sigma : headings) input.heading_sigmas_rad.push_back(*sigma);
  }
  if (!document.fixes.empty())
    input.predictions = {as_prediction("dead reckoning", drive::dead_reckoned_at_withheld(document))};
  for (const evaluation::Prediction& prediction : further) input.predictions.push_back(prediction);
  evaluation::Evaluation evaluation = evaluation::evaluate(input);
  evaluation.residuals = evaluation::residuals_by_source(document);
  add_places(document, input, evaluation);
  return evaluation;
}

std::vector<TruthPose> truth_for(const formats::GraphDocument& document,
                                 const drive::DriveDescription& description, const TypeRegistry& registry) {
  if (!description.truth) throw InputError(description.path + ": has no 'truth' section");
  if (!document.frame || document.frame->zone == 0)
    throw InputError("the graph has no UTM frame, so geodetic truth cannot be compared with it");
  return drive::load_truth(description, *document.frame, registry);
}

std::vector<TruthPose> truth_from_tum(const std::string& path) {
  std::vector<TruthPose> truth;
  for (const StampedPose& pose :
       formats::read_tum(formats::read_text_file(path, {.check = formats::require_digits(path)}), path))
    truth.push_back({pose.stamp, pose.pose.head<2>(), pose.pose[2]});
  std::stable_sort(truth.begin(), truth.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return truth;
}

std::string partial_truth_warning(const formats::GraphDocument& document, const std::vector<TruthPose>& truth,
                                  const std::string& place, const std::string& remedy) {
  if (truth.empty() || document.fixes.empty()) return {};
  constexpr double kMostOutside = 0.01;
  const auto [first, last] =
      std::minmax_element(document.fixes.begin(), document.fixes.end(),
                          [](const Fix& a, const Fix& b) { return a.stamp < b.stamp; });
  const auto within = std::count_if(document.fixes.begin(), document.fixes.end(), [&](const Fix& fix) {
    return fix.stamp >= truth.front().stamp && fix.stamp <= truth.back().stamp;
  });
  const double share = static_cast<double>(within) / static_cast<double>(document.fixes.size());
  if (share >= 1 - kMostOutside) return {};
  const std::string spans =
      fmt::format("trajectory {}, truth {} on the scale '{}'", spanned(first->stamp, last->stamp),
                  spanned(truth.front().stamp, truth.back().stamp), to_string(document.time_scale));
  if (within == 0)
    throw InputError(
        fmt::format("{}the truth does not overlap the trajectory: {}; {}", place, spans, remedy));
  return fmt::format("{}the truth covers {:.1f} % of the trajectory's fixes: {}; the others are not judged",
                     place, 100 * share, spans);
}

}  // namespace waymark::program
