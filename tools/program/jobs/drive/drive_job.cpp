#include <waymark/tools/program/jobs/drive/drive_job.hpp>

#include <waymark/tools/drive/clocks/clock_check.hpp>
#include <waymark/tools/drive/clocks/synchronise.hpp>
#include <waymark/tools/drive/model/provenance.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

void tell(const drive::PrepareReport& report, const Console& console) {
  for (const std::string& note : report.notes) console.note(note);
  const std::string corrupt = drive::corrupt_warning(report);
  if (corrupt.empty()) return;
  console.warning(corrupt + "; the first ones:");
  for (const std::string& example : report.corrupt_examples) console.tell("  " + example);
}

/// Tells whether biased fixes may bend the speed scale. They can with squared errors; a complete
/// error model or a loss prevents it.
bool scale_is_bent(const drive::FusionSettings& settings, const TypeRegistry& registry) {
  const auto scale = settings.calibration->find("speed_scale");
  const bool calibrated = scale != settings.calibration->end() && scale->second != "off";
  return calibrated && (settings.loss.empty() || settings.loss == "none") &&
         !registry.gnss_modeling(settings.modeling).complete;
}

}  // namespace

LoadedDrive load_drive_for(const drive::DriveFile& file, const DriveChoice& choice,
                           const TypeRegistry& registry, const Console& console) {
  LoadedDrive loaded;
  loaded.settings = chosen_settings(file, choice, registry);
  drive::DriveDescription description = file.description;
  drive::resolve_sensors(description, registry);
  drive::DriveLogs logs = drive::read_drive_logs(description, registry, watch_reading(console));
  if (choice.sync) {
    console.progress("comparing clocks");
    drive::synchronise(logs, description);
  }
  loaded.drive = drive::prepare_on_one_clock(logs, description, drive::ClocksApart::move);
  tell(loaded.drive.report, console);
  for (const drive::InputFile& input : loaded.drive.inputs) loaded.files.push_back(input.path);
  loaded.files.push_back(description.path);
  loaded.path = description.path;
  console.end_progress();
  return loaded;
}

drive::ModeledDrive model_loaded(drive::Fusion& fusion, const drive::FusionSettings& settings,
                                 const TypeRegistry& registry, const Console& console,
                                 std::set<std::string>& told) {
  console.progress(settings.modeling + ": start and noise");
  drive::ModeledDrive modeled = fusion.model(settings);
  console.end_progress();
  for (const std::string& warning : modeled.warnings())
    if (told.insert(warning).second) console.warning(warning);
  if (const std::string& note = modeled.placed.start.note; !note.empty() && told.insert(note).second)
    console.note("start: " + note);
  for (const std::string& note : modeled.notes)
    if (told.insert(note).second) console.note(note);
  if (scale_is_bent(modeled.settings, registry))
    console.note("biased fixes distort speed_scale with this modeling; the modeling correlated avoids that");
  auto& provenance = modeled.document.provenance;
  provenance.insert(provenance.begin(), {"program", "waymark " WAYMARK_VERSION});
  return modeled;
}

}  // namespace waymark::program
