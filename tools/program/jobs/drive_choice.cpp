#include <waymark/tools/program/jobs/drive_choice.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>

namespace waymark::program {
namespace {

/// Checks the loss that the drive.yaml or the command line names.
void check_loss(const drive::DriveFile& file, const TypeRegistry& registry) {
  const auto place = file.places.of.find("modeling.loss");
  if (place == file.places.of.end())
    return (void)drive::loss_of_fixes(file.settings.loss, registry, "--gnss-loss");
  try {
    (void)drive::loss_of_fixes(file.settings.loss, registry, "modeling.loss");
  } catch (const UsageError& error) {
    throw InputError(place->second + error.what());
  }
}

/// Returns the place of an option. It is among the options of its type, in the `calibration` of its source
/// or in that of the drive. Empty if it is in none of them.
/// @param of the key in Places under which the options are
std::optional<std::string> place_of_option(const drive::Places& places, const std::string& of,
                                           const std::string& option) {
  for (const std::string& section : {of + ".options.", of + ".calibration.", std::string("calibration.")}) {
    const auto place = places.of.find(section + option);
    if (place != places.of.end()) return place->second;
  }
  return std::nullopt;
}

/// Checks something that the drive.yaml states, and gives errors its place.
/// @param key of the model in Places
/// @param of as for place_of_option()
/// @throws InputError for the drive.yaml; what `check` throws for the command line
void check_stated(const drive::Places& places, const std::string& key, const std::string& of,
                  const Options& given, const std::function<void()>& check) {
  try {
    check();
  } catch (const OptionError& error) {
    const auto place = place_of_option(places, of, error.option());
    if (given.contains(error.option()) || (!place && !places.of.contains(key))) throw;
    throw InputError(place.value_or(places.at(key)) + error.what());
  } catch (const UsageError& error) {
    if (!places.of.contains(key)) throw;
    throw InputError(places.at(key) + error.what());
  }
}

/// @throws InputError with its place for a state of one source that nobody knows
void check_own_calibration(const Options& calibration, const std::string& of, const drive::Places& places,
                           const std::vector<OptionInfo>& known) {
  std::vector<std::string_view> names;
  for (const OptionInfo& option : known) names.push_back(option.name);
  for (const auto& [name, value] : calibration) {
    const auto place = places.of.find(of + ".calibration." + name);
    if (place == places.of.end() || has_option(known, name)) continue;
    throw InputError(place->second + "calibration: the source has no option '" + name + "'" +
                     did_you_mean(name, names));
  }
}

/// Returns the options of all modelings: another one than the stated may be chosen on the command line.
std::vector<OptionInfo> options_of_modelings(const TypeRegistry& registry) {
  std::vector<OptionInfo> all;
  for (const auto& known : registry.gnss_modelings())
    all.insert(all.end(), known.type.options.begin(), known.type.options.end());
  return all;
}

/// Checks the loss of the measurements of a relative source or a sensor. @param of its place in Places
void check_loss_of_source(const drive::FusionSettings& settings, const std::string& source,
                          const std::string& of, const drive::Places& places, const TypeRegistry& registry) {
  check_stated(places, of + ".loss", of, {},
               [&] { (void)drive::loss_of_source(settings, source, registry); });
}

/// Checks what is stated for single sources.
void check_sources(const drive::FusionSettings& settings, const drive::DriveFile& file,
                   const TypeRegistry& registry) {
  for (const drive::GnssConfig& source : file.description.gnss) {
    const std::string place = "sources." + source.name;
    check_stated(file.places, place + ".common", place, {}, [&] {
      const std::string group = drive::group_of(settings, source.name);
      const auto& all = file.description.gnss;
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.name == group; }))
        throw UsageError("common: there is no absolute source '" + group + "'");
      if (group != source.name) drive::require_common_errors(settings, group, registry);
    });
    if (!settings.sources.contains(source.name)) continue;
    check_own_calibration(settings.sources.at(source.name).calibration, place, file.places,
                          options_of_modelings(registry));
    check_stated(file.places, place + ".modeling", place, {}, [&] {
      const drive::FusionSettings own = drive::for_absolute(settings, source.name, registry);
      (void)registry.make_gnss_modeling(own.modeling, own.modeling_options);
    });
    check_stated(file.places, place + ".loss", place, {}, [&] {
      (void)drive::loss_of_fixes(drive::for_absolute(settings, source.name, registry).loss, registry);
    });
  }
  for (const drive::OdometryConfig& source : file.description.odometry) {
    const bool is_only = file.description.odometry.size() == 1;
    const std::string place = is_only ? "odometry" : "sources." + source.name;
    const drive::FusionSettings own = drive::for_relative(settings, source.name);
    check_stated(file.places, place + ".model", place, {}, [&] {
      (void)drive::make_odometry_model(own, file.description.timeline.gap_noise_factor, registry);
    });
    check_loss_of_source(settings, source.name, place, file.places, registry);
    const auto stated = settings.sources.find(source.name);
    if (stated == settings.sources.end()) continue;
    check_own_calibration(stated->second.calibration, place, file.places,
                          registry.odometry_model(own.odometry_model).options);
  }
  for (const drive::SensorConfig& sensor : file.description.sensors)
    check_loss_of_source(settings, sensor.source, "sources." + sensor.source, file.places, registry);
}

/// @throws InputError for an option of the drive.yaml, with its place
/// @throws OptionError for an option of the command line
void check_modeling(const drive::FusionSettings& settings, const Options& given, const drive::Places& places,
                    const TypeRegistry& registry) {
  check_stated(places, "", "modeling", given,
               [&] { (void)registry.make_gnss_modeling(settings.modeling, settings.modeling_options); });
}

void check_odometry_model(const drive::FusionSettings& settings, const drive::DriveFile& file,
                          const TypeRegistry& registry) {
  try {
    (void)drive::make_odometry_model(settings, file.description.timeline.gap_noise_factor, registry);
  } catch (const OptionError& error) {
    const auto place = place_of_option(file.places, "odometry", error.option());
    throw InputError(place.value_or(file.places.at("odometry.model")) + error.what());
  } catch (const UsageError& error) {
    throw InputError(file.places.at("odometry.model") + error.what());
  }
}

/// @throws InputError with its place for a state that neither the odometry model nor a
/// modeling knows
void check_calibration(const drive::DriveFile& file, const std::vector<std::string>& modelings,
                       const TypeRegistry& registry) {
  const std::string& odometry_model = file.settings.odometry_model;
  std::vector<std::string_view> known;
  const auto add = [&known](const std::vector<OptionInfo>& options) {
    for (const OptionInfo& option : options) known.push_back(option.name);
  };
  if (!file.settings.calibration || file.settings.calibration->empty()) return;
  add(registry.odometry_model(odometry_model).options);
  for (const std::string& modeling : modelings) add(registry.gnss_modeling(modeling).options);
  for (const auto& [name, value] : *file.settings.calibration) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string hint = did_you_mean(name, known);
    throw InputError(file.places.at("calibration." + name) + "calibration: neither the odometry model '" +
                     odometry_model + "' nor the GNSS modeling has an option '" + name + "'" +
                     (hint.empty() ? "; `waymark info` lists their options" : hint));
  }
}

/// @throws UsageError for an option that no chosen modeling has
void check_options_are_used(const std::vector<std::string>& modelings, const Options& given,
                            const TypeRegistry& registry) {
  for (const auto& entry : given) {
    const auto has = [&](const std::string& modeling) {
      return has_option(registry.gnss_modeling(modeling).options, entry.first);
    };
    if (std::any_of(modelings.begin(), modelings.end(), has)) continue;
    // This throws a message with the options that exist.
    (void)registry.make_gnss_modeling(modelings.front(), {{entry.first, entry.second}});
  }
}

std::vector<std::string> chosen_modelings(const drive::DriveFile& file, const DriveChoice& choice,
                                          const TypeRegistry& registry) {
  std::vector<std::string> names;
  for (const std::string& name : choice.modelings) {
    if (name != "all") {
      names.push_back(name);
      continue;
    }
    for (const auto& entry : registry.gnss_modelings()) names.push_back(entry.type.name);
  }
  if (names.empty()) names.push_back(file.settings.modeling);
  std::vector<std::string> once;
  for (const std::string& name : names) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  return once;
}

/// Returns the settings of one modeling. Options in the drive.yaml belong to the modeling
/// that it names. One of the command line is that of all sources.
/// @param is_chosen on the command line
drive::FusionSettings settings_of(const std::string& modeling, bool is_chosen, const drive::DriveFile& file,
                                  const Options& given, const TypeRegistry& registry) {
  drive::FusionSettings settings = file.settings;
  for (const drive::GnssConfig& source : file.description.gnss) {
    const auto own = settings.sources.find(source.name);
    if (!is_chosen || own == settings.sources.end()) continue;
    const std::string& stated = own->second.model.empty() ? file.settings.modeling : own->second.model;
    if (stated != modeling) own->second.options.clear();
    own->second.model.clear();
  }
  if (modeling != settings.modeling) settings.modeling_options.clear();
  settings.modeling = modeling;
  for (const auto& [name, value] : given) {
    if (has_option(registry.gnss_modeling(modeling).options, name)) settings.modeling_options[name] = value;
  }
  return settings;
}

}  // namespace

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

void set_calibration(const std::vector<std::string>& words, drive::FusionSettings& settings) {
  if (words.empty()) return;
  if (!settings.calibration) settings.calibration.emplace();
  for (const std::string& word : words) {
    if (word == "on") {
      settings.calibration = drive::default_calibration();
    } else if (word == "off") {
      settings.calibration->clear();
    } else {
      for (const auto& [name, value] : parse_options({word})) (*settings.calibration)[name] = value;
    }
  }
}

void set_initial_guess(drive::DriveFile& file, const std::string& way) {
  file.settings.initial_guess.method =
      way == "anchored" ? drive::StartMethod::anchored : drive::StartMethod::dead_reckoning;
}

void set_loss(drive::DriveFile& file, const std::string& loss) {
  file.settings.loss = loss;
  file.places.of.erase("modeling.loss");
}

void set_withheld(drive::DriveFile& file, int every) {
  for (drive::GnssConfig& source : file.description.gnss) source.withhold_every = every;
}

drive::DriveFile edited(drive::DriveFile file, const DriveChoice& choice) {
  const auto from_s = file.description.from_s;
  const auto to_s = file.description.to_s;
  for (const DriveEdit& edit : choice.edits) edit(file);
  const drive::DriveDescription& drive = file.description;
  const bool edited = drive.from_s != from_s || drive.to_s != to_s;
  if (edited && drive.from_s && drive.to_s && *drive.from_s >= *drive.to_s)
    throw UsageError(fmt::format("--from {} must be less than --to {}", *drive.from_s, *drive.to_s));
  return file;
}

drive::DriveFile read_drive_file(const std::string& path, const DriveChoice& choice) {
  return edited(drive::load_drive_file(path, choice.data_folder), choice);
}

std::vector<drive::FusionSettings> chosen_settings(const drive::DriveFile& file, const DriveChoice& choice,
                                                   const TypeRegistry& registry) {
  const std::vector<std::string> modelings = chosen_modelings(file, choice, registry);
  const Options given = parse_options(choice.modeling_options);
  std::vector<drive::FusionSettings> all;
  for (const std::string& modeling : modelings) {
    all.push_back(settings_of(modeling, !choice.modelings.empty(), file, given, registry));
    check_modeling(drive::decided(all.back(), registry), given, file.places, registry);
  }
  check_options_are_used(modelings, given, registry);
  check_calibration(file, modelings, registry);
  check_loss(file, registry);
  for (const drive::FusionSettings& settings : all)
    check_odometry_model(drive::decided(settings, registry), file, registry);
  for (const drive::FusionSettings& settings : all)
    check_sources(drive::decided(settings, registry), file, registry);
  return all;
}

}  // namespace waymark::program
