/// Choices that Python hands over in a dict.
#pragma once

#include <string>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::python {

/// Reads an entry if it is there and not None. @return whether it is
template <typename Value>
bool take(const pybind11::dict& given, const char* key, Value& value) {
  if (!given.contains(key) || given[key].is_none()) return false;
  value = pybind11::cast<Value>(given[key]);
  return true;
}

/// Reads how a graph is minimised: the names of the members of Minimization. @throws UsageError
[[nodiscard]] drive::Minimization minimization_of(const pybind11::dict& given);

}  // namespace waymark::python
