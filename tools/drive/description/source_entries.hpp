/// The sources of a drive.yaml: the entries of `sources`, and the short forms `odometry`, `gnss` and
/// `sensors`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/drive/description/yaml_section.hpp>

namespace waymark::drive {

/// Kinds of sources that Waymark itself knows. Every other kind is the name of a registered sensor.
inline constexpr std::string_view kOdometryKind = "odometry";
inline constexpr std::string_view kGnssKind = "gnss";
/// The sensor that an entry of kind gnss becomes if it names ephemerides (`navigation`).
inline constexpr std::string_view kRawGnssKind = "gnss_raw";

struct SourceEntry {
  std::string name;
  std::string kind;
  YamlSection section;  ///< its keys are known ones
};

/// Returns the elements of a list; a node that is none is the only element.
[[nodiscard]] std::vector<YAML::Node> entries_of(const YAML::Node& node);

/// Returns the sources in the order of the file, the short forms first. The only entry of a short form is
/// named by its key ("gnss"); of several, the second one is "gnss_2", unless it states a `name`. An
/// entry of `sensors` is named by its sensor.
/// @throws InputError for an impossible name, a missing kind, and an unknown key
[[nodiscard]] std::vector<SourceEntry> source_entries(const YamlSection& top);

}  // namespace waymark::drive
