#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {
namespace {

/// Returns the form of gpsd: 2021-03-15T09:00:01.000Z. Fixes are at whole seconds.
std::string iso8601(Stamp gps) {
  const Stamp utc = convert(gps, TimeScale::gps, TimeScale::utc);
  const std::chrono::sys_seconds seconds{std::chrono::seconds(utc.nanoseconds / 1'000'000'000)};
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.000Z", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

/// Returns "1299834018.01". Stamps are on the 100 Hz clock of the simulation.
std::string centiseconds(Stamp stamp) {
  std::string text = formats::decimal_seconds(stamp);
  text.resize(text.size() - 7);
  return text;
}

std::string label(const SimulatedDrive& drive) {
  return fmt::format("# {}: no vehicle drove this.\n", drive.name);
}

std::string odometry_csv(const SimulatedDrive& drive) {
  std::string text = label(drive) + "time_s,speed_mps,yaw_rate_radps\n";
  for (const OdometrySample& s : drive.odometry)
    text += fmt::format("{},{:.5f},{:.7f}\n", centiseconds(s.stamp), s.speed_mps, s.yaw_rate_radps);
  return text;
}

std::string truth_csv(const SimulatedDrive& drive) {
  std::string text = label(drive) + "time_s,latitude_deg,longitude_deg,height_m,heading_rad\n";
  for (const GeodeticTruth& t : drive.truth)
    text += fmt::format("{},{:.10f},{:.10f},{:.3f},{:.6f}\n", centiseconds(t.stamp), t.latitude_deg,
                        t.longitude_deg, t.height_m, *t.heading_rad);
  return text;
}

std::string gnss_json(const SimulatedDrive& drive) {
  std::string text =
      R"json({"class":"VERSION","release":"3.22 (simulated)","rev":"waymark simulate","proto_major":3,"proto_minor":14})json"
      "\n";
  for (const SimulatedFix& s : drive.fixes) {
    const GeodeticFix& fix = s.fix;
    text += fmt::format(
        R"({{"class":"TPV","device":"simulated","mode":3,"time":"{}","lat":{:.9f},"lon":{:.9f},"alt":{:.3f},)"
        R"("epx":{:.3f},"epy":{:.3f},"epv":{:.3f})",
        iso8601(fix.stamp), fix.latitude_deg, fix.longitude_deg, fix.height_m, s.epx_m, s.epy_m, s.epv_m);
    if (fix.course_rad) text += fmt::format(R"(,"track":{:.4f})", *fix.course_rad / kDegree);
    text += fmt::format(R"(,"speed":{:.3f}}})"
                        "\n",
                        *fix.speed_mps);
  }
  return text;
}

std::string drive_yaml(const SimulatedDrive& drive) {
  return fmt::format(
      "# Simulated drive: no vehicle drove this. Made by `waymark simulate`, recipe {}, seed {}; the models "
      "are\n"
      "# explained in tools/simulation/README.md, the keys in tools/drive/README.md.\n"
      "# Errors: fixes {:.2f} s late, of {:g} m over {:.0f} s; yaw rate {:.2g} rad/sqrt(s); odometry of {:g} Hz.\n"
      "name: \"{}\"\n"
      "time: {{scale: gps}}              # gpsd's log counts UTC and is converted\n"
      "\n"
      "odometry:\n"
      "  file: odometry.csv              # time_s: GPS seconds since 1980\n"
      "  columns: {{time: time_s, speed: speed_mps, yaw_rate: yaw_rate_radps}}\n"
      "\n"
      "gnss:\n"
      "  file: gnss.json\n"
      "  format: gpsd_json\n"
      "  accuracy: {{meaning: 95}}         # epx and epy\n"
      "\n"
      "truth:\n"
      "  file: truth.csv\n"
      "  columns: {{time: time_s, latitude: latitude_deg, longitude: longitude_deg, height: height_m, "
      "heading: "
      "heading_rad}}\n",
      drive.recipe.name, drive.seed, drive.recipe.gnss.delay_s, drive.recipe.gnss.fast_sigma_m,
      drive.recipe.gnss.fast_tau_s,
      drive.recipe.odometry.yaw_rate_noise_radps / std::sqrt(drive.recipe.odometry.rate_hz),
      drive.recipe.odometry.rate_hz, drive.name);
}

}  // namespace

void write_simulated_drive(const SimulatedDrive& drive, const std::string& folder) {
  formats::write_file_atomically(folder + "/odometry.csv", odometry_csv(drive));
  formats::write_file_atomically(folder + "/gnss.json", gnss_json(drive));
  formats::write_file_atomically(folder + "/truth.csv", truth_csv(drive));
  formats::write_file_atomically(folder + "/drive.yaml", drive_yaml(drive));
}

}  // namespace waymark::simulation
