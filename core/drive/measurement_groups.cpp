#include <waymark/core/drive/measurement_groups.hpp>

#include <algorithm>

namespace waymark {
namespace {

/// Returns the index of the entry of a name. There are few, so they are searched one by one.
template <typename Entry>
std::size_t index_of(std::vector<Entry>& entries, std::string_view name, std::string_view other) {
  const auto known =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.name == name; });
  if (known != entries.end()) return static_cast<std::size_t>(known - entries.begin());
  entries.push_back({std::string(name), std::string(other)});
  return entries.size() - 1;
}

}  // namespace

std::size_t MeasurementGroups::quantity(std::string_view name, std::string_view unit) {
  return index_of(quantities, name, unit);
}

std::size_t MeasurementGroups::group(std::string_view name, std::string_view family) {
  return index_of(groups, name, family);
}

}  // namespace waymark
