#include "program/support/material.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace {

constexpr double kSpeed = 10;    // m/s
constexpr double kRadius = 200;  // m
constexpr double kYawRate = kSpeed / kRadius;
constexpr double kLatitude = 52.5;
constexpr double kLongitude = 13.4;
constexpr double kMetresPerDegree =
    111'270;  // of latitude there; good to 0.1 %, far inside the gate's limits

struct Place {
  double latitude, longitude;
};

Place place_at(double t, double east_error) {
  const double heading = kYawRate * t;
  const double east = kRadius * std::sin(heading) + east_error;
  const double north = kRadius * (1 - std::cos(heading));
  const double east_scale = 111'414 * std::cos(kLatitude * std::numbers::pi / 180);
  return {kLatitude + north / kMetresPerDegree, kLongitude + east / east_scale};
}

std::ostringstream table(const char* header) {
  std::ostringstream text;
  text.precision(12);
  text << header << "\n";
  return text;
}

}  // namespace

std::string square_graph() {
  return "GRAPH 1\n"
         "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.1 0.1 1.4\nVERTEX_SE2 2 0.9 1.2 3.0\nVERTEX_SE2 3 0.1 0.8 -1.7\n"
         "FIX 0\n"
         "EDGE_SE2 0 1 1 0 1.5707963267948966 100 0 0 100 0 400\n"
         "EDGE_SE2 1 2 1 0 1.5707963267948966 100 0 0 100 0 400\n"
         "EDGE_SE2 2 3 1 0 1.5707963267948966 100 0 0 100 0 400\n"
         "EDGE_SE2 3 0 1.01 0 1.5707963267948966 100 0 0 100 0 400\n";
}

std::string slow_graph(int vertices) {
  std::ostringstream text;
  text << "GRAPH 1\nFIX 0\n";
  for (int i = 0; i < vertices; ++i) {  // vertices < 20,000: no overflow
    text << "VERTEX_SE2 " << i << ' ' << i + i * 7919 % 13 * 0.05 << ' ' << i * 104729 % 17 * 0.05 << ' '
         << i * 31 % 11 * 0.02 << "\n";
  }
  for (int i = 0; i + 1 < vertices; ++i) {
    text << "EDGE_SE2 " << i << ' ' << i + 1 << " 1 0 0 1e-6 0 0 1e-6 0 1e-6\n";
    if (i % 50 == 0 && i + 50 < vertices) {
      text << "EDGE_SE2 " << i << ' ' << i + 50 << " 49 1 0.05 1e-6 0 0 1e-6 0 1e-6\n";
    }
  }
  return text.str();
}

std::string write_drive(const std::string& folder, const DriveRecipe& recipe) {
  auto odometry = table("time,speed,yaw_rate");
  for (int i = 0; i <= 10 * recipe.seconds && !recipe.empty_odometry; ++i) {
    odometry << 1000 + i * 0.1 << ',' << kSpeed << ',' << kYawRate << "\n";
  }
  auto gnss = table("time,latitude,longitude,accuracy");
  for (int t = 0; t <= recipe.seconds && recipe.with_fixes; ++t) {
    const Place place = place_at(t, recipe.fix_error_m(t));
    gnss << 1000 + t << ',' << place.latitude << ',' << place.longitude << ",2\n";
  }
  auto truth = table("time,latitude,longitude");
  for (int i = 0; i <= 2 * recipe.seconds; ++i) {
    const Place place = place_at(i * 0.5, 0);
    truth << 1000 + i * 0.5 + recipe.truth_shift_s << ',' << place.latitude << ',' << place.longitude << "\n";
  }
  write_text(folder + "odometry.csv", odometry.str());
  write_text(folder + "gnss.csv", gnss.str());
  write_text(folder + "truth.csv", truth.str());
  return write_text(folder + "drive.yaml",
                    std::string("name: circle\n"
                                "odometry: {file: odometry.csv}\n"
                                "gnss: {file: gnss.csv, accuracy: {meaning: drms}}\n") +
                        (recipe.with_truth ? "truth: {file: truth.csv}\n" : "") + recipe.more_yaml);
}

std::string bundled_drive() {
  return waymark_test::source_dir() + "/examples/berlin_potsdamer_platz/drive.yaml";
}
