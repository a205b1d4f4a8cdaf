#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <waymark/tools/reproduction/tables/convergence_tables.hpp>
#include <waymark/tools/reproduction/tables/findings.hpp>

namespace waymark::reproduction {
namespace {

using Drives = std::vector<DriveResult>;

/// Returns "4, 7, 8", or "none". Names that contain commas are separated by semicolons.
std::string listed(const std::vector<std::string>& labels) {
  if (labels.empty()) return "none";
  bool commas = false;
  for (const std::string& label : labels) commas = commas || label.find(',') != std::string::npos;
  return fmt::format("{}", fmt::join(labels, commas ? "; " : ", "));
}

/// The numbers for a finding from one source: the paper, its settings, the same at the
/// minimum, or ours.
class Source {
 public:
  /// @param prefix, suffix of the system's name in the names of settings; both empty: the
  /// printed figures
  Source(std::string name, const Drives& drives, std::string prefix, std::string suffix = "")
      : name_(std::move(name)), drives_(&drives), prefix_(std::move(prefix)), suffix_(std::move(suffix)) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool printed() const { return prefix_.empty(); }
  [[nodiscard]] MetricsColumn column(const std::string& system) const {
    if (prefix_.empty()) return paper_column(*drives_, system);
    return metrics_column(*drives_, system == "gnss" ? system : prefix_ + system + suffix_);
  }
  [[nodiscard]] PaperMetrics improvement(const std::string& system) const {
    return average_improvement(column("gnss"), column(system));
  }
  /// Returns the drives in which the precision of `a` is worse than that of `b`, as "4,
  /// 7, 8"; "none".
  [[nodiscard]] std::string worse_precision(const std::string& a, const std::string& b) const {
    const MetricsColumn left = column(a);
    const MetricsColumn right = column(b);
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < drives_->size(); ++i) {
      if (!left.of_drive[i] || !right.of_drive[i]) continue;
      if (left.of_drive[i]->precision_m > right.of_drive[i]->precision_m)
        labels.push_back((*drives_)[i].label());
    }
    return listed(labels);
  }

 private:
  std::string name_;
  const Drives* drives_;
  std::string prefix_;
  std::string suffix_;
};

using Sources = std::vector<Source>;

/// Makes a finding from functions that give the figures and the verdict of a source.
template <typename Figures, typename Holds>
Finding make(const Sources& sources, const std::string& statement, Figures figures, Holds holds) {
  Finding finding{statement, {}};
  for (const Source& source : sources)
    finding.evidence.push_back({source.name(), figures(source),
                                source.printed() ? std::nullopt : std::optional<bool>(holds(source))});
  return finding;
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
      sources, "By drive the results are mixed: in some the Prec of G2 is worse than the Prec of raw GNSS",
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
      sources, "Rejection improves the Prec of G2 in some drives and makes it worse in others",
      [](const Source& source) {
        return "helps in drives " + source.worse_precision("g2_no_rejection", "g2") + " - hurts in " +
               source.worse_precision("g2", "g2_no_rejection");
      },
      [](const Source& source) {
        return source.worse_precision("g2_no_rejection", "g2") != "none" &&
               source.worse_precision("g2", "g2_no_rejection") != "none";
      });
}

/// Returns the eight drives with the figures of the paper.
Drives drives_of_paper() {
  Drives drives;
  for (const PaperDrive& drive : paper_drives()) {
    DriveResult result;
    result.dataset = drive.dataset;
    drives.push_back(result);
  }
  return drives;
}

using Counter = Reached (*)(const Drives&, const std::string&);

/// Returns "g1 3 of 8, g2 8 of 8, g3 8 of 8".
std::string counts(const Drives& drives, const std::string& prefix, const std::string& suffix,
                   Counter count_drives) {
  std::string text;
  for (const std::string modeling : kModelings) {
    const Reached count = count_drives(drives, prefix + modeling + suffix);
    text += fmt::format("{}{} {} of {}", text.empty() ? "" : ", ", modeling, count.reached, count.of);
  }
  return text;
}

bool some_miss(const Drives& drives, const std::string& setting) {
  const Reached count = count_reached(drives, setting);
  return count.reached < count.of;
}

Finding convergence(const Drives& drives) {
  Finding finding{"From dead reckoning G1 does not converge in every drive", {}};
  finding.evidence = {
      {"paper", fmt::format("g1 {} of 8, g2 8 of 8; g3 performed well", kPaperG1Converged), std::nullopt},
      {"literal", counts(drives, "paper_", "", count_reached), some_miss(drives, "paper_g1")},
      {"literal, guess to the east", counts(drives, "paper_", "/east", count_reached),
       some_miss(drives, "paper_g1/east")},
      {"literal, scaled radius", counts(drives, "paper_", "/radius", count_reached),
       some_miss(drives, "paper_g1/radius")}};
  for (const std::string start : {"dead_reckoning", "east"}) {
    for (const std::string algorithm : {"levenberg_marquardt+starts", "default"}) {
      const std::string suffix = "/" + start + "/" + algorithm;
      finding.evidence.push_back({"ours" + suffix, counts(drives, "ours_", suffix, count_common_minimum),
                                  count_common_minimum(drives, "ours_g1" + suffix).reached <
                                      count_common_minimum(drives, "ours_g1" + suffix).of});
    }
  }
  return finding;
}

/// Compares the averages of our G2 and of the default model with raw GNSS.
Finding default_model_gains(const Drives& drives) {
  const MetricsColumn gnss = metrics_column(drives, "gnss");
  const PaperMetrics g2 = average_improvement(gnss, metrics_column(drives, "ours_g2"));
  const PaperMetrics model = average_improvement(gnss, metrics_column(drives, kDefaultModel));
  const auto figures = [](const PaperMetrics& m) {
    return fmt::format("Max {:+.1f} %, Acc {:+.1f} %, Prec {:+.1f} %", m.max_m, m.accuracy_m, m.precision_m);
  };
  return {"Beyond the paper: the default model improves the averages of Max and Prec more than G2 does",
          {{"ours", figures(g2), std::nullopt},
           {"default model", figures(model), model.max_m > g2.max_m && model.precision_m > g2.precision_m}}};
}

/// Judges the covariances of our G2 and of the default model.
Finding default_model_is_consistent(const Drives& drives) {
  Finding finding{
      fmt::format("Beyond the paper: at least {:.0f} % of the truth lies in the stated 95 % regions",
                  100 * kConsistentCoverage),
      {}};
  for (const std::string& setting : {std::string("ours_g2"), std::string(kDefaultModel)}) {
    double nees = 0;
    double coverage = 0;
    double count = 0;
    for (const DriveResult& drive : drives) {
      const auto stated = consistency_of(drive, setting);
      if (!stated) continue;
      nees += stated->nees_mean;
      coverage += stated->coverage;
      ++count;
    }
    finding.evidence.push_back({setting == kDefaultModel ? "default model" : "ours",
                                fmt::format("coverage {:.0f} %, mean NEES {:.1f} (2 "
                                            "is consistent), {} drives",
                                            100 * coverage / count, nees / count, count),
                                coverage / count >= kConsistentCoverage});
  }
  return finding;
}

bool has_default_model(const Drives& drives) {
  for (const DriveResult& drive : drives) {
    if (metrics_of(drive, kDefaultModel)) return true;
  }
  return false;
}

}  // namespace

std::vector<Finding> findings(const Drives& drives) {
  Drives with_truth;
  for (const DriveResult& drive : drives) {
    if (metrics_of(drive, "gnss")) with_truth.push_back(drive);
  }
  if (with_truth.empty()) return {};
  const Drives printed = drives_of_paper();
  const Sources sources{{"paper", printed, ""},
                        {"literal", with_truth, "paper_"},
                        {"minimum", with_truth, "paper_", "/minimum"},
                        {"ours", with_truth, "ours_"}};
  std::vector<Finding> found = {average_improves(sources, "Max", &PaperMetrics::max_m),
                                average_improves(sources, "Prec", &PaperMetrics::precision_m),
                                accuracy_stays(sources),
                                mixed_by_drive(sources),
                                rejection_helps_on_average(sources),
                                rejection_is_mixed(sources),
                                convergence(drives)};
  if (has_default_model(with_truth)) {
    found.push_back(default_model_gains(with_truth));
    found.push_back(default_model_is_consistent(with_truth));
  }
  return found;
}

std::string findings_text(const std::vector<Finding>& findings) {
  std::string text;
  int number = 0;
  for (const Finding& finding : findings) {
    text += fmt::format("{}. {}.\n", ++number, finding.statement);
    for (const Evidence& evidence : finding.evidence) {
      const char* verdict = !evidence.holds ? "" : *evidence.holds ? " (holds)" : " (does not hold)";
      text += fmt::format("   - {}{}: {}\n", evidence.source, verdict, evidence.figures);
    }
  }
  return text;
}

}  // namespace waymark::reproduction
