/// The errors of Waymark as exceptions of Python.
#pragma once

namespace waymark::python {

/// Raises the errors of core/base/error.hpp as the classes of waymark/errors.py, which take the
/// file, line and column out of the message.
void register_errors();

}  // namespace waymark::python
