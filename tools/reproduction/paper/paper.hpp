/// The printed figures of the paper, as data: A. Das, G. Dubbelman, "An Experimental Study on
/// Relative and Absolute Pose Graph Fusion for Vehicle Localization".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::reproduction {

/// The files of this folder.
extern const std::string_view kPaperDrivesCsv;
extern const std::string_view kPaperTablesCsv;

/// A line of the table "Dataset overview".
struct PaperDrive {
  int dataset = 0;  ///< 1 ... 8
  double distance_km = 0;
  int gnss_points = 0;
  int odometry_points = 0;
  double rejected_percent = 0;
  std::string environment;
};

/// Metres, as in Sec. III-B of the paper.
struct PaperMetrics {
  double max_m = 0;
  double accuracy_m = 0;
  double precision_m = 0;
};

/// A line of one of the five tables of results.
struct PaperResult {
  int dataset = 0;     ///< 1 ... 8; 0 is the paper's line "Average"
  std::string system;  ///< 1 ... 8; 0: the line "Average" of the paper
  PaperMetrics metrics;
};

[[nodiscard]] const std::vector<PaperDrive>& paper_drives();
[[nodiscard]] const std::vector<PaperResult>& paper_results();
/// @return empty for a line that is not in the paper
[[nodiscard]] std::optional<PaperMetrics> paper_metrics(int dataset, std::string_view system);

/// The improvement of the average precision with G1 in the text of Sec. III-C, percent. The paper's
/// own table has -7.364.
inline constexpr double kPaperTextG1Precision = -10.11;
/// Number of drives in which G1 converged. G2 converged in all 8. About G3 the text says that it
/// performed well.
inline constexpr int kPaperG1Converged = 3;

}  // namespace waymark::reproduction
