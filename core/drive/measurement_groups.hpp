/// How the measurements of a sensor fall into groups: by satellite, by anchor, by landmark. Reports
/// then have a table and figures for them.
///
/// A model fills it while it adds its edges, if SensorInput::groups is there:
/// @code
///   const EdgePlace edge = graph.add_edge(...);
///   if (input.groups != nullptr)
///     input.groups->add({.edge = edge,
///                        .quantity = input.groups->quantity("range", "m"),
///                        .group = input.groups->group("anchor 3", "")});
/// @endcode
/// Places of edges are valid until vertices leave the graph, so a sliding window does not ask.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/edge_batch.hpp>

namespace WAYMARK_EXPORT waymark {

struct MeasurementGroups {
  /// A kind of measurement. The first number of its edges' error is its residual.
  struct Quantity {
    std::string name;  ///< "pseudorange"
    std::string unit;  ///< of the residual: "m"
  };
  struct Group {
    std::string name;    ///< "G05"
    std::string family;  ///< groups of one kind, such as a satellite system; may be empty
  };
  /// One measurement. NaN: not known.
  struct Member {
    EdgePlace edge;
    std::size_t quantity = 0;                                  ///< index into `quantities`
    std::size_t group = 0;                                     ///< index into `groups`
    double signal = std::numeric_limits<double>::quiet_NaN();  ///< its strength, in `signal_unit`
    /// direction that it comes from: clockwise from grid north, and above the horizon
    double bearing_rad = std::numeric_limits<double>::quiet_NaN();
    double elevation_rad = std::numeric_limits<double>::quiet_NaN();
  };

  std::string one;          ///< one group in words: "satellite"; empty: the model tells of no groups
  std::string many;         ///< "satellites"
  std::string signal_name;  ///< "C/N0"; empty: there is none
  std::string signal_unit;
  std::vector<Quantity> quantities;
  std::vector<Group> groups;
  std::vector<Member> members;

  /// Returns the index of a quantity or of a group, which is added at the first call.
  std::size_t quantity(std::string_view name, std::string_view unit);
  std::size_t group(std::string_view name, std::string_view family);
  void add(const Member& member) { members.push_back(member); }
};

/// The measurements of one source of a drive, by group.
struct GroupsOfSource {
  std::string source;
  MeasurementGroups groups;
};

}  // namespace waymark
