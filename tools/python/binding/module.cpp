#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/python/binding/edges.hpp>
#include <waymark/tools/python/binding/errors.hpp>
#include <waymark/tools/python/binding/fused.hpp>
#include <waymark/tools/python/binding/graph.hpp>
#include <waymark/version.hpp>

namespace waymark::python {
namespace {

template <typename Type, typename Name>
std::vector<std::string> names_of(const RegistryTable<Type>& table, const Name& name) {
  std::vector<std::string> names;
  for (const Registered<Type>& entry : table) names.push_back(name(entry.type));
  return names;
}

/// Returns the names of everything that is registered, by kind.
py::dict registered(const std::vector<std::string>& plugins) {
  const TypeRegistry registry =
      program::make_registry(program::CommonOptions{.quiet = true, .plugins = plugins});
  const auto name = [](const auto& type) { return type.name; };
  const auto tag = [](const auto& type) { return type.tag; };
  py::dict all;
  all["modelings"] = names_of(registry.gnss_modelings(), name);
  all["odometry_models"] = names_of(registry.odometry_models(), name);
  all["sensors"] = names_of(registry.sensor_models(), name);
  all["algorithms"] = names_of(registry.algorithms(), name);
  all["solvers"] = names_of(registry.linear_solvers(), name);
  all["losses"] = names_of(registry.losses(), name);
  all["starts"] = names_of(registry.starts(), name);
  all["log_formats"] = names_of(registry.log_readers(), name);
  all["vertices"] = names_of(registry.vertices(), tag);
  all["edges"] = names_of(registry.edges(), tag);
  return all;
}

}  // namespace
}  // namespace waymark::python

PYBIND11_MODULE(_waymark, module) {
  namespace own = waymark::python;
  module.attr("version") = WAYMARK_VERSION;
  own::register_errors();
  own::bind_edges(module);
  own::bind_graph(module);
  own::bind_fused(module);
  own::bind_fusion(module);
  module.def("registered", &own::registered);
}
