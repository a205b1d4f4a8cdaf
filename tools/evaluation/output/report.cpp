#include <waymark/tools/evaluation/output/report.hpp>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/text/number_text.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::evaluation {
namespace {

using text::Row;

std::string metres(double value) {
  return text::decimals(value, 3);
}
std::string degrees(double value_rad) {
  return text::decimals(value_rad * 180 / std::numbers::pi, 3);
}
std::string percent(double value) {
  return text::decimals(value, 2);
}

Row position_row(const std::string& label, const PositionMetrics& m) {
  return {label,
          std::to_string(m.count),
          metres(m.max_m),
          metres(m.accuracy_m),
          metres(m.precision_m),
          metres(m.rmse_m),
          metres(m.median_m),
          metres(m.cep50_m),
          metres(m.cep95_m)};
}

/// Adds improvements; better numbers are green, worse ones red.
void add_improvement(text::Table& table, const std::string& label, const Improvement& i) {
  const std::array values = {i.max_percent,    i.accuracy_percent, i.precision_percent, i.rmse_percent,
                             i.median_percent, i.cep50_percent,    i.cep95_percent};
  Row row{label};
  for (const double value : values) {
    const std::pair place(table.rows.size(), row.size());
    if (value > 0) table.tones[place] = text::Tone::better;
    if (value < 0) table.tones[place] = text::Tone::worse;
    row.push_back(percent(value));
  }
  table.rows.push_back(std::move(row));
}

Row track_row(const std::string& label, const SystemMetrics& m) {
  return {label,
          std::to_string(m.track.along.count),
          metres(m.track.along.mean),
          metres(m.track.along.deviation),
          metres(m.track.along.rms),
          metres(m.track.cross.mean),
          metres(m.track.cross.deviation),
          metres(m.track.cross.rms),
          degrees(m.heading.rms),
          degrees(m.heading.max_abs)};
}

Row position_heading(std::string title) {
  return {std::move(title), "n",          "Max [m]",   "Acc [m]",  "Prec [m]",
          "RMSE [m]",       "median [m]", "CEP50 [m]", "CEP95 [m]"};
}

/// Returns a table with an empty line behind it; nothing if it has no rows.
std::string block(const text::Table& table, const text::TextLook& look) {
  return table.rows.empty() ? "" : text::table_text(table, look) + "\n";
}

/// Adds the raw row of the first evaluation, and of every further one with other numbers.
template <typename MakeRow>
void add_raw_rows(text::Table& table, std::span<const LabelledEvaluation> evaluations,
                  const std::string& name, const MakeRow& make_row) {
  bool any = false;
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth || evaluation.fixes() == 0) continue;
    Row row = make_row(any ? name + " (" + label + ")" : name, *evaluation.truth);
    const bool known = std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& other) {
      return std::equal(row.begin() + 1, row.end(), other.begin() + 1, other.end());
    });
    if (!known) table.rows.push_back(std::move(row));
    any = true;
  }
}

std::string truth_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = position_heading("against truth")};
  text::Table better{.columns = {"improvement over raw gnss", "Max [%]", "Acc [%]", "Prec [%]", "RMSE [%]",
                                 "median [%]", "CEP50 [%]", "CEP95 [%]"}};
  add_raw_rows(table, evaluations, "raw gnss", [](const std::string& label, const TruthEvaluation& t) {
    return position_row(label, t.gnss.position);
  });
  add_raw_rows(table, evaluations, "raw gnss, accepted",
               [](const std::string& label, const TruthEvaluation& t) {
                 return position_row(label, t.gnss_accepted.position);
               });
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth) continue;
    table.rows.push_back(position_row(label, evaluation.truth->fused.position));
    if (evaluation.fixes() > 0) add_improvement(better, label, evaluation.truth->improvement);
  }
  return block(table, look) + block(better, look);
}

/// Says how good the height is, and the position in space, for results with a height.
std::string space_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table;
  for (const auto& [label, evaluation] : evaluations)
    if (evaluation.truth) add_space_row(label, *evaluation.truth, table);
  return table.columns.empty() && table.notes.empty() ? "" : text::table_text(table, look) + "\n";
}

std::string track_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = {"along / across track", "n", "along mean [m]", "along std [m]",
                                "along rms [m]", "across mean [m]", "across std [m]", "across rms [m]",
                                "heading rms [deg]", "heading max [deg]"}};
  add_raw_rows(table, evaluations, "raw gnss",
               [](const std::string& label, const TruthEvaluation& t) { return track_row(label, t.gnss); });
  for (const auto& [label, evaluation] : evaluations)
    if (evaluation.truth) table.rows.push_back(track_row(label, evaluation.truth->fused));
  return block(table, look);
}

std::string interval(const Interval95& i, double factor, int decimals) {
  return text::decimals(factor * i.low, decimals) + " - " + text::decimals(factor * i.high, decimals);
}

std::string consistency_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = {"stated against actual error", "n", "effective n", "NEES mean", "consistent",
                                "inside 95 % [%]", "consistent [%]", "actual / stated"}};
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth || !evaluation.truth->consistency) continue;
    const ConsistencyStatistics& s = *evaluation.truth->consistency;
    table.rows.push_back({label, std::to_string(s.count), text::decimals(s.effective_samples, 1),
                          text::decimals(s.nees_mean, 2), interval(s.nees_mean_consistent, 1, 2),
                          text::decimals(100 * s.coverage, 1), interval(s.coverage_consistent, 100, 1),
                          text::decimals(s.median_error_ratio, 2)});
  }
  return block(table, look);
}

std::string autocorrelation_block(std::span<const LabelledEvaluation> evaluations,
                                  const text::TextLook& look) {
  Row heading{"error autocorrelation"};
  for (const double lag_s : kAutocorrelationLags) heading.push_back(fmt::format("{} s", lag_s));
  text::Table table{.columns = std::move(heading)};
  const auto row = [](const std::string& label, std::span<const double> correlations) {
    Row cells{label};
    for (const double correlation : correlations) cells.push_back(text::decimals(correlation, 2));
    return cells;
  };
  add_raw_rows(table, evaluations, "raw gnss", [&](const std::string& label, const TruthEvaluation& t) {
    return row(label, t.gnss_autocorrelation);
  });
  for (const auto& [label, evaluation] : evaluations)
    if (evaluation.truth) table.rows.push_back(row(label, evaluation.truth->fused_autocorrelation));
  return block(table, look);
}

/// Adds rows of the fused poses ("g1") and of each prediction ("g1, dead reckoning").
std::string withheld_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  Row heading = position_heading("against withheld fixes");
  heading.push_back("inside 95 % [%]");
  text::Table table{.columns = std::move(heading)};
  text::Table ends{.columns = position_heading("at the end of each outage")};
  for (const auto& [label, evaluation] : evaluations) {
    for (const WithheldMetrics& w : evaluation.at_withheld) {
      const bool fused = &w == &evaluation.at_withheld.front();
      const std::string row_label = fused ? label : label + ", " + w.label;
      Row row = position_row(row_label, w.at_fixes);
      row.push_back(percent(100 * w.innovation.fraction_inside));
      table.rows.push_back(std::move(row));
      if (evaluation.outages > 0) ends.rows.push_back(position_row(row_label, w.at_ends));
    }
  }
  return block(table, look) + block(ends, look);
}

/// Only innovations are chi2 distributed. Post-fit residuals of a modeling with correlated errors have no
/// nu at all, and those of the others are too small.
void add_innovations(text::Table& table, const std::string& label, const InnovationStatistics& s) {
  if (s.count == 0) return;
  const bool is_expected = s.has_expectation();
  table.rows.push_back({label + ", " + to_string(s.kind), std::to_string(s.count), text::decimals(s.mean, 3),
                        is_expected ? "2" : "-", percent(100 * s.fraction_inside), is_expected ? "95" : "-",
                        text::decimals(s.max, 1), std::to_string(s.undefined)});
}

std::string innovation_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = {"normalised innovation squared", "n", "mean", "expected", "inside 5.991 [%]",
                                "expected [%]", "max", "undefined"}};
  for (const auto& [label, evaluation] : evaluations) {
    add_innovations(table, label, evaluation.post_fit);
    add_innovations(table, label, evaluation.gated);
    add_innovations(table, label, evaluation.prediction);
  }
  return block(table, look);
}

std::string count_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = {"epochs", "fixes", "accepted", "rejected", "withheld", "rejected [%]",
                                "matched", "unmatched"}};
  for (const auto& [label, e] : evaluations) {
    if (e.fixes() == 0) continue;
    const double share = 100 * static_cast<double>(e.rejected) / static_cast<double>(e.accepted + e.rejected);
    table.rows.push_back({label, std::to_string(e.fixes()), std::to_string(e.accepted),
                          std::to_string(e.rejected), std::to_string(e.withheld), percent(share),
                          e.truth ? std::to_string(e.truth->match.matched) : "-",
                          e.truth ? std::to_string(e.truth->match.unmatched()) : "-"});
  }
  return table.rows.empty() ? "" : text::table_text(table, look);
}

/// Compares the sources of each evaluation.
std::string sources_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table;
  for (const auto& [label, evaluation] : evaluations) {
    if (evaluation.sources.sources.empty()) continue;
    text::Table part = source_table(evaluation.sources, label);
    table.columns = std::move(part.columns);
    table.rows.insert(table.rows.end(), part.rows.begin(), part.rows.end());
  }
  return block(table, look);
}

/// Says how well the measurements of each source fit.
std::string residuals_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  std::string text;
  for (const auto& [label, evaluation] : evaluations)
    text += block(source_residuals_table(evaluation.residuals, evaluations.size() > 1 ? label : ""), look);
  return text;
}

/// Says how well the measurements of each kind of group fit: of each satellite system.
std::string groups_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  std::string text;
  for (const auto& [label, evaluation] : evaluations)
    for (const GroupedResiduals& of : evaluation.groups)
      text += block(family_table(of, evaluations.size() > 1 ? label : ""), look);
  return text;
}

/// Counts the fixes of each quality, and compares raw with fused where there is a truth.
std::string quality_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::Table table{.columns = {"quality of the fixes", "fixes", "accepted", "matched", "raw median [m]",
                                "fused median [m]", "raw RMSE [m]", "fused RMSE [m]"}};
  for (const auto& [label, evaluation] : evaluations) {
    for (const QualityMetrics& m : evaluation.by_quality) {
      const std::string name(to_string(m.quality));
      table.rows.push_back({evaluations.size() > 1 ? label + ", " + name : name, std::to_string(m.fixes),
                            std::to_string(m.accepted), std::to_string(m.gnss.count), metres(m.gnss.median_m),
                            metres(m.fused.median_m), metres(m.gnss.rmse_m), metres(m.fused.rmse_m)});
    }
  }
  return block(table, look);
}

}  // namespace

void add_space_row(const std::string& label, const TruthEvaluation& truth, text::Table& table) {
  if (truth.space) {
    const SpaceMetrics& m = *truth.space;
    table.columns = {"against truth, in space", "n",           "height mean [m]", "height std [m]",
                     "height rms [m]",          "3-D Max [m]", "3-D Prec [m]",    "3-D RMSE [m]"};
    table.rows.push_back({label, std::to_string(m.height.count), metres(m.height.mean),
                          metres(m.height.deviation), metres(m.height.rms), metres(m.max_m),
                          metres(m.precision_m), metres(m.rmse_m)});
  } else if (truth.no_space == kNoTruthHeights && table.notes.empty()) {
    table.notes.push_back(
        "no errors in space: the truth has no heights; name their column under "
        "'truth: {columns: {height: ...}}'");
  }
}

std::string metrics_table(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  return truth_block(evaluations, look) + space_block(evaluations, look) + track_block(evaluations, look) +
         consistency_block(evaluations, look) + autocorrelation_block(evaluations, look) +
         withheld_block(evaluations, look) + quality_block(evaluations, look) +
         innovation_block(evaluations, look) + sources_block(evaluations, look) +
         residuals_block(evaluations, look) + groups_block(evaluations, look) +
         count_block(evaluations, look);
}

}  // namespace waymark::evaluation
