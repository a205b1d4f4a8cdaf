#include <waymark/tools/python/binding/graph.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/graph/checks/gradient_check.hpp>
#include <waymark/formats/graph/detail/foreign_graph.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/tools/program/jobs/program_registry.hpp>
#include <waymark/tools/python/binding/checks.hpp>
#include <waymark/tools/python/binding/choices.hpp>
#include <waymark/tools/python/binding/fused.hpp>

namespace waymark::python {
namespace {

/// The types of Waymark and of the installed plugins, for graphs that begin in Python.
std::shared_ptr<const TypeRegistry> default_registry() {
  static const auto registry = std::make_shared<const TypeRegistry>(
      program::make_registry(program::CommonOptions{.quiet = true, .plugins = {}}));
  return registry;
}

template <typename Type>
[[noreturn]] void throw_unknown(const char* kind, const std::string& tag, const RegistryTable<Type>& table) {
  std::vector<std::string_view> known;
  for (const Registered<Type>& entry : table) known.push_back(entry.type.tag);
  throw UsageError(fmt::format("there is no {} '{}'{}", kind, tag, did_you_mean(tag, known)));
}

void require_size(const char* name, py::ssize_t size, py::ssize_t expected) {
  if (size != expected)
    throw UsageError(fmt::format("{}: expected {} numbers, got {}", name, expected, size));
}

std::span<const double> row(const Numbers& numbers, py::ssize_t index, py::ssize_t size) {
  return {numbers.data() + index * size, static_cast<std::size_t>(size)};
}

formats::GraphFormat format_of(const std::string& word) {
  if (const auto format = formats::graph_format_from_string(word)) return *format;
  throw UsageError(
      fmt::format("format: expected {}, got '{}'", fmt::join(formats::kGraphFormats, ", "), word));
}

}  // namespace

PythonGraph::Use::Use(PythonGraph& graph) : graph_(graph) {
  graph.require_free();
  graph.in_use_ = true;
}

void PythonGraph::require_free() const {
  if (in_use_) throw UsageError("the graph is in use: another thread, or an error function, works on it");
}

const VertexType& PythonGraph::vertex_type(const std::string& tag) const {
  if (const VertexType* type = registry_->find_vertex(tag)) return *type;
  throw_unknown("vertex type", tag, registry_->vertices());
}

const EdgeType& PythonGraph::edge_type(const std::string& tag) const {
  if (const EdgeType* type = registry_->find_edge(tag)) return *type;
  throw_unknown("edge type", tag, registry_->edges());
}

std::vector<VertexIndex> PythonGraph::find(const Integers& ids) const {
  std::vector<VertexIndex> found;
  for (py::ssize_t i = 0; i < ids.size(); ++i) {
    const auto vertex = document_.graph.find(VertexId{ids.data()[i]});
    if (!vertex) throw UsageError(fmt::format("there is no vertex {}", ids.data()[i]));
    found.push_back(*vertex);
  }
  return found;
}

void PythonGraph::add_edge_type(const SharedPythonEdge& edge) {
  require_free();
  if (std::find(python_edges_.begin(), python_edges_.end(), edge) != python_edges_.end()) return;
  for (const std::string& tag : edge->vertices) (void)vertex_type(tag);
  auto registry = std::make_shared<TypeRegistry>(*registry_);
  registry->set_origin("python");
  registry->add_edge(edge_type_of(edge));
  registry_ = std::move(registry);
  python_edges_.push_back(edge);
}

void PythonGraph::add_vertices(const std::string& type, const Integers& ids, const Numbers& values,
                               const std::optional<Integers>& stamps_ns) {
  require_free();
  const VertexType& of = vertex_type(type);
  require_size("values", values.size(), ids.size() * of.value_size);
  if (stamps_ns) require_size("time", stamps_ns->size(), ids.size());
  for (py::ssize_t i = 0; i < ids.size(); ++i)
    check_value(of, VertexId{ids.data()[i]}, row(values, i, of.value_size));
  for (py::ssize_t i = 0; i < ids.size(); ++i) {
    const VertexIndex v =
        document_.graph.add_vertex(of, VertexId{ids.data()[i]}, row(values, i, of.value_size));
    if (stamps_ns) document_.graph.set_stamp(v, {stamps_ns->data()[i]});
  }
}

std::size_t PythonGraph::add_edges(const std::string& type, const Integers& vertices, const Numbers& fields,
                                   const Numbers& information, const std::optional<std::string>& loss) {
  require_free();
  const EdgeType& of = edge_type(type);
  if (vertices.ndim() != 2) throw UsageError("vertices: expected one row of ids per edge");
  const py::ssize_t count = vertices.shape(0);
  const std::vector<VertexIndex> joined = find(vertices);
  const auto arity = static_cast<std::size_t>(vertices.shape(1));
  const py::ssize_t given = count == 0 ? 0 : fields.size() / count;
  if (of.arity != EdgeType::kRuntimeArity) require_size("fields", fields.size(), count * of.field_size());
  const py::ssize_t size = information.ndim() < 2 ? 1 : information.shape(information.ndim() - 1);
  const bool is_shared = information.size() == size * size && information.ndim() < 3;
  if (!is_shared) require_size("information", information.size(), count * size * size);
  check_fields(of, fields, count);
  check_information(information, size, is_shared);
  const std::optional<Loss> robust =
      loss ? std::optional(drive::named_loss(*loss, "loss", *registry_)) : std::nullopt;
  const std::size_t first = document_.graph.batch(of).size();
  for (py::ssize_t i = 0; i < count; ++i) {
    const Eigen::MatrixXd matrix =
        Eigen::Map<const Eigen::MatrixXd>(information.data() + (is_shared ? 0 : i * size * size), size, size);
    const EdgePlace place =
        document_.graph.add_edge(of, std::span(joined).subspan(static_cast<std::size_t>(i) * arity, arity),
                                 row(fields, i, given), matrix);
    if (robust) document_.graph.set_loss(place, *robust);
  }
  return first;
}

void PythonGraph::set_values(const Integers& ids, const Numbers& values) {
  require_free();
  const std::vector<VertexIndex> found = find(ids);
  py::ssize_t total = 0;
  for (const VertexIndex v : found) total += document_.graph.vertex_type(v).value_size;
  require_size("values", values.size(), total);
  Graph& graph = document_.graph;
  const auto visit = [&](const auto& use) {
    const double* next = values.data();
    for (const VertexIndex v : found) {
      const auto size = static_cast<std::size_t>(graph.vertex_type(v).value_size);
      use(v, std::span(next, size));
      next += size;
    }
  };
  visit([&](VertexIndex v, auto value) { check_value(graph.vertex_type(v), graph.id(v), value); });
  visit([&](VertexIndex v, auto value) { graph.set_value(v, value); });
}

void PythonGraph::set_fixed(const Integers& ids, bool is_fixed) {
  require_free();
  for (const VertexIndex v : find(ids)) document_.graph.set_fixed(v, is_fixed);
}

py::dict PythonGraph::vertex_types() const {
  require_free();
  py::dict types;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(document_.graph.vertex_count()); ++v) {
    const py::str tag(document_.graph.vertex_type(v).tag);
    types[tag] = types.contains(tag) ? py::cast<int>(types[tag]) + 1 : 1;
  }
  return types;
}

py::dict PythonGraph::edge_types() const {
  require_free();
  py::dict types;
  for (std::size_t b = 0; b < document_.graph.batch_count(); ++b)
    types[py::str(document_.graph.edge_type(b).tag)] = document_.graph.batch(b).size();
  return types;
}

py::dict PythonGraph::vertices(const std::string& type) const {
  require_free();
  const Graph& graph = document_.graph;
  const VertexType& of = vertex_type(type);
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> stamps;
  std::vector<double> values;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != type) continue;
    ids.push_back(to_number(graph.id(v)));
    stamps.push_back(graph.stamp(v).value_or(Stamp{std::numeric_limits<std::int64_t>::min()}).nanoseconds);
    const auto value = graph.value(v);
    values.insert(values.end(), value.begin(), value.end());
  }
  py::dict table;
  const py::ssize_t count = length(ids);
  table["id"] = array_of(std::move(ids));
  table["time_ns"] = array_of(std::move(stamps));
  table["value"] = array_of(std::move(values), {count, of.value_size});
  table["names"] = of.value_names;
  return table;
}

py::dict PythonGraph::edges(const std::string& type) const {
  require_free();
  const Graph& graph = document_.graph;
  py::dict table;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeType& of = graph.edge_type(b);
    const EdgeBatchBase& batch = graph.batch(b);
    if (of.tag != type) continue;
    if (of.arity == EdgeType::kRuntimeArity) throw UsageError(type + ": its edges differ in size");
    std::vector<std::int64_t> ids;
    std::vector<double> fields;
    std::vector<double> informations;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      for (const VertexIndex v : batch.vertices(e)) ids.push_back(to_number(graph.id(v)));
      batch.fields(e, fields);
      append(batch.information(e), informations);
    }
    const py::ssize_t count = static_cast<py::ssize_t>(batch.size());
    table["vertices"] = array_of(std::move(ids), {count, of.arity});
    table["fields"] = array_of(std::move(fields), {count, of.field_size()});
    table["information"] = array_of(std::move(informations), {count, of.error_dimension, of.error_dimension});
    return table;
  }
  (void)edge_type(type);
  throw UsageError("the graph has no edge of type " + type);
}

py::array_t<double> PythonGraph::value(std::int64_t id) const {
  require_free();
  const auto vertex = document_.graph.find(VertexId{id});
  if (!vertex) throw UsageError(fmt::format("there is no vertex {}", id));
  const auto value = document_.graph.value(*vertex);
  return array_of(std::vector<double>(value.begin(), value.end()));
}

double PythonGraph::chi2() {
  const Use use(*this);
  const py::gil_scoped_release release;
  return document_.graph.chi2();
}

py::dict PythonGraph::optimize(const py::dict& choice, const py::object& progress) {
  const drive::Minimization how = minimization_of(choice);
  drive::check_minimization(how, *registry_);
  Host host(progress);
  const Use use(*this);
  const MultiStartSummary result = host.run([&] {
    const drive::MinimizationWatch watch{
        .observer = [&](const IterationRecord& record) { host.step(record); }, .cancel = &host.cancel()};
    return drive::minimize(document_.graph, how, *registry_, watch);
  });
  document_.covariances.clear();
  return summary_of(result);
}

py::list PythonGraph::marginals(const Integers& ids) {
  const std::vector<VertexIndex> wanted = find(ids);
  CovarianceBlocks blocks;
  {
    const Use use(*this);
    const py::gil_scoped_release release;
    blocks = marginal_covariances(document_.graph, wanted);
  }
  py::list all;
  for (std::size_t i = 0; i < blocks.size(); ++i) all.append(array_of(Eigen::MatrixXd(blocks[i])));
  return all;
}

py::array_t<double> PythonGraph::joint_marginal(const Integers& ids) {
  const std::vector<VertexIndex> wanted = find(ids);
  Eigen::MatrixXd joint;
  {
    const Use use(*this);
    const py::gil_scoped_release release;
    Marginals marginals(document_.graph);
    joint = marginals.joint(wanted);
  }
  return array_of(joint);
}

std::vector<std::string> PythonGraph::check_derivatives() {
  constexpr std::size_t kMost = 100;
  const Use use(*this);
  const py::gil_scoped_release release;
  std::vector<std::string> wrong;
  for (std::size_t b = 0; b < document_.graph.batch_count(); ++b) {
    const GradientCheck check = check_gradients(document_.graph, b, kMost);
    if (check.error > kGradientTolerance) wrong.push_back(describe(document_.graph, b, check));
  }
  return wrong;
}

PythonGraph PythonGraph::read(const std::string& path, const std::string& format, bool lenient,
                              const std::vector<SharedPythonEdge>& edge_types,
                              std::vector<std::string>& warnings) {
  PythonGraph graph({}, default_registry());
  for (const SharedPythonEdge& edge : edge_types) graph.add_edge_type(edge);
  const formats::GraphFormat as = format_of(format);
  formats::ReadReport report;
  {
    const py::gil_scoped_release release;
    graph.document_ =
        formats::read_graph_as(as, formats::read_text_file(path), path, *graph.registry_, lenient, &report);
  }
  if (report.skipped > 0)
    warnings.push_back(fmt::format("{} lines were skipped; the first ones: {}", report.skipped,
                                   fmt::join(report.examples, "; ")));
  return graph;
}

void PythonGraph::write(const std::string& path, const std::string& format, const std::string& profile) {
  const formats::GraphFormat as = format_of(format);
  const formats::Recipient* recipient = formats::find_profile(profile);
  if (!profile.empty() && recipient == nullptr)
    throw UsageError("profile: expected g2o, gtsam, ceres or toro, got '" + profile + "'");
  const Use use(*this);
  const py::gil_scoped_release release;
  if (as == formats::GraphFormat::graph && recipient == nullptr) {
    formats::write_file_atomically(
        path, [&](const formats::TextSink& sink) { formats::write_graph(document_, *registry_, sink); });
    return;
  }
  const formats::Recipient& reader = recipient != nullptr ? *recipient : formats::any_reader(as);
  const formats::ForeignGraph foreign(
      document_, "the graph", reader,
      recipient != nullptr && as == formats::GraphFormat::graph ? reader.formats.front() : as);
  formats::write_file_atomically(path, [&](const formats::TextSink& sink) { foreign.write(sink); });
}

PythonGraph PythonGraph::copy() const {
  require_free();
  PythonGraph graph(document_, registry_);
  graph.python_edges_ = python_edges_;
  return graph;
}

void bind_graph(py::module_& module) {
  py::class_<PythonGraph>(module, "Graph")
      .def(py::init([] { return PythonGraph({}, default_registry()); }))
      .def("add_edge_type",
           [](PythonGraph& graph, const std::shared_ptr<PythonEdge>& edge) { graph.add_edge_type(edge); })
      .def("add_vertices", &PythonGraph::add_vertices)
      .def("add_edges", &PythonGraph::add_edges)
      .def("set_values", &PythonGraph::set_values)
      .def("set_fixed", &PythonGraph::set_fixed)
      .def("vertex_types", &PythonGraph::vertex_types)
      .def("edge_types", &PythonGraph::edge_types)
      .def("vertices", &PythonGraph::vertices)
      .def("edges", &PythonGraph::edges)
      .def("value", &PythonGraph::value)
      .def("chi2", &PythonGraph::chi2)
      .def("optimize", &PythonGraph::optimize)
      .def("marginals", &PythonGraph::marginals)
      .def("joint_marginal", &PythonGraph::joint_marginal)
      .def("check_derivatives", &PythonGraph::check_derivatives)
      .def("write", &PythonGraph::write)
      .def("copy", &PythonGraph::copy)
      .def_static("read", [](const std::string& path, const std::string& format, bool lenient,
                             const std::vector<std::shared_ptr<PythonEdge>>& edge_types) {
        std::vector<std::string> warnings;
        PythonGraph graph =
            PythonGraph::read(path, format, lenient, {edge_types.begin(), edge_types.end()}, warnings);
        return std::make_pair(std::move(graph), warnings);
      });
}

}  // namespace waymark::python
