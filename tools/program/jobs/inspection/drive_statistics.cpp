#include <waymark/tools/program/jobs/inspection/drive_statistics.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/program/terminal/output.hpp>
#include <waymark/tools/simulation/statistics.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::program {
namespace {

std::string statistics_text(const std::string& name, const simulation::DriveStatistics& s) {
  std::string text = name + "\n";
  const auto line = [&text](const std::string& label, const std::string& value) {
    text += fmt::format("  {:<34} {}\n", label, value);
  };
  line("duration", text::decimals(s.duration_s, 2) + " s");
  line("distance", text::decimals(s.distance_m / 1000, 3) + " km");
  line("odometry points", std::to_string(s.odometry_points));
  line("fixes", fmt::format("{}, {} epochs missing", s.fixes, s.missing_epochs));
  line("raw fixes Max / Acc / Prec", text::decimals(s.gnss.max_m, 3) + " / " +
                                         text::decimals(s.gnss.accuracy_m, 3) + " / " +
                                         text::decimals(s.gnss.precision_m, 3) + " m");
  line("rejected by the gate", fmt::format("{} ({:.2f} %)", s.rejected, s.rejected_percent));
  for (std::size_t i = 0; i < s.autocorrelation.size(); ++i)
    line(fmt::format("autocorrelation of the error, {} s", evaluation::kAutocorrelationLags[i]),
         text::decimals(s.autocorrelation[i], 3));
  line("odometry drift over 1 km", text::decimals(s.drift_percent, 3) + " %");
  line("yaw drift", text::decimals(s.yaw_drift_deg_per_minute, 3) + " deg/min");
  return text;
}

nlohmann::ordered_json statistics_json(const std::string& name, const simulation::DriveStatistics& s) {
  nlohmann::ordered_json json = {{"name", name},
                                 {"duration_s", s.duration_s},
                                 {"distance_m", s.distance_m},
                                 {"odometry_points", s.odometry_points},
                                 {"fixes", s.fixes},
                                 {"missing_epochs", s.missing_epochs},
                                 {"gnss_max_m", s.gnss.max_m},
                                 {"gnss_accuracy_m", s.gnss.accuracy_m},
                                 {"gnss_precision_m", s.gnss.precision_m},
                                 {"rejected", s.rejected},
                                 {"rejected_percent", s.rejected_percent}};
  for (std::size_t i = 0; i < s.autocorrelation.size(); ++i)
    json[fmt::format("autocorrelation_{}s", evaluation::kAutocorrelationLags[i])] = s.autocorrelation[i];
  json["drift_percent"] = s.drift_percent;
  json["yaw_drift_deg_per_minute"] = s.yaw_drift_deg_per_minute;
  return json;
}

}  // namespace

void print_drive_statistics(const std::string& path, const CommonOptions& common, const Console& console) {
  const drive::DriveFile file = drive::load_drive_file(path);
  const TypeRegistry registry = make_registry(common, file.description.plugins);
  const drive::PreparedDrive drive = drive::load_drive(file.description, registry, watch_reading(console));
  console.end_progress();
  const simulation::DriveStatistics statistics = simulation::drive_statistics(drive, file.settings.gate);
  console.result(console.json() ? json_document("drive", statistics_json(drive.name, statistics))
                                : statistics_text(drive.name, statistics));
}

}  // namespace waymark::program
