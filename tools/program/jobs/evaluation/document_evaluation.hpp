/// Evaluates a document at its fixes.
#pragma once

#include <string>
#include <vector>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/left_out/outages.hpp>
#include <waymark/tools/evaluation/evaluation.hpp>

namespace waymark::program {

/// Evaluates a document at its fixes. @param truth may be empty
/// @param further predictions of its withheld fixes, besides the fused poses and dead reckoning
[[nodiscard]] evaluation::Evaluation evaluate_document(
    const formats::GraphDocument& document, const std::vector<TruthPose>& truth,
    const std::vector<evaluation::Prediction>& further = {});

[[nodiscard]] evaluation::Prediction as_prediction(std::string label, drive::PosesAtWithheld at);

/// Returns the truth that a drive.yaml names, in the frame of the document. No other log
/// of it is read.
/// @throws InputError for a description without truth, a document without a frame, and an
/// unusable log
[[nodiscard]] std::vector<TruthPose> truth_for(const formats::GraphDocument& document,
                                               const drive::DriveDescription& description,
                                               const TypeRegistry& registry);

/// Returns the truth of a TUM file, in the frame of the document. @throws InputError for a file
/// that cannot be read
[[nodiscard]] std::vector<TruthPose> truth_from_tum(const std::string& path);

/// Returns a warning with the share of the fixes that lie within the time of the truth. Empty if
/// at most 1 % of them lie outside: logs rarely begin and end together.
/// @param place of the truth, for messages: "drive.yaml:12:5: " or "truth.tum: "
/// @param remedy what to check
/// @throws InputError if no fix lies within the time of the truth; it is always a wrong clock
[[nodiscard]] std::string partial_truth_warning(const formats::GraphDocument& document,
                                                const std::vector<TruthPose>& truth, const std::string& place,
                                                const std::string& remedy);

}  // namespace waymark::program
