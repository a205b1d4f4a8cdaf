#include <waymark/tools/live/session/former_noise.hpp>

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/live/session/noise_json.hpp>

namespace waymark::live {
namespace {

/// A delay that the whole drive did not show is no state of the window either.
void leave_out_delays(const std::vector<std::string>& groups, drive::FusionSettings& settings) {
  constexpr const char* kTimeOffset = "time_offset";
  if (settings.calibration && settings.calibration->contains(kTimeOffset)) return;
  for (const std::string& group : groups) {
    Options& options = group.empty() ? settings.modeling_options : settings.sources[group].options;
    options.try_emplace(kTimeOffset, "off");
  }
}

}  // namespace

void use_former_noise(const std::string& path, const TypeRegistry& registry,
                      drive::FusionSettings& settings) {
  (void)registry.gnss_modeling(settings.modeling);  // names an unknown one
  std::error_code unknown;
  const bool folder = std::filesystem::is_directory(path, unknown);
  const std::string file = folder ? (std::filesystem::path(path) / "summary.json").string() : path;
  const std::string text = formats::read_text_file(file, {.check = formats::require_digits(file)});
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains(settings.modeling) || !json[settings.modeling].contains("noise"))
    throw InputError(fmt::format(
        "{}: there is no noise of the modeling '{}'; take the summary.json of a 'waymark run' that estimated it",
        file, settings.modeling));
  drive::NoiseEstimate noise;
  try {
    noise = noise_from_json(json[settings.modeling]["noise"]);
    leave_out_delays(json[settings.modeling].value("without_delay", std::vector<std::string>()), settings);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: noise: {}", file, error.what()));
  }
  settings = drive::with_noise(std::move(settings), noise);
}

}  // namespace waymark::live
