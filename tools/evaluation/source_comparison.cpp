#include <waymark/tools/evaluation/source_comparison.hpp>

#include <waymark/tools/text/number_text.hpp>

namespace waymark::evaluation {

text::Table source_table(const SourceComparison& comparison, const std::string& label) {
  text::Table table{.columns = {"sources", "readings", "available [%]", "raw RMSE [m]", "residual [m]",
                                "share [%]", "RMSE without [m]", "sigma without [m]", "apart without [m]"}};
  const auto metres = [](double value) { return text::decimals(value, 3); };
  const auto percent = [](double share) { return text::decimals(100 * share, 2); };
  const std::string prefix = label.empty() ? "" : label + ", ";
  for (const SourceReport& source : comparison.sources)
    table.rows.push_back({prefix + source.name, std::to_string(source.readings), percent(source.availability),
                          metres(source.raw_rmse_m), metres(source.residual_rms_m), percent(source.share),
                          metres(source.without_rmse_m), metres(source.without_sigma_m),
                          metres(source.without_residual_rms_m)});
  table.rows.push_back(
      {prefix + "all", "-", "-", "-", "-", "-", metres(comparison.rmse_m), metres(comparison.sigma_m), "-"});
  return table;
}

}  // namespace waymark::evaluation
