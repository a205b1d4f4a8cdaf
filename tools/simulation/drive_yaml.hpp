/// The drive.yaml of a simulated drive.
#pragma once

#include <string>

#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {

/// Names of the logs, beside the drive.yaml.
[[nodiscard]] std::string log_file(const OdometryRecipe& odometry);
[[nodiscard]] std::string log_file(const GnssRecipe& gnss);

/// A drive with one odometry and one receiver has the sections `odometry` and `gnss`, a drive with
/// more has the section `sources`.
[[nodiscard]] std::string drive_yaml(const SimulatedDrive& drive);

}  // namespace waymark::simulation
