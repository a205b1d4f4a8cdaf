/// Quantities that a table may give in pieces: the speed and course in the components of a velocity, the heading in
/// those of an axis or a rotation, the distance and the heading in steps from row to row.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>
#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

namespace waymark::formats {

/// Returns the quantities that a table can hold for a request: those of the stream, and the pieces of which some of
/// them can be composed. A piece is never found by a default name.
[[nodiscard]] std::vector<Quantity> table_quantities(const LogRequest& request);

/// Tells whether a request names the column of a quantity, or those of its pieces.
[[nodiscard]] bool names_columns_of(const LogRequest& request, std::string_view quantity);

/// Composes one quantity from the columns of its pieces.
class Composed {
 public:
  /// @param columns must outlive it
  /// @throws InputError if the table has some of the pieces that belong together, and lacks others
  Composed(std::string_view quantity, StreamKind stream, const CsvColumns& columns, const std::string& path);

  /// Tells whether the table has the pieces.
  [[nodiscard]] explicit operator bool() const { return !pieces_.empty(); }
  /// Returns the value of a row. NaN: it has none (a piece is missing; a direction of length 0).
  /// @param number reads a column of the row
  [[nodiscard]] double value(const std::function<double(const BoundColumn*)>& number);

 private:
  using Formula = double (*)(const double* pieces);

  std::vector<const BoundColumn*> pieces_;
  Formula formula_ = nullptr;
  bool adds_up_ = false;  ///< the piece is a step from the row before
  double sum_ = 0;
};

}  // namespace waymark::formats
