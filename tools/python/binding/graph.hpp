/// Graphs as Python sees them: build, read, write, optimise, marginals.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/python/binding/edges.hpp>
#include <waymark/tools/python/binding/host.hpp>
#include <waymark/tools/python/binding/numpy.hpp>

namespace waymark::python {

/// A graph document and the types that it may hold. Functions that work release the lock of the
/// interpreter; another thread that uses the graph meanwhile gets an error.
class PythonGraph {
 public:
  PythonGraph(formats::GraphDocument document, std::shared_ptr<const TypeRegistry> registry)
      : document_(std::move(document)), registry_(std::move(registry)) {}

  /// Makes an edge type of Python known to this graph. Doing so again is no error.
  /// @throws UsageError for another type with its tag, and for vertex types that do not exist
  void add_edge_type(const SharedPythonEdge& edge);
  /// @param values one row per vertex @param stamps empty: none
  void add_vertices(const std::string& type, const Integers& ids, const Numbers& values,
                    const std::optional<Integers>& stamps_ns);
  /// @param vertices ids, one row per edge @param fields one row per edge
  /// @param information of each edge (n, d, d), or of all (d, d)
  /// @param loss "NAME:SCALE" @return the numbers of the first edge among those of its type
  std::size_t add_edges(const std::string& type, const Integers& vertices, const Numbers& fields,
                        const Numbers& information, const std::optional<std::string>& loss);
  void set_values(const Integers& ids, const Numbers& values);
  void set_fixed(const Integers& ids, bool is_fixed);

  /// Returns the tag of each vertex type and edge type, and how many there are.
  [[nodiscard]] py::dict vertex_types() const;
  [[nodiscard]] py::dict edge_types() const;
  [[nodiscard]] py::dict vertices(const std::string& type) const;
  [[nodiscard]] py::dict edges(const std::string& type) const;
  [[nodiscard]] py::array_t<double> value(std::int64_t id) const;

  [[nodiscard]] double chi2();
  [[nodiscard]] py::dict optimize(const py::dict& choice, const py::object& progress);
  /// Returns the covariance of each vertex in the chart of its type.
  [[nodiscard]] py::list marginals(const Integers& ids);
  [[nodiscard]] py::array_t<double> joint_marginal(const Integers& ids);
  /// Compares derivatives with differences. Returns a sentence for each edge type that differs.
  [[nodiscard]] std::vector<std::string> check_derivatives();

  [[nodiscard]] static PythonGraph read(const std::string& path, const std::string& format, bool lenient,
                                        const std::vector<SharedPythonEdge>& edge_types,
                                        std::vector<std::string>& warnings);
  void write(const std::string& path, const std::string& format, const std::string& profile);
  [[nodiscard]] PythonGraph copy() const;

 private:
  /// Marks the graph as in use while the lock of the interpreter is released.
  class Use {
   public:
    explicit Use(PythonGraph& graph);
    ~Use() { graph_.in_use_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    PythonGraph& graph_;
  };

  void require_free() const;
  /// Returns the type or null. @throws UsageError for an unknown tag
  [[nodiscard]] const VertexType& vertex_type(const std::string& tag) const;
  [[nodiscard]] const EdgeType& edge_type(const std::string& tag) const;
  [[nodiscard]] std::vector<VertexIndex> find(const Integers& ids) const;

  formats::GraphDocument document_;
  std::shared_ptr<const TypeRegistry> registry_;
  std::vector<SharedPythonEdge> python_edges_;
  bool in_use_ = false;  // read and written with the lock of the interpreter
};

void bind_graph(py::module_& module);

}  // namespace waymark::python
