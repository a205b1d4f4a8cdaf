#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/formats/trajectory/map_formats.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>
#include <waymark/tools/drive/logs/clock_sync.hpp>
#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/drive/model/sensors.hpp>
#include <waymark/tools/evaluation/output/epochs_csv.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/graph/robust.hpp>
#include <waymark/tools/program/jobs/hash.hpp>
#include <waymark/tools/program/jobs/pipeline.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::program {
namespace {

/// "60/240". @throws UsageError
drive::OutagePattern parse_outage(const std::string& text) {
  drive::OutagePattern outage;
  const char* last = text.data() + text.size();
  const auto [slash, first_error] = std::from_chars(text.data(), last, outage.length_s);
  const bool parted = first_error == std::errc() && slash != last && *slash == '/';
  const auto [end, second_error] = std::from_chars(parted ? slash + 1 : last, last, outage.every_s);
  if (!parted || second_error != std::errc() || end != last || !(outage.length_s > 0) ||
      !(outage.every_s > outage.length_s) || !std::isfinite(outage.every_s)) {
    throw UsageError("--outage: expected LENGTH/EVERY in seconds with 0 < LENGTH < EVERY, got '" + text +
                     "'");
  }
  return outage;
}

/// "on", "off", or NAME=VALUE pairs over what the drive.yaml says.
void apply_calibration(const std::vector<std::string>& words, drive::DriveConfig& config) {
  if (!words.empty()) config.calibration_stated = true;
  for (const std::string& word : words) {
    if (word == "on") {
      config.calibration = drive::default_calibration();
    } else if (word == "off") {
      config.calibration.clear();
    } else {
      for (const auto& [name, value] : parse_options({word})) config.calibration[name] = value;
    }
  }
}

void apply(const DriveOverrides& overrides, drive::DriveConfig& config) {
  if (overrides.from_s) config.from_s = overrides.from_s;
  if (overrides.to_s) config.to_s = overrides.to_s;
  if ((overrides.from_s || overrides.to_s) && config.from_s && config.to_s &&
      *config.from_s >= *config.to_s) {
    throw UsageError(
        fmt::format("--from {} and --to {} leave nothing between them", *config.from_s, *config.to_s));
  }
  if (!overrides.outage.empty()) config.outage = parse_outage(overrides.outage);
  if (overrides.withhold_every) config.withhold_every = *overrides.withhold_every;
  if (overrides.no_gate) {
    config.gate.enabled = false;
    config.gate_stated = true;
  }
  if (overrides.noise) config.estimates_noise = *overrides.noise == "estimate";
  if (overrides.start == "dead_reckoning") config.start.method = drive::StartMethod::dead_reckoning;
  if (overrides.start == "anchored") config.start.method = drive::StartMethod::anchored;
  apply_calibration(overrides.calibrate, config);
  if (overrides.loss) config.loss = *overrides.loss;
}

/// The loss of the fixes as the drive.yaml or the command line names it.
std::optional<Loss> loss_of_fixes(const drive::DriveConfig& config, bool overridden,
                                  const TypeRegistry& registry) {
  if (config.loss.empty() || config.loss == "none") return std::nullopt;
  const auto place = config.places.find("modeling.loss");
  if (overridden || place == config.places.end()) return named_loss(config.loss, "--gnss-loss", registry);
  try {
    return named_loss(config.loss, "modeling.loss", registry);
  } catch (const UsageError& error) {
    throw InputError(place->second + error.what());
  }
}

/// @throws UsageError for an option that no chosen modeling has
void check_options_are_used(const std::vector<std::string>& modelings, const DriveOverrides& overrides,
                            const TypeRegistry& registry) {
  for (const auto& entry : parse_options(overrides.modeling_options)) {
    const auto has = [&](const std::string& modeling) {
      return has_option(registry.gnss_modeling(modeling).options, entry.first);
    };
    if (std::any_of(modelings.begin(), modelings.end(), has)) continue;
    // Its own message names the options that exist.
    (void)registry.make_gnss_modeling(modelings.front(), {{entry.first, entry.second}});
  }
}

std::vector<std::string> chosen_modelings(const DriveOverrides& overrides, const drive::DriveConfig& config,
                                          const TypeRegistry& registry) {
  std::vector<std::string> names;
  for (const std::string& name : overrides.modelings) {
    if (name != "all") {
      names.push_back(name);
      continue;
    }
    for (const auto& entry : registry.gnss_modelings()) names.push_back(entry.type.name);
  }
  if (names.empty()) names.push_back(config.modeling);
  std::vector<std::string> once;
  for (const std::string& name : names) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  for (const std::string& name : once) {  // what is wrong with them shows before the work
    (void)registry.make_gnss_modeling(name, drive::options_for(registry.gnss_modeling(name), config,
                                                               known_options(name, overrides, registry)));
  }
  check_options_are_used(once, overrides, registry);
  return once;
}

void tell(const drive::PrepareReport& report, const Console& console) {
  for (const std::string& note : report.notes) console.note(note);
  const std::size_t corrupt =
      report.odometry.corrupt + report.gnss.corrupt + report.truth.corrupt + report.sensor.corrupt;
  if (corrupt > 0) {
    console.warning(fmt::format("{} corrupt records were left out; the first ones:", corrupt));
    for (const std::string& example : report.corrupt_examples) console.tell("  " + example);
  }
}

std::vector<const drive::LogConfig*> logs_of(const drive::DriveConfig& config) {
  std::vector<const drive::LogConfig*> logs;
  for (const drive::LogConfig& log : config.odometry) logs.push_back(&log);
  for (const drive::GnssConfig& log : config.gnss) {
    logs.push_back(&log);
    if (log.velocity) logs.push_back(&*log.velocity);
  }
  if (config.truth) logs.push_back(&*config.truth);
  for (const drive::SensorConfig& sensor : config.sensors) {
    if (sensor.log) logs.push_back(&*sensor.log);
  }
  return logs;
}

/// The way that the odometry says was driven.
double distance_by(const std::vector<OdometrySample>& odometry) {
  double distance = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    distance += 0.5 * (std::abs(odometry[i].speed_mps) + std::abs(odometry[i - 1].speed_mps)) *
                seconds_between(odometry[i - 1].stamp, odometry[i].stamp);
  }
  return distance;
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

/// Name and hash of a log's content; compressed or not is the same.
std::string fingerprint(const std::string& path) {
  Fnv1a64 hash;
  (void)formats::read_in_pieces(path, [&](std::string_view piece) { hash.add(piece); });
  return file_name(path) + " fnv1a64:" + hash.hex();
}

/// An offset within this many of its sigmas is none.
constexpr double kOffsetSigmas = 3;

/// Adds an offset to a delay where it is one; what was done is noted either way.
bool apply_offset(const std::optional<drive::ClockOffset>& offset, const char* quantity, double& delay_s,
                  std::vector<std::string>& notes) {
  if (!offset) {
    notes.push_back(fmt::format("sync: no offset of the {} was found; it stays as it is", quantity));
    return false;
  }
  const bool is_one = std::abs(offset->late_s) > kOffsetSigmas * offset->sigma_s;
  if (is_one) delay_s += offset->late_s;
  notes.push_back(
      fmt::format("sync: the odometry's {} {} late by {:.3f} s (sigma {:.3f} s, correlation {:.4f}); {}",
                  quantity, is_one ? "was" : "seems", offset->late_s, offset->sigma_s, offset->correlation,
                  is_one ? "applied" : "within three sigmas, so not applied"));
  return is_one;
}

/// Prepares the drive again with the fixes on GNSS time, where their log tells it, and the odometry moved by
/// the offsets that its motion shows.
void synchronise(drive::DriveLogs& logs, LoadedDrive& loaded, const Console& console) {
  console.progress("comparing clocks");
  std::vector<std::string> notes = drive::put_on_told_time(logs);
  if (!notes.empty()) loaded.drive = drive::prepare_drive(logs, loaded.config);
  const drive::SyncReport report = drive::estimate_clock_offsets(loaded.drive, {});
  const bool speed_moved = apply_offset(report.speed, "speed", loaded.config.speed_delay_s, notes);
  (void)apply_offset(report.yaw_rate, "yaw rate", loaded.config.yaw_rate_delay_s, notes);
  // One log has one clock: half of it must not be moved alone.
  if (loaded.config.odometry.size() == 1 && speed_moved && !report.yaw_rate) {
    loaded.config.yaw_rate_delay_s += report.speed->late_s;
    notes.emplace_back("sync: the yaw rate stands in the log of the speed and is moved with it");
  }
  loaded.drive = drive::prepare_drive(logs, loaded.config);
  loaded.drive.report.notes.insert(loaded.drive.report.notes.end(), notes.begin(), notes.end());
}

}  // namespace

LoadedDrive load_drive_for(const std::string& path, const DriveOverrides& overrides,
                           const TypeRegistry& registry, const Console& console) {
  LoadedDrive loaded;
  loaded.config = drive::load_drive_config(path, overrides.data_folder);
  apply(overrides, loaded.config);
  loaded.modelings = chosen_modelings(overrides, loaded.config, registry);
  drive::check_calibration(loaded.config, loaded.modelings, registry);
  loaded.loss = loss_of_fixes(loaded.config, overrides.loss.has_value(), registry);
  drive::resolve_sensors(loaded.config, registry);
  drive::DriveLogs logs = drive::read_drive_logs(loaded.config, registry, watch_reading(console));
  loaded.drive = drive::prepare_drive(logs, loaded.config);
  if (overrides.sync) synchronise(logs, loaded, console);
  if (!loaded.config.time_scale_stated) {
    loaded.drive.report.notes.push_back("time scale gps is assumed; state time: {scale: gps | utc | unix}");
  }
  tell(loaded.drive.report, console);
  for (const drive::LogConfig* log : logs_of(loaded.config)) {
    loaded.files.push_back(log->file);
    for (const auto& [key, file] : log->companions) loaded.files.push_back(file);
  }
  for (const std::string& file : loaded.files) loaded.inputs.push_back(fingerprint(file));
  loaded.files.push_back(path);
  console.end_progress();
  return loaded;
}

drive::ModeledDrive model_loaded(const LoadedDrive& loaded, const std::string& modeling,
                                 const Options& options, const TypeRegistry& registry,
                                 const Console& console) {
  console.progress(modeling + ": start and noise");
  drive::ModeledDrive modeled =
      drive::model_drive(loaded.drive, loaded.config, modeling, options, registry, loaded.loss);
  console.end_progress();
  for (const std::string& warning : modeled.warnings) console.warning(warning);
  if (!modeled.start.note.empty()) console.note("start: " + modeled.start.note);
  const drive::DriveConfig& config = modeled.config;
  const auto scale = config.calibration.find("speed_scale");
  const bool calibrates_scale = scale != config.calibration.end() && scale->second != "off";
  if (calibrates_scale && !loaded.loss && !registry.gnss_modeling(modeling).complete) {
    console.note(
        "squared errors let biased fixes bend speed_scale; a robust loss protects it: --gnss-loss cauchy:1");
  }
  formats::GraphDocument& document = modeled.document;
  document.provenance = {{"program", "waymark " WAYMARK_VERSION}, {"drive", loaded.config.name}};
  for (const std::string& input : loaded.inputs) document.provenance.emplace_back("input", input);
  document.provenance.emplace_back("modeling", modeling);
  for (const auto& [name, value] : modeled.options)
    document.provenance.emplace_back("modeling_option", name + "=" + value);
  if (loaded.loss) document.provenance.emplace_back("loss", loaded.config.loss);
  for (const drive::NoiseParameter& parameter : modeled.noise.parameters)
    document.provenance.emplace_back(
        "noise", parameter.owner + " " + parameter.option + "=" + shortest(parameter.value) + " estimated");
  for (const auto& [name, value] : config.calibration)
    document.provenance.emplace_back("calibration", name + "=" + value);
  for (const drive::SensorConfig& sensor : loaded.config.sensors)
    document.provenance.emplace_back("sensor", sensor.name);
  for (const PluginRecord& plugin : registry.plugins()) {
    if (plugin.place != "built in")
      document.provenance.emplace_back("plugin", plugin.name + " " + plugin.version);
  }
  const drive::GateOptions& gate = config.gate;
  document.provenance.emplace_back(
      "gate", gate.enabled ? fmt::format("angle {:.6g} deg displacement {:.6g} m",
                                         gate.max_angle_rad * 180 / std::numbers::pi, gate.max_displacement_m)
                           : "off");
  document.provenance.emplace_back(
      "start", loaded.config.start.method == drive::StartMethod::anchored ? "anchored" : "dead_reckoning");
  for (const std::string& note : loaded.drive.report.notes) document.provenance.emplace_back("assumed", note);
  for (const std::string& warning : modeled.warnings) document.provenance.emplace_back("warning", warning);
  return modeled;
}

Options known_options(const std::string& modeling, const DriveOverrides& overrides,
                      const TypeRegistry& registry) {
  Options known;
  for (const auto& [name, value] : parse_options(overrides.modeling_options)) {
    if (has_option(registry.gnss_modeling(modeling).options, name)) known[name] = value;
  }
  return known;
}

void add_provenance(const formats::GraphDocument& document, const std::string& label,
                    evaluation::ReportHeader& header) {
  for (const auto& [key, text] : document.provenance) {
    if (key == "drive" && header.drive.empty()) header.drive = text;
    std::string name = label + "." + key;
    for (int n = 2; header.provenance.contains(name); ++n) name = label + "." + key + "." + std::to_string(n);
    header.provenance[name] = text;
  }
}

std::string left_out(const LoadedDrive& loaded) {
  const drive::PrepareReport& report = loaded.drive.report;
  return fmt::format("{} fixes outside the odometry, {} by thinning, {} withheld",
                     report.fixes_outside_odometry, report.fixes_thinned, report.fixes_withheld);
}

std::string odometry_in_words(const LoadedDrive& loaded) {
  return fmt::format("{:.0f} m in {} samples", distance_by(loaded.drive.odometry),
                     loaded.drive.odometry.size());
}

std::string describe_drive(const LoadedDrive& loaded) {
  std::string text;
  const auto& odometry = loaded.drive.odometry;
  text += fmt::format("drive       {}: {:.0f} s, {:.0f} m by odometry, {} odometry samples, {} fixes\n",
                      loaded.config.name, seconds_between(odometry.front().stamp, odometry.back().stamp),
                      distance_by(odometry), odometry.size(), loaded.drive.fixes.size());
  text += "left out    " + left_out(loaded) + "\n";
  return text;
}

evaluation::Prediction as_prediction(std::string label, drive::PosesAtWithheld at) {
  return {.label = std::move(label),
          .poses = std::move(at.poses),
          .position_covariances = std::move(at.position_covariances)};
}

evaluation::Evaluation evaluate_document(const formats::GraphDocument& document,
                                         const std::vector<TruthPose>& truth,
                                         const std::vector<evaluation::Prediction>& further) {
  evaluation::EvaluationInput input;
  input.fused = drive::poses_at_fixes(document);
  input.when_measured = drive::poses_when_measured(document);
  input.fixes = document.fixes;
  input.truth = truth;
  input.antenna_m = document.antenna_m;
  input.truth_reference_m = document.truth_reference_m;
  input.frame = document.frame.value_or(Frame());
  input.max_stamp_offset_s = drive::kLargestSnap;  // a fix may share the node of an odometry sample
  const auto covariances = drive::position_covariances_at_fixes(document);
  if (std::all_of(covariances.begin(), covariances.end(), [](const auto& c) { return c.has_value(); })) {
    for (const auto& covariance : covariances) input.position_covariances.push_back(*covariance);
  }
  input.predictions = {as_prediction("dead reckoning", drive::dead_reckoned_at_withheld(document))};
  for (const evaluation::Prediction& prediction : further) input.predictions.push_back(prediction);
  return evaluation::evaluate(input);
}

std::vector<TruthPose> read_truth(const std::string& path, const std::string& data_folder,
                                  const formats::GraphDocument& document, const TypeRegistry& registry) {
  if (drive::is_drive_file(path)) {
    drive::DriveConfig config = drive::load_drive_config(path, data_folder);
    if (!config.truth) throw InputError(path + ": has no 'truth' section");
    if (!document.frame || document.frame->zone == 0) {
      throw InputError("the graph has no UTM frame, so geodetic truth cannot be compared with it");
    }
    config.utm_zone = document.frame->north ? document.frame->zone : -document.frame->zone;
    config.utm_origin = {document.frame->origin_easting_m, document.frame->origin_northing_m};
    config.sensors.clear();  // nothing of them is needed
    return drive::load_drive(config, registry).truth;
  }
  std::vector<TruthPose> truth;
  for (const StampedPose& pose : formats::read_tum(formats::read_text_file(path), path)) {
    truth.push_back({pose.stamp, pose.pose.head<2>(), pose.pose[2]});
  }
  std::stable_sort(truth.begin(), truth.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  return truth;
}

std::vector<std::string> write_trajectories(const formats::GraphDocument& document, const std::string& prefix,
                                            const std::string& name) {
  const bool mapped = document.frame && document.frame->zone != 0;
  std::optional<drive::Projection> projection;
  if (mapped) projection.emplace(*document.frame);
  const Graph& graph = document.graph;
  std::vector<const Fix*> fix_of(graph.vertex_count(), nullptr);
  std::vector<formats::FixPoint> fix_points;
  for (const Fix& fix : document.fixes) {
    if (const auto v = graph.find(fix.vertex)) fix_of[static_cast<std::size_t>(*v)] = &fix;
    if (!mapped) continue;
    const drive::GeodeticPoint place = projection->to_geodetic(fix.position);
    fix_points.push_back({fix.stamp, place.latitude_deg, place.longitude_deg,
                          std::string(to_string(fix.status)), fix.reason, fix.source});
  }
  std::vector<const Eigen::MatrixXd*> covariance_of(graph.vertex_count(), nullptr);
  for (const formats::VertexCovariance& block : document.covariances) {
    covariance_of[static_cast<std::size_t>(block.vertex)] = &block.covariance;
  }
  std::vector<formats::TrajectoryPoint> points;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto pose = stamped_pose(graph, v);
    if (!pose) continue;
    formats::TrajectoryPoint point;
    point.stamp = pose->stamp;
    point.pose = pose->pose;
    if (mapped) {
      const drive::GeodeticPoint place = projection->to_geodetic(point.pose.head<2>());
      point.latitude_deg = place.latitude_deg;
      point.longitude_deg = place.longitude_deg;
    }
    if (const auto* covariance = covariance_of[static_cast<std::size_t>(v)]) {
      point.sigma = covariance->diagonal().cwiseSqrt();
    }
    if (const Fix* fix = fix_of[static_cast<std::size_t>(v)]) {
      point.status = std::string(to_string(fix->status));
      point.reason = fix->reason;
    }
    points.push_back(std::move(point));
  }
  if (points.empty()) return {};
  std::vector<std::string> files;
  const auto write = [&](const char* suffix, const std::string& text) {
    files.push_back(prefix + suffix);
    formats::write_file_atomically(files.back(), text);
  };
  write(".csv", formats::trajectory_csv(points));
  write(".tum", formats::trajectory_tum(points));
  if (mapped) {
    write(".geojson", formats::trajectory_geojson(points, fix_points, name));
    write(".kml", formats::trajectory_kml(points, fix_points, name, document.time_scale));
    write(".gpx", formats::trajectory_gpx(points, fix_points, name, document.time_scale));
  }
  return files;
}

std::string write_epochs(const evaluation::Evaluation& evaluation, const std::string& prefix) {
  const std::string file = prefix + ".epochs.csv";
  formats::write_file_atomically(file, evaluation::epochs_csv(evaluation.epochs));
  return file;
}

}  // namespace waymark::program
