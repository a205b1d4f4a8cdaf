/// The folder that `waymark run` and `waymark evaluate` write and `waymark compare` reads: the name
/// of every file in it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark::evaluation {

/// The forms in which a trajectory is written; maps only if the frame is known.
inline constexpr std::array<std::string_view, 5> kTrajectoryForms = {"csv", "tum", "geojson", "kml", "gpx"};

class ResultFolder {
 public:
  /// Page of a single result, and of the comparison of several.
  static constexpr const char* kReport = "report";
  /// Page that `waymark compare` writes.
  static constexpr const char* kComparison = "comparison";

  explicit ResultFolder(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }

  /// @name Of the whole folder
  ///@{
  [[nodiscard]] std::string metrics() const { return file("metrics.json"); }
  [[nodiscard]] std::string summary() const { return file("summary.json"); }
  [[nodiscard]] std::string figures() const { return file("figures"); }
  ///@}

  /// @name Of one result by its label: the modeling, or the name of the graph
  ///@{
  [[nodiscard]] std::string graph(const std::string& label) const { return file(label + ".graph"); }
  [[nodiscard]] std::string fused_graph(const std::string& label) const {
    return file(label + ".fused.graph");
  }
  [[nodiscard]] std::string epochs(const std::string& label) const { return file(label + ".epochs.csv"); }
  /// @param form  of kTrajectoryForms
  [[nodiscard]] std::string trajectory(const std::string& label, std::string_view form) const {
    return file(label + "." + std::string(form));
  }
  ///@}

  /// A page by its name. @param name  kReport or a label
  [[nodiscard]] std::string page(const std::string& name) const { return file(name + ".html"); }
  /// The page of one result among several. Of a single one it is the report.
  [[nodiscard]] static std::string page_name(const std::string& label, std::size_t results) {
    return results == 1 ? kReport : label;
  }

  /// Every file that may be written for results of these labels, figures apart.
  [[nodiscard]] std::vector<std::string> files(std::span<const std::string> labels) const;

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

  std::string path_;
};

}  // namespace waymark::evaluation
