/// The quantities a table of samples can hold: their names, default columns, units and senses.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// A unit and what one of it is in the quantity's own unit (SI; degrees for latitude and longitude).
/// For times `factor` is the power of ten: a decimal text is shifted, never multiplied.
struct Unit {
  std::string_view name;
  double factor = 1;
};

/// How an angle or a turning rate is counted.
struct Convention {
  std::string_view name;
  double sign = 1;    ///< own = sign * given + offset
  double offset = 0;  ///< rad
};

/// One quantity of a stream. The first unit and the first convention are the defaults.
struct Quantity {
  std::string_view name;            ///< key in `columns`; also the first default column name
  std::string_view default_column;  ///< second default column name, with the unit: "speed_mps"
  bool required = false;
  std::span<const Unit> units;
  std::span<const Convention> conventions;  ///< empty where the quantity has no sense
  double smallest = 0;                      ///< a value outside [smallest, largest] (own unit) is corrupt
  double largest = 0;
};

/// Unit of times written as ISO 8601 dates.
inline constexpr std::string_view kIso8601 = "iso8601";

/// The quantities of a stream, `time` first. formats/logs/README.md has the same as a table; those of a
/// sensor stream are the request's own, whose text must outlive them.
/// @throws UsageError where a sensor asks for a unit or sense that is not known
[[nodiscard]] std::vector<Quantity> quantities(const LogRequest& request);
[[nodiscard]] std::vector<std::string_view> names_of(std::span<const Quantity> quantities);
/// Null for an unknown name.
[[nodiscard]] const Quantity* find_quantity(std::span<const Quantity> quantities, std::string_view name);

/// Null for an unknown name; the default for an empty one.
[[nodiscard]] const Unit* find_unit(const Quantity& quantity, std::string_view name);
[[nodiscard]] const Convention* find_convention(const Quantity& quantity, std::string_view name);

/// "odometry", "gnss", "truth", "sensor".
[[nodiscard]] std::string_view to_string(StreamKind stream);

}  // namespace waymark::formats
