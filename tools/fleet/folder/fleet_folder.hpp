/// The names of all files in the folder of a fleet. Every machine that sees the folder reads and
/// writes the same files; tools/fleet/README.md describes them.
#pragma once

#include <string>
#include <utility>

namespace waymark::fleet {

class FleetFolder {
 public:
  /// The worker of a fleet on one machine; tasks of a cluster have names of their own.
  static constexpr const char* kLocal = "local";
  static constexpr const char* kPage = "fleet";

  explicit FleetFolder(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string plan() const { return file("fleet.json"); }
  /// Returns the record of a drive. It exists if, and only if, the drive has ended.
  [[nodiscard]] std::string record(const std::string& drive) const {
    return file("records/" + drive + ".json");
  }
  /// Returns the folder with the results of a drive, as `waymark run` wrote them.
  [[nodiscard]] std::string results(const std::string& drive) const { return file("drives/" + drive); }
  /// Returns the folder of the drives that a worker has not ended yet. Whatever it holds when the
  /// worker begins was left by one that was killed.
  [[nodiscard]] std::string running(const std::string& worker) const { return file("running/" + worker); }
  [[nodiscard]] std::string all_running() const { return file("running"); }
  [[nodiscard]] std::string lock() const { return file("fleet.lock"); }

  /// @name The merged results: the same bytes wherever the drives were run
  ///@{
  [[nodiscard]] std::string csv() const { return file("fleet.csv"); }
  [[nodiscard]] std::string sqlite() const { return file("fleet.sqlite"); }
  ///@}
  /// Returns the one file of times, memory and machines, which differ from run to run.
  [[nodiscard]] std::string costs() const { return file("costs.csv"); }

  [[nodiscard]] std::string slurm() const { return file("slurm"); }
  [[nodiscard]] std::string slurm_script() const { return file("slurm/fleet.sbatch"); }

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

  std::string path_;
};

}  // namespace waymark::fleet
