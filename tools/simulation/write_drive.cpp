#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/formats/text/stamp_text.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/simulation/drive_yaml.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {
namespace {

/// Returns the form of gpsd: 2021-03-15T09:00:01.000Z.
std::string iso8601(Stamp gps) {
  const Stamp utc = convert(gps, TimeScale::gps, TimeScale::utc);
  const std::chrono::sys_seconds seconds{std::chrono::seconds(utc.nanoseconds / 1'000'000'000)};
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)),
                     utc.nanoseconds % 1'000'000'000 / 1'000'000);
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

std::string odometry_csv(const SimulatedDrive& drive, const std::vector<OdometrySample>& samples) {
  std::string text = label(drive) + "time_s,speed_mps,yaw_rate_radps\n";
  for (const OdometrySample& s : samples)
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

std::string gnss_json(const std::vector<SimulatedFix>& fixes) {
  std::string text =
      R"json({"class":"VERSION","release":"3.22 (simulated)","rev":"waymark simulate","proto_major":3,"proto_minor":14})json"
      "\n";
  for (const SimulatedFix& s : fixes) {
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

}  // namespace

void write_simulated_drive(const SimulatedDrive& drive, const std::string& folder) {
  const auto write = [&folder](const std::string& file, const std::string& text) {
    formats::write_file_atomically(folder + "/" + file, text);
  };
  const SimulationRecipe& recipe = drive.recipe;
  write(log_file(recipe.odometry), odometry_csv(drive, drive.odometry));
  for (std::size_t i = 0; i < drive.further_odometry.size(); ++i)
    write(log_file(recipe.further_odometry[i]), odometry_csv(drive, drive.further_odometry[i].samples));
  write(log_file(recipe.gnss), gnss_json(drive.fixes));
  for (std::size_t i = 0; i < drive.further_gnss.size(); ++i)
    write(log_file(recipe.further_gnss[i]), gnss_json(drive.further_gnss[i].fixes));
  write("truth.csv", truth_csv(drive));
  write("drive.yaml", drive_yaml(drive));
}

}  // namespace waymark::simulation
