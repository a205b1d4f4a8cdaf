/// The quantities that a table of samples can hold: names, default columns, units and senses.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// How the numbers of a unit are written.
enum class UnitForm {
  number,
  square,  ///< value = factor * the root of the number, with its sign
  text     ///< a form of its own, such as a date, that only tables have
};

/// A unit, and its size in the unit of the quantity (SI; degrees for latitude and longitude). For
/// times that count, `factor` is the power of ten: a decimal text is shifted, never multiplied.
struct Unit {
  std::string_view name;
  double factor = 1;
  UnitForm form = UnitForm::number;
};

/// The zero and the positive sense of an angle or a turning rate.
struct Convention {
  std::string_view name;
  double sign = 1;    ///< own = sign * given + offset
  double offset = 0;  ///< rad
};

/// One quantity of a stream. The first unit and the first convention are the defaults.
struct Quantity {
  std::string_view name;            ///< key in `columns`, and the first default column name
  std::string_view default_column;  ///< second default column name, with the unit: "speed_mps"
  bool required = false;
  std::span<const Unit> units;
  std::span<const Convention> conventions;  ///< empty if the quantity has no sense
  double smallest = 0;  ///< a value outside [smallest, largest] (unit of the quantity) is corrupt
  double largest = 0;
  bool by_request = false;  ///< never found by a default name
};

/// The unit of times that are written as ISO 8601 dates.
inline constexpr std::string_view kIso8601 = "iso8601";

/// Returns the quantities of a stream, `time` first. formats/logs/README.md has the same as a
/// table. The quantities of a sensor stream come from the request; its text must outlive them.
/// @throws UsageError if a sensor asks for an unknown unit or sense
[[nodiscard]] std::vector<Quantity> quantities(const LogRequest& request);
[[nodiscard]] std::vector<std::string_view> names_of(std::span<const Quantity> quantities);
/// Returns null for an unknown name.
[[nodiscard]] const Quantity* find_quantity(std::span<const Quantity> quantities, std::string_view name);

/// Returns a quantity of which tables compose others (csv/composed.hpp): a component of a velocity, an axis, a rotation
/// or an Earth-centred position, a step from row to row, the fraction of a second. Null for an unknown name.
[[nodiscard]] const Quantity* find_piece(std::string_view name);

/// Tells whether the values of a quantity are numbers that have a size: no times, dates, codes or letters.
[[nodiscard]] bool has_size(const Quantity& quantity);

/// Returns null for an unknown name, and the default for an empty one.
[[nodiscard]] const Unit* find_unit(const Quantity& quantity, std::string_view name);
[[nodiscard]] const Convention* find_convention(const Quantity& quantity, std::string_view name);

/// "odometry", "gnss", "truth", "sensor".
[[nodiscard]] std::string_view to_string(StreamKind stream);

}  // namespace waymark::formats
