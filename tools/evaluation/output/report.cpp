#include <waymark/tools/evaluation/output/report.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/text/text_table.hpp>

namespace waymark::evaluation {
namespace {

using Row = std::vector<std::string>;

std::string number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}
std::string metres(double value) {
  return number(value, 3);
}
std::string degrees(double value_rad) {
  return number(value_rad * 180 / std::numbers::pi, 3);
}
std::string percent(double value) {
  return number(value, 2);
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
void add_improvement(text::TextTable& table, const std::string& label, const Improvement& i) {
  const std::array values = {i.max_percent,    i.accuracy_percent, i.precision_percent, i.rmse_percent,
                             i.median_percent, i.cep50_percent,    i.cep95_percent};
  Row row{label};
  for (const double value : values) row.push_back(percent(value));
  table.add(std::move(row));
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (values[c] > 0) table.paint(c + 1, text::Tone::better);
    if (values[c] < 0) table.paint(c + 1, text::Tone::worse);
  }
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

/// Adds the raw row of the first evaluation, and of every further one with other numbers.
template <typename MakeRow>
void add_raw_rows(text::TextTable& table, std::span<const LabelledEvaluation> evaluations,
                  const std::string& name, const MakeRow& make_row) {
  bool any = false;
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth) continue;
    const std::string row_label = any ? name + " (" + label + ")" : name;
    table.add_unless_known(make_row(row_label, *evaluation.truth));
    any = true;
  }
}

std::string truth_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::TextTable table(position_heading("against truth"));
  text::TextTable better({"improvement over raw gnss", "Max [%]", "Acc [%]", "Prec [%]", "RMSE [%]",
                          "median [%]", "CEP50 [%]", "CEP95 [%]"});
  add_raw_rows(table, evaluations, "raw gnss", [](const std::string& label, const TruthEvaluation& t) {
    return position_row(label, t.gnss.position);
  });
  add_raw_rows(table, evaluations, "raw gnss, accepted",
               [](const std::string& label, const TruthEvaluation& t) {
                 return position_row(label, t.gnss_accepted.position);
               });
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth) continue;
    table.add(position_row(label, evaluation.truth->fused.position));
    add_improvement(better, label, evaluation.truth->improvement);
  }
  return table.empty() ? "" : table.text(look) + "\n" + better.text(look) + "\n";
}

std::string track_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::TextTable table({"along / across track", "n", "along mean [m]", "along std [m]", "along rms [m]",
                         "across mean [m]", "across std [m]", "across rms [m]", "heading rms [deg]",
                         "heading max [deg]"});
  add_raw_rows(table, evaluations, "raw gnss",
               [](const std::string& label, const TruthEvaluation& t) { return track_row(label, t.gnss); });
  for (const auto& [label, evaluation] : evaluations)
    if (evaluation.truth) table.add(track_row(label, evaluation.truth->fused));
  return table.empty() ? "" : table.text(look) + "\n";
}

std::string interval(const Interval95& i, double factor, int decimals) {
  return number(factor * i.low, decimals) + " - " + number(factor * i.high, decimals);
}

std::string consistency_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::TextTable table({"stated against actual error", "n", "effective n", "NEES mean", "honest",
                         "inside 95 % [%]", "honest [%]", "actual / stated"});
  for (const auto& [label, evaluation] : evaluations) {
    if (!evaluation.truth || !evaluation.truth->consistency) continue;
    const ConsistencyStatistics& s = *evaluation.truth->consistency;
    table.add({label, std::to_string(s.count), number(s.effective_samples, 1), number(s.nees_mean, 2),
               interval(s.nees_mean_honest, 1, 2), number(100 * s.coverage, 1),
               interval(s.coverage_honest, 100, 1), number(s.median_error_ratio, 2)});
  }
  return table.empty() ? "" : table.text(look) + "\n";
}

std::string autocorrelation_block(std::span<const LabelledEvaluation> evaluations,
                                  const text::TextLook& look) {
  Row heading{"error autocorrelation"};
  for (const double lag_s : kAutocorrelationLags) heading.push_back(fmt::format("{} s", lag_s));
  text::TextTable table(std::move(heading));
  const auto row = [](const std::string& label, std::span<const double> correlations) {
    Row cells{label};
    for (const double correlation : correlations) cells.push_back(number(correlation, 2));
    return cells;
  };
  add_raw_rows(table, evaluations, "raw gnss", [&](const std::string& label, const TruthEvaluation& t) {
    return row(label, t.gnss_autocorrelation);
  });
  for (const auto& [label, evaluation] : evaluations)
    if (evaluation.truth) table.add(row(label, evaluation.truth->fused_autocorrelation));
  return table.empty() ? "" : table.text(look) + "\n";
}

/// Adds rows of the fused poses ("g1") and of each prediction ("g1, dead reckoning").
std::string withheld_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  Row heading = position_heading("against withheld fixes");
  heading.push_back("inside 95 % [%]");
  text::TextTable table(std::move(heading));
  text::TextTable ends(position_heading("at the end of each outage"));
  for (const auto& [label, evaluation] : evaluations) {
    for (const WithheldMetrics& w : evaluation.at_withheld) {
      const bool fused = &w == &evaluation.at_withheld.front();
      const std::string row_label = fused ? label : label + ", " + w.label;
      Row row = position_row(row_label, w.at_fixes);
      row.push_back(percent(100 * w.innovation.fraction_inside));
      table.add(std::move(row));
      if (evaluation.outages > 0) ends.add(position_row(row_label, w.at_ends));
    }
  }
  if (table.empty()) return "";
  return table.text(look) + "\n" + (ends.empty() ? "" : ends.text(look) + "\n");
}

void add_innovations(text::TextTable& table, const std::string& label, const InnovationStatistics& s) {
  if (s.count + s.undefined == 0) return;
  table.add({label + ", " + to_string(s.kind), std::to_string(s.count), number(s.mean, 3), "2",
             percent(100 * s.fraction_inside), "95", number(s.max, 1), std::to_string(s.undefined)});
}

std::string innovation_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::TextTable table({"normalised innovation squared", "n", "mean", "expected", "inside 5.991 [%]",
                         "expected [%]", "max", "undefined"});
  for (const auto& [label, evaluation] : evaluations) {
    add_innovations(table, label, evaluation.post_fit);
    add_innovations(table, label, evaluation.gated);
    add_innovations(table, label, evaluation.prediction);
  }
  return table.empty() ? "" : table.text(look) + "\n";
}

std::string count_block(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  text::TextTable table(
      {"epochs", "fixes", "accepted", "rejected", "withheld", "rejected [%]", "matched", "unmatched"});
  for (const auto& [label, e] : evaluations) {
    const double share =
        e.fixes() == 0 ? kUndefined
                       : 100 * static_cast<double>(e.rejected) / static_cast<double>(e.accepted + e.rejected);
    table.add({label, std::to_string(e.fixes()), std::to_string(e.accepted), std::to_string(e.rejected),
               std::to_string(e.withheld), percent(share),
               e.truth ? std::to_string(e.truth->match.matched) : "-",
               e.truth ? std::to_string(e.truth->match.unmatched()) : "-"});
  }
  return table.empty() ? "" : table.text(look);
}

}  // namespace

std::string metrics_table(std::span<const LabelledEvaluation> evaluations, const text::TextLook& look) {
  return truth_block(evaluations, look) + track_block(evaluations, look) +
         consistency_block(evaluations, look) + autocorrelation_block(evaluations, look) +
         withheld_block(evaluations, look) + innovation_block(evaluations, look) +
         count_block(evaluations, look);
}

}  // namespace waymark::evaluation
