/// Numbers between C++ and numpy. Arrays of results own no copy: numpy refers to the memory of C++ and
/// keeps it alive.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <Eigen/Core>

namespace waymark::python {

namespace py = pybind11;

/// An argument of numbers: any sequence, converted to float64 in rows if it is not that already.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

inline py::ssize_t length(const auto& container) {
  return static_cast<py::ssize_t>(container.size());
}

/// Returns an array that owns the numbers, which are moved.
/// @param shape its product is the number of numbers
template <typename Number>
[[nodiscard]] py::array_t<Number> array_of(std::vector<Number> numbers, std::vector<py::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<Number>>(std::move(numbers));
  const Number* data = owner->data();
  const py::capsule keeper(owner.get(), [](void* of) { delete static_cast<std::vector<Number>*>(of); });
  (void)owner.release();
  return py::array_t<Number>(std::move(shape), data, keeper);
}
template <typename Number>
[[nodiscard]] py::array_t<Number> array_of(std::vector<Number> numbers) {
  const py::ssize_t size = length(numbers);
  return array_of(std::move(numbers), {size});
}

/// Returns a matrix as an array of two dimensions, row by row.
[[nodiscard]] inline py::array_t<double> array_of(const Eigen::MatrixXd& matrix) {
  py::array_t<double> result({matrix.rows(), matrix.cols()});
  auto view = result.mutable_unchecked<2>();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) view(r, c) = matrix(r, c);
  return result;
}

/// Makes an array that refers to foreign memory read-only. @return the array
template <typename Array>
[[nodiscard]] Array read_only(Array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Appends the numbers of a matrix, row by row.
inline void append(const Eigen::Ref<const Eigen::MatrixXd>& matrix, std::vector<double>& numbers) {
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) numbers.push_back(matrix(r, c));
}

}  // namespace waymark::python
