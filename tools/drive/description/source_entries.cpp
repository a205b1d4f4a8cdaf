#include <waymark/tools/drive/description/source_entries.hpp>

#include <algorithm>
#include <cctype>
#include <map>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/description/log_config.hpp>

namespace waymark::drive {
namespace {

/// Words of the command line and of file names are made of source names.
bool is_name(const std::string& text) {
  const auto is_letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), is_letter);
}

std::vector<std::string_view> odometry_keys() {
  return log_keys({"kind", "name", "parts", "rate", "speed_from", "yaw_rate_from", "gyro", "vehicle",
                   "speed_delay", "yaw_rate_delay", "model", "options", "calibration", "nodes", "loss"});
}
std::vector<std::string_view> gnss_keys() {
  return log_keys({"kind", "name", "accuracy", "frame", "velocity", "antenna", "period", "delay",
                   "smoothing", "withhold_every", "withheld", "heading", "modeling", "calibration", "gate", "common"});
}

/// A receiver whose log needs ephemerides gives raw measurements: a sensor, with some keys of a receiver.
std::string kind_of(const std::string& stated, const YAML::Node& node) {
  const bool is_raw = stated == kGnssKind && node.IsMap() && node["navigation"];
  return is_raw ? std::string(kRawGnssKind) : stated;
}

/// @param without one of the keys, which has no meaning in this form of an entry
YamlSection section_of(const std::string& kind, const YAML::Node& node, const std::string& name,
                       const std::string& file, std::string_view without) {
  std::vector<std::string_view> keys = kind == kOdometryKind ? odometry_keys()
                                       : kind == kGnssKind   ? gnss_keys()
                                                             : log_keys({"kind", "name", "options", "loss"});
  if (kind == kRawGnssKind) keys.push_back("antenna");
  std::erase(keys, without);
  return {node, name, file, keys};
}

class Entries {
 public:
  explicit Entries(const YamlSection& top) : top_(top) {}

  /// Adds the entries of a short form: their key is their kind, and its word is the kind of source.
  void add_short_form(const std::string& kind) {
    if (!top_.has(kind)) return;
    const std::vector<YAML::Node> entries = entries_of(top_.node(kind));
    if (entries.empty()) top_.fail(kind, "at least one log is needed");
    for (const YAML::Node& entry : entries) {
      const std::string meant = kind_of(kind, entry);
      YamlSection section = section_of(meant, entry, kind, top_.file(), "kind");
      std::string name = numbered(kind);
      section.read("name", name);
      add(name, meant, std::move(section));
    }
  }

  /// An entry of `sensors` names its kind by `name`.
  void add_sensors() {
    if (!top_.has("sensors")) return;
    for (const YAML::Node& entry : entries_of(top_.node("sensors"))) {
      YamlSection section = section_of("", entry, "sensors", top_.file(), "kind");
      std::string kind;
      section.read("name", kind);
      if (kind.empty()) throw InputError(section.place() + "sensors: 'name' is missing");
      if (kind == kOdometryKind || kind == kGnssKind)
        throw InputError(section.place() + "sensors: '" + kind + "' is no further sensor; state it under '" +
                         kind + "' or 'sources'");
      add(numbered(kind), kind, std::move(section));
    }
  }

  void add_sources() {
    const auto sources = top_.free_section("sources");
    if (!sources) return;
    for (const std::string& name : sources->keys()) {
      std::string kind;
      const YamlSection any = *sources->free_section(name);
      any.read("kind", kind);
      if (kind.empty())
        throw InputError(any.place() + "sources." + name +
                         ": 'kind' is missing; use odometry, gnss or a sensor (`waymark info` lists them)");
      kind = kind_of(kind, sources->node(name));
      YamlSection section = section_of(kind, sources->node(name), "sources." + name, top_.file(), "name");
      add(name, kind, std::move(section));
    }
  }

  [[nodiscard]] std::vector<SourceEntry> taken() { return std::move(found_); }

 private:
  std::string numbered(const std::string& kind) {
    const int number = ++count_[kind];
    return number == 1 ? kind : kind + "_" + std::to_string(number);
  }

  void add(const std::string& name, const std::string& kind, YamlSection section) {
    if (!is_name(name))
      throw InputError(section.place() + "the name of a source has letters, digits, '_' and '-', got '" +
                       name + "'");
    found_.push_back({name, kind, std::move(section)});
  }

  const YamlSection& top_;
  std::map<std::string, int> count_;
  std::vector<SourceEntry> found_;
};

}  // namespace

std::vector<YAML::Node> entries_of(const YAML::Node& node) {
  std::vector<YAML::Node> entries;
  if (node.IsSequence()) {
    for (const auto& entry : node) entries.push_back(entry);
  } else {
    entries.push_back(node);
  }
  return entries;
}

std::vector<SourceEntry> source_entries(const YamlSection& top) {
  Entries all(top);
  all.add_short_form(std::string(kOdometryKind));
  all.add_short_form(std::string(kGnssKind));
  all.add_sensors();
  all.add_sources();
  return all.taken();
}

}  // namespace waymark::drive
