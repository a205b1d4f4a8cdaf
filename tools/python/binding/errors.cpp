#include <waymark/tools/python/binding/errors.hpp>

#include <exception>

#include <pybind11/pybind11.h>

#include <waymark/core/base/error.hpp>

namespace waymark::python {
namespace {

namespace py = pybind11;

void raise_as(const char* name, const std::exception& error) {
  const py::object type = py::module_::import("waymark.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(error.what()).ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const UsageError& error) {
    raise_as("UsageError", error);
  } catch (const InputError& error) {
    raise_as("InputError", error);
  } catch (const OutputError& error) {
    raise_as("OutputError", error);
  } catch (const PluginError& error) {
    raise_as("PluginError", error);
  } catch (const Error& error) {
    raise_as("Error", error);
  }
}

}  // namespace

void register_errors() {
  py::register_exception_translator(translate);
}

}  // namespace waymark::python
