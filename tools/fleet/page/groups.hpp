/// Groups of drives, and the series and tables that are made of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <waymark/tools/drawing/figure/figure.hpp>
#include <waymark/tools/fleet/table/fleet_table.hpp>

namespace waymark::fleet {

/// A drive with one modeling.
struct Member {
  const DriveRecord* record = nullptr;
  const ModelingRow* row = nullptr;
};

struct Group {
  std::string name;
  std::vector<Member> members;

  [[nodiscard]] std::size_t count(DriveState state) const;
  /// Returns the finite values of a column of the members with a row, ascending.
  [[nodiscard]] std::vector<double> sorted(std::string_view column) const;
  /// Returns the errors by which drives are judged, ascending.
  [[nodiscard]] std::vector<double> errors() const;
};

/// Returns groups by name. If the fleet has several modelings, each of them is a group of its own. Failed
/// drives are in none, because nothing is known of them.
[[nodiscard]] std::vector<Group> groups_by(const Fleet& fleet,
                                           const std::function<std::string(const DriveRecord&)>& name_of);
/// Returns the whole fleet, one group for each modeling.
[[nodiscard]] std::vector<Group> groups_by_modeling(const Fleet& fleet);

/// Returns a row for each group: counts, errors, consistency.
[[nodiscard]] text::Table group_table(const std::string& title, const std::string& heading,
                                      const std::vector<Group>& groups);

/// Returns the share of values up to each value, as a line.
[[nodiscard]] drawing::Series distribution(const std::string& name, const std::vector<double>& ascending,
                                           drawing::Look look);

}  // namespace waymark::fleet
