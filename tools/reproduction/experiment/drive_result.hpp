/// What the experiment gave on one drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/run_setting.hpp>
#include <waymark/tools/reproduction/paper/paper.hpp>

namespace waymark::reproduction {

/// Errors at fixes that were kept out of the graph in one way; for drives without truth.
struct WithheldResult {
  std::string way;                ///< "every 10th fix", "outages of 30 s"
  std::vector<Outcome> outcomes;  ///< of the evaluated settings
};

struct DriveResult {
  int dataset = 0;  ///< of the paper: 1 ... 8; 0: none of them
  std::string name;
  std::string group;  ///< the preset that it is a draw of, where draws are pooled; else empty
  bool simulated = false;
  bool imitated_odometry = false;  ///< made from the truth; the name of its log says so
  double duration_s = 0;
  double distance_m = 0;  ///< by the odometry
  std::size_t fixes = 0;
  std::size_t odometry_samples = 0;
  std::vector<Outcome> outcomes;
  std::vector<WithheldResult> withheld;

  /// The drive as tables name it: the paper's number, else its name.
  [[nodiscard]] std::string label() const;
};

/// Runs the settings on a drive. @param dataset of the paper, or 0
[[nodiscard]] DriveResult study_drive(int dataset, StudiedDrive& drive, const std::vector<Setting>& settings,
                                      const Laboratory& laboratory);

/// Of a system ("gnss", or a setting's name) against truth; empty where there is no truth or no result.
[[nodiscard]] std::optional<evaluation::PositionMetrics> metrics_of(const DriveResult& drive,
                                                                    const std::string& system);

/// The same for stated against actual errors.
[[nodiscard]] std::optional<evaluation::ConsistencyStatistics> consistency_of(const DriveResult& drive,
                                                                              const std::string& setting);
/// Its label, and what of it is simulated or imitated.
[[nodiscard]] std::string labelled(const DriveResult& drive);

/// The three numbers of the paper of one system over several drives, with averages as the paper forms them:
/// over the drives that have numbers, each counted once, however long.
struct MetricsColumn {
  std::vector<std::optional<PaperMetrics>> of_drive;  ///< as the drives
  std::optional<PaperMetrics> average;                ///< empty without any
};

/// @param system "gnss" or a setting's name
[[nodiscard]] MetricsColumn metrics_column(const std::vector<DriveResult>& drives, const std::string& system);
/// The same of the paper's figures, for the drives that are its own. @param system gnss, g1, g2, g3,
/// g2_no_rejection
[[nodiscard]] MetricsColumn paper_column(const std::vector<DriveResult>& drives, const std::string& system);

/// 100 (1 - average / average of GNSS), as the paper forms it.
[[nodiscard]] PaperMetrics average_improvement(const MetricsColumn& gnss, const MetricsColumn& fused);

}  // namespace waymark::reproduction
