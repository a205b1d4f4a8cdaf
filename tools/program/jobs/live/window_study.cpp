#include <waymark/tools/program/jobs/live/window_study.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/live/session/lag_study.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {
namespace {

text::Table table_of(const std::vector<live::LagResult>& results, const std::string& modeling) {
  text::Table table{.title = "live, " + modeling,
                    .columns = {"window [s]", "poses", "RMSE [m]", "Max [m]", "inside 95 % [%]", "NEES",
                                "RMSE at the lag [m]", "Max at the lag [m]", "cycle [us]"}};
  const bool in_space = std::any_of(results.begin(), results.end(), [](const live::LagResult& result) {
    return std::isfinite(result.live.rmse_3d_m);
  });
  if (in_space) table.columns.emplace_back("3-D RMSE [m]");
  for (const live::LagResult& result : results) {
    table.rows.push_back(
        {fmt::format("{}", result.window_s), fmt::format("{}", result.live.poses),
         fmt::format("{:.3f}", result.live.rmse_m), fmt::format("{:.2f}", result.live.max_m),
         fmt::format("{:.1f}", 100 * result.live.inside95), fmt::format("{:.2f}", result.live.nees),
         fmt::format("{:.3f}", result.settled.rmse_m), fmt::format("{:.2f}", result.settled.max_m),
         fmt::format("{:.0f}", result.cycle_us)});
    if (in_space) table.rows.back().push_back(fmt::format("{:.3f}", result.live.rmse_3d_m));
  }
  table.notes.push_back(
      "poses as they were said while driving, at the rate of the odometry, and when they left the window");
  return table;
}

std::string csv_of(const std::vector<live::LagResult>& results) {
  std::string csv =
      "window_s,poses,rmse_m,max_m,inside95,nees,settled_rmse_m,settled_max_m,cycle_us,rmse_3d_m\n";
  for (const live::LagResult& result : results)
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", result.window_s, result.live.poses,
                       result.live.rmse_m, result.live.max_m, result.live.inside95, result.live.nees,
                       result.settled.rmse_m, result.settled.max_m, result.cycle_us,
                       std::isfinite(result.live.rmse_3d_m) ? fmt::format("{}", result.live.rmse_3d_m) : "");
  return csv;
}

/// Loss of accuracy and consistency over the length of the window.
drawing::Section lag_section(std::span<const live::LagResult> results, double whole_rmse_m) {
  drawing::Section section{"windows", "Live, by the length of the window", {}};
  drawing::Figure accuracy{.id = "window-accuracy",
                           .title = "Accuracy over the window",
                           .description =
                               "RMSE of poses as they were said while driving, and as they were when "
                               "they left the window, beside the run of the whole drive.",
                           .x = {"window", "s", true},
                           .y = {"RMSE", "m"},
                           .series = {}};
  accuracy.y.low = 0;
  drawing::Figure consistency{.id = "window-consistency",
                              .title = "Consistency over the window",
                              .description =
                                  "Share of the poses, as they were said while driving, whose truth is "
                                  "inside their region of 95 %.",
                              .x = {"window", "s", true},
                              .y = {"inside 95 %", "%"},
                              .series = {}};
  drawing::Series live{.name = "at once", .look = drawing::Look::first};
  drawing::Series settled{.name = "at the lag", .look = drawing::Look::second};
  drawing::Series whole{.name = "whole drive", .look = drawing::Look::reference};
  drawing::Series inside{.name = "at once", .look = drawing::Look::first};
  drawing::Series wanted{.name = "95 %", .look = drawing::Look::reference};
  for (const live::LagResult& result : results) {
    for (drawing::Series* series : {&live, &settled, &whole, &inside, &wanted})
      series->x.push_back(result.window_s);
    live.y.push_back(result.live.rmse_m);
    settled.y.push_back(result.settled.rmse_m);
    whole.y.push_back(whole_rmse_m);
    inside.y.push_back(100 * result.live.inside95);
    wanted.y.push_back(95);
  }
  accuracy.series = {std::move(live), std::move(settled)};
  if (std::isfinite(whole_rmse_m)) accuracy.series.push_back(std::move(whole));
  consistency.series = {std::move(inside), std::move(wanted)};
  section.blocks.emplace_back(std::move(accuracy));
  section.blocks.emplace_back(std::move(consistency));
  return section;
}

}  // namespace

WindowStudy study_windows(const WindowStudyInput& input, const TypeRegistry& registry,
                          const Console& console) {
  const std::string& modeling = input.settings.modeling;
  const std::vector<live::LagResult> results = live::study_lags(
      input.file, input.settings, input.drive, input.windows_s, registry, [&](double window_s) {
        stop_if_interrupted();
        console.progress(fmt::format("{}: live, window of {} s", modeling, window_s));
      });
  console.end_progress();
  formats::write_file_atomically(input.folder + "/" + modeling + ".windows.csv", csv_of(results));
  return {text::table_text(table_of(results, modeling), console.look()),
          lag_section(results, input.whole_rmse_m)};
}

}  // namespace waymark::program
