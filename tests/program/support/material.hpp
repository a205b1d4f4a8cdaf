/// Graphs and drives that the tool tests work on, made as text.
#pragma once

#include <functional>
#include <string>

/// The unit square driven round once, with a wrong start; has a minimum.
[[nodiscard]] std::string square_graph();

/// A chain with shortcuts and weak information: Levenberg-Marquardt with `slow_options()` needs thousands of
/// steps.
[[nodiscard]] std::string slow_graph(int vertices);

/// One second of a generated drive on a circle of 200 m, 10 m/s.
struct DriveRecipe {
  int seconds = 40;
  double truth_shift_s = 0;  ///< the truth's clock
  bool with_truth = true;
  bool with_fixes = true;  ///< false: the log has its header only
  bool empty_odometry = false;
  std::function<double(int)> fix_error_m = [](int) { return 0.0; };  ///< east, of the fix at that second
  std::string more_yaml{};
};

/// Writes odometry.csv, gnss.csv, truth.csv and drive.yaml into the folder; returns the path of drive.yaml.
std::string write_drive(const std::string& folder, const DriveRecipe& recipe = {});

/// The drive that comes with the program.
[[nodiscard]] std::string bundled_drive();
