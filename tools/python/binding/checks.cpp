#include <waymark/tools/python/binding/checks.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/linear/dense_decompositions.hpp>
#include <waymark/formats/graph/detail/graph_records.hpp>

namespace waymark::python {
namespace {

/// Of two numbers that mirror each other, relative to the roots of their diagonal numbers. Inverses that
/// numpy computes differ by less, and so do matrices of 32 bits.
constexpr double kSymmetry = 1e-6;

/// @param describe returns what number i is: "values: vertex 7: y"
template <typename Describe>
void require_finite(std::span<const double> numbers, const Describe& describe) {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [](double x) { return !std::isfinite(x); });
  if (found == numbers.end()) return;
  const auto index = static_cast<std::size_t>(found - numbers.begin());
  throw UsageError(fmt::format("{} is {}, and must be a finite number", describe(index), *found));
}

std::span<const double> all_of(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

/// Returns the name of a number of the fields of an edge: "measured[1]".
std::string field_name(const EdgeType& type, std::size_t number) {
  std::size_t first = 0;
  for (const FieldInfo& field : type.fields) {
    const auto size = static_cast<std::size_t>(field.size);
    if (number < first + size)
      return size == 1 ? field.name : fmt::format("{}[{}]", field.name, number - first);
    first += size;
  }
  return fmt::format("number {}", number);
}

/// Tells what is wrong with a matrix of finite numbers as information; empty if nothing is.
std::string fault_of_information(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = row + 1; column < matrix.cols(); ++column) {
      const double above = matrix(row, column);
      const double below = matrix(column, row);
      const double scale =
          std::sqrt(std::abs(matrix(row, row))) * std::sqrt(std::abs(matrix(column, column)));
      if (std::abs(above - below) > kSymmetry * scale)
        return fmt::format("the information matrix is not symmetric: {} in row {} and column {}, {} opposite",
                           above, row, column, below);
    }
  }
  return is_positive_semidefinite(matrix) ? std::string() : std::string(formats::kIndefinite);
}

}  // namespace

void check_value(const VertexType& type, VertexId id, std::span<const double> value) {
  require_finite(value, [&](std::size_t i) {
    return fmt::format("values: vertex {}: {}", to_number(id), type.value_names[i]);
  });
}

void check_fields(const EdgeType& type, const Numbers& fields, py::ssize_t edges) {
  const auto each =
      static_cast<std::size_t>(std::max<py::ssize_t>(1, fields.size() / std::max<py::ssize_t>(1, edges)));
  require_finite(all_of(fields), [&](std::size_t i) {
    return fmt::format("fields: edge {}: {}", i / each, field_name(type, i % each));
  });
}

void check_information(const Numbers& information, py::ssize_t size, bool is_shared) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto each = static_cast<std::size_t>(size * size);
  const auto edge = [&](std::size_t i) { return is_shared ? std::string() : fmt::format("edge {}: ", i); };
  require_finite(all_of(information), [&](std::size_t i) {
    const std::size_t rows = static_cast<std::size_t>(size);
    return fmt::format("information: {}row {}, column {}", edge(i / each), i % each / rows, i % rows);
  });
  for (std::size_t i = 0; (i + 1) * each <= static_cast<std::size_t>(information.size()) && each > 0; ++i) {
    const std::string fault =
        fault_of_information(Eigen::Map<const Rows>(information.data() + i * each, size, size));
    if (!fault.empty()) throw UsageError(fmt::format("information: {}{}", edge(i), fault));
  }
}

}  // namespace waymark::python
