#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/reproduction/convergence_tables.hpp>
#include <waymark/tools/reproduction/findings.hpp>

namespace waymark {
namespace {

using Drives = std::vector<DriveResult>;

/// The numbers that a finding speaks of, from one source: the paper, its settings, ours.
class Source {
 public:
  /// @param prefix of the settings, "paper_"; empty: the printed figures
  Source(const Drives& drives, const char* prefix) : drives_(&drives), prefix_(prefix) {}

  [[nodiscard]] MetricsColumn column(const std::string& system) const {
    if (prefix_.empty()) return paper_column(*drives_, system);
    return metrics_column(*drives_, system == "gnss" ? system : prefix_ + system);
  }
  [[nodiscard]] PaperMetrics improvement(const std::string& system) const {
    return average_improvement(column("gnss"), column(system));
  }
  /// Drives where the precision of `a` is worse than that of `b`, as " 4 7 8".
  [[nodiscard]] std::string worse_precision(const std::string& a, const std::string& b) const {
    const MetricsColumn left = column(a);
    const MetricsColumn right = column(b);
    std::string labels;
    for (std::size_t i = 0; i < drives_->size(); ++i) {
      if (!left.of_drive[i] || !right.of_drive[i]) continue;
      if (left.of_drive[i]->precision_m > right.of_drive[i]->precision_m)
        labels += (labels.empty() ? "" : ", ") + (*drives_)[i].label();
    }
    return labels.empty() ? "none" : labels;
  }
  [[nodiscard]] std::string prefix() const { return prefix_; }

 private:
  const Drives* drives_;
  std::string prefix_;
};

struct Sources {
  Source paper;
  Source literal;
  Source ours;
};

/// A finding whose three texts and verdicts are functions of the source.
template <typename Text, typename Holds>
Finding make(const Sources& sources, const std::string& statement, Text text, Holds holds) {
  return {statement,          text(sources.paper),    text(sources.literal),
          text(sources.ours), holds(sources.literal), holds(sources.ours)};
}

std::string percents(const Source& source, double PaperMetrics::*metric) {
  std::string text;
  for (const std::string system : {"g1", "g2", "g3", "g2_no_rejection"}) {
    const double percent = source.improvement(system).*metric;
    const char* name = system == "g2_no_rejection" ? "g2 without rejection" : system.c_str();
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name,
                        std::isfinite(percent) ? fmt::format("{:+.1f} %", percent) : "-");
  }
  return text;
}

Finding average_improves(const Sources& sources, const std::string& metric, double PaperMetrics::*member) {
  return make(
      sources, "Fusion (G2) improves the average " + metric + " over raw GNSS (positive: better)",
      [&](const Source& source) { return percents(source, member); },
      [&](const Source& source) { return source.improvement("g2").*member > 0; });
}

Finding accuracy_stays(const Sources& sources) {
  return make(
      sources,
      fmt::format("Fusion (G2) leaves the average Acc, the mean offset, as it is (within {} %)",
                  kUnchangedPercent),
      [](const Source& source) { return percents(source, &PaperMetrics::accuracy_m); },
      [](const Source& source) {
        return std::abs(source.improvement("g2").accuracy_m) <= kUnchangedPercent;
      });
}

Finding mixed_by_drive(const Sources& sources) {
  return make(
      sources, "By drive the picture is mixed: in some the Prec of G2 is worse than that of raw GNSS",
      [](const Source& source) { return "worse in drives " + source.worse_precision("g2", "gnss"); },
      [](const Source& source) { return source.worse_precision("g2", "gnss") != "none"; });
}

Finding rejection_helps_on_average(const Sources& sources) {
  const auto gain = [](const Source& source) {
    const PaperMetrics with = source.improvement("g2");
    const PaperMetrics without = source.improvement("g2_no_rejection");
    return PaperMetrics{with.max_m - without.max_m, 0, with.precision_m - without.precision_m};
  };
  return make(
      sources, "Rejection makes the averages of G2 better, in points of improvement",
      [&](const Source& source) {
        const PaperMetrics g = gain(source);
        return fmt::format("Max {:+.1f}, Prec {:+.1f}", g.max_m, g.precision_m);
      },
      [&](const Source& source) {
        const PaperMetrics g = gain(source);
        return g.max_m > 0 && g.precision_m > 0;
      });
}

Finding rejection_is_mixed(const Sources& sources) {
  return make(
      sources, "By drive rejection helps the Prec of G2 in some and hurts it in others",
      [](const Source& source) {
        return "helps in drives " + source.worse_precision("g2_no_rejection", "g2") + "; hurts in " +
               source.worse_precision("g2", "g2_no_rejection");
      },
      [](const Source& source) {
        return source.worse_precision("g2_no_rejection", "g2") != "none" &&
               source.worse_precision("g2", "g2_no_rejection") != "none";
      });
}

/// The eight drives as the paper's figures know them.
Drives drives_of_paper() {
  Drives drives;
  for (const PaperDrive& drive : paper_drives()) {
    DriveResult result;
    result.dataset = drive.dataset;
    drives.push_back(result);
  }
  return drives;
}

/// Of the paper the text gives the counts; of ours, both starts with the default algorithm count.
Finding convergence(const Drives& drives) {
  const auto counts = [&](const std::string& prefix, const std::string& suffix, auto count_drives) {
    std::string text;
    bool all = true;
    for (const std::string modeling : kModelings) {
      const Reached count = count_drives(drives, prefix + modeling + suffix);
      text += fmt::format("{}{} {} of {}", text.empty() ? "" : ", ", modeling, count.reached, count.of);
      all = all && count.reached == count.of;
    }
    return std::pair(text, all);
  };
  const Reached g1 = count_reached(drives, "paper_g1");
  const Reached g2 = count_reached(drives, "paper_g2");
  const auto [reckoned, reckoned_all] = counts("ours_", "/dead_reckoning/default", count_common_minimum);
  Finding finding;
  finding.statement =
      "From dead reckoning G1 does not converge in most drives, and G2 does in all of them; with our "
      "settings this must "
      "not be so: all converge";
  finding.paper = fmt::format("g1 {} of 8, g2 8 of 8, g3 8 of 8", kPaperG1Converged);
  finding.literal = counts("paper_", "", count_reached).first;
  finding.ours = reckoned;
  finding.literal_holds = 2 * g1.reached < g1.of && g2.reached == g2.of;
  finding.ours_holds = reckoned_all;
  return finding;
}

}  // namespace

std::vector<Finding> findings(const Drives& drives) {
  Drives with_truth;
  for (const DriveResult& drive : drives) {
    if (metrics_of(drive, "gnss")) with_truth.push_back(drive);
  }
  if (with_truth.empty()) return {};
  const Drives printed = drives_of_paper();
  const Sources sources{{printed, ""}, {with_truth, "paper_"}, {with_truth, "ours_"}};
  return {average_improves(sources, "Max", &PaperMetrics::max_m),
          average_improves(sources, "Prec", &PaperMetrics::precision_m),
          accuracy_stays(sources),
          mixed_by_drive(sources),
          rejection_helps_on_average(sources),
          rejection_is_mixed(sources),
          convergence(with_truth)};
}

std::string findings_text(const std::vector<Finding>& findings) {
  const auto verdict = [](bool holds) { return holds ? "holds" : "DOES NOT HOLD"; };
  std::string text;
  int number = 0;
  for (const Finding& finding : findings) {
    text +=
        fmt::format("{}. {}.\n   - paper: {}\n   - literal settings ({}): {}\n   - our settings ({}): {}\n",
                    ++number, finding.statement, finding.paper, verdict(finding.literal_holds),
                    finding.literal, verdict(finding.ours_holds), finding.ours);
  }
  return text;
}

}  // namespace waymark
