/// The names of all files in the folder that `waymark run` and `waymark evaluate` write and
/// `waymark compare` reads.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark::evaluation {

/// The formats of a trajectory (qml: the style of the geojson). Those for maps are written only if the frame is known.
inline constexpr std::array<std::string_view, 6> kTrajectoryForms = {"csv", "tum", "geojson",
                                                                     "qml", "kml", "gpx"};

class ResultFolder {
 public:
  /// The page of a single result, or of the comparison of several.
  static constexpr const char* kReport = "report";
  /// The page that `waymark compare` writes.
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
  /// @param form one of kTrajectoryForms
  [[nodiscard]] std::string trajectory(const std::string& label, std::string_view form) const {
    return file(label + "." + std::string(form));
  }
  ///@}

  /// Returns a page by its name. @param name kReport or a label
  [[nodiscard]] std::string page(const std::string& name) const { return file(name + ".html"); }
  /// Returns the name of the page of one of several results. The page of a single result
  /// is the report.
  [[nodiscard]] static std::string page_name(const std::string& label, std::size_t results) {
    return results == 1 ? kReport : label;
  }

  /// Returns every file that may be written for results with these labels, except figures.
  [[nodiscard]] std::vector<std::string> files(std::span<const std::string> labels) const;

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

  std::string path_;
};

}  // namespace waymark::evaluation
