/// Graphs and drives for the tool tests, made as text.
#pragma once

#include <functional>
#include <string>

/// The unit square, driven once around, with a wrong initial guess. It has a minimum.
[[nodiscard]] std::string square_graph();

/// A chain with shortcuts and weak information. Levenberg-Marquardt with `slow_options()` needs
/// thousands of steps.
[[nodiscard]] std::string slow_graph(int vertices);

/// One second of a generated drive on a circle of 200 m, at 10 m/s.
struct DriveRecipe {
  int seconds = 40;
  double truth_shift_s = 0;  ///< shift of the clock of the truth
  bool with_truth = true;
  bool with_fixes = true;  ///< false: the log has its header only
  bool empty_odometry = false;
  /// to the east, of the fix at that second
  std::function<double(int)> fix_error_m = [](int) { return 0.0; };
  std::string more_yaml{};
};

/// Writes odometry.csv, gnss.csv, truth.csv and drive.yaml into the folder. Returns the path
/// of drive.yaml.
std::string write_drive(const std::string& folder, const DriveRecipe& recipe = {});

/// Returns the drive that comes with the program.
[[nodiscard]] std::string bundled_drive();
