/// The results of an experiment on one drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/run_setting.hpp>
#include <waymark/tools/reproduction/paper/paper.hpp>

namespace waymark::reproduction {

/// Errors at withheld fixes, for one way of withholding them. Used for drives without truth.
struct WithheldResult {
  std::string way;                ///< "every 10th fix", "outages of 30 s"
  std::vector<Outcome> outcomes;  ///< of the evaluated settings
};

struct DriveResult {
  int dataset = 0;  ///< of the paper: 1 ... 8; 0: not from the paper
  std::string name;
  std::string group;  ///< preset of which it is a draw, if draws are pooled; else empty
  bool simulated = false;
  /// the odometry was made from the truth; the name of its log says so
  bool imitated_odometry = false;
  double duration_s = 0;
  double distance_m = 0;  ///< by the odometry
  std::size_t fixes = 0;
  std::size_t odometry_samples = 0;
  std::vector<Outcome> outcomes;
  std::vector<WithheldResult> withheld;

  /// Returns the drive's name in tables: the number in the paper, or else its name.
  [[nodiscard]] std::string label() const;
};

/// Runs the settings on a drive. @param dataset number in the paper, or 0
[[nodiscard]] DriveResult study_drive(int dataset, StudiedDrive& drive, const std::vector<Setting>& settings,
                                      const Laboratory& laboratory);

/// Returns the metrics of a system ("gnss", or the name of a setting) against truth. Empty without
/// truth or result.
[[nodiscard]] std::optional<evaluation::PositionMetrics> metrics_of(const DriveResult& drive,
                                                                    const std::string& system);

/// Returns the consistency of stated with actual errors in the same way.
[[nodiscard]] std::optional<evaluation::ConsistencyStatistics> consistency_of(const DriveResult& drive,
                                                                              const std::string& setting);
/// Returns its label, and what of it is simulated or imitated.
[[nodiscard]] std::string labelled(const DriveResult& drive);

/// The paper's three numbers of one system over several drives. Averages are computed as in the
/// paper: over the drives that have numbers, each counted once, however long.
struct MetricsColumn {
  std::vector<std::optional<PaperMetrics>> of_drive;  ///< in the order of the drives
  std::optional<PaperMetrics> average;                ///< empty without any
};

/// @param system "gnss" or the name of a setting
[[nodiscard]] MetricsColumn metrics_column(const std::vector<DriveResult>& drives, const std::string& system);
/// Returns the same for the figures of the paper, on its own drives. @param system gnss, g1, g2,
/// g3, g2_no_rejection
[[nodiscard]] MetricsColumn paper_column(const std::vector<DriveResult>& drives, const std::string& system);

/// Returns 100 (1 - average / average of GNSS), as in the paper.
[[nodiscard]] PaperMetrics average_improvement(const MetricsColumn& gnss, const MetricsColumn& fused);

}  // namespace waymark::reproduction
