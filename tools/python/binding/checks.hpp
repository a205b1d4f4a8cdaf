/// Numbers that no graph may hold, from Python as from a file: the readers refuse the same.
#pragma once

#include <span>

#include <waymark/core/graph/edge.hpp>
#include <waymark/core/graph/vertex.hpp>
#include <waymark/tools/python/binding/numpy.hpp>

namespace waymark::python {

/// @throws UsageError for a number that is not finite: "values: vertex 7: y is nan, ..."
void check_value(const VertexType& type, VertexId id, std::span<const double> value);

/// @param fields one row per edge
/// @throws UsageError for a number that is not finite: "fields: edge 3: measured[1] is inf, ..."
void check_fields(const EdgeType& type, const Numbers& fields, py::ssize_t edges);

/// @param information matrices of size x size, one per edge unless the only one is shared by all
/// @throws UsageError for a number that is not finite, and for a matrix that is indefinite or not symmetric
/// beyond rounding: "information: edge 3: ..."
void check_information(const Numbers& information, py::ssize_t size, bool is_shared);

}  // namespace waymark::python
