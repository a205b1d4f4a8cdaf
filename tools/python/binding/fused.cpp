#include <waymark/tools/python/binding/fused.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <pybind11/stl.h>

#include <waymark/core/registry/flow_text.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/tools/program/jobs/drive/drive_text.hpp>
#include <waymark/tools/python/binding/graph.hpp>
#include <waymark/tools/python/binding/numpy.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::python {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Columns of one table that grow row by row.
class Columns {
 public:
  void add(const char* name, std::int64_t number) { integers_[name].push_back(number); }
  void add(const char* name, double number) { numbers_[name].push_back(number); }
  void add(const char* name, const std::optional<double>& number) { add(name, number.value_or(kNone)); }
  void add(const char* name, const std::string& text) { texts_[name].append(text); }
  /// Adds a row of a column of vectors or of matrices.
  void add(const char* name, const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
    shapes_[name] = matrix.cols() == 1 ? std::vector<py::ssize_t>{matrix.rows()}
                                       : std::vector<py::ssize_t>{matrix.rows(), matrix.cols()};
    append(matrix, numbers_[name]);
  }
  template <typename Matrix>
  void add_or_none(const char* name, const std::optional<Matrix>& matrix) {
    add(name, matrix
                  ? Eigen::MatrixXd(*matrix)
                  : Eigen::MatrixXd::Constant(Matrix::RowsAtCompileTime, Matrix::ColsAtCompileTime, kNone));
  }

  /// Moves the columns into a dict of arrays.
  [[nodiscard]] py::dict take() {
    py::dict table;
    for (auto& [name, numbers] : integers_) table[name] = read_only(array_of(std::move(numbers)));
    for (auto& [name, numbers] : numbers_) {
      std::vector<py::ssize_t> shape = shapes_[name];
      py::ssize_t row = 1;
      for (const py::ssize_t size : shape) row *= size;
      shape.insert(shape.begin(), length(numbers) / row);
      table[name] = read_only(array_of(std::move(numbers), std::move(shape)));
    }
    for (auto& [name, texts] : texts_)
      table[name] = py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "str");
    return table;
  }

 private:
  std::map<const char*, std::vector<std::int64_t>> integers_;
  std::map<const char*, std::vector<double>> numbers_;
  std::map<const char*, py::list> texts_;
  std::map<const char*, std::vector<py::ssize_t>> shapes_;
};

std::optional<drive::Projection> projection_of(const formats::GraphDocument& document) {
  if (!document.frame || document.frame->zone == 0) return std::nullopt;
  return std::optional<drive::Projection>(std::in_place, *document.frame);
}

std::vector<VertexIndex> poses_of(const Graph& graph) {
  std::vector<VertexIndex> poses;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    if (stamped_pose(graph, v)) poses.push_back(v);
  return poses;
}

/// Returns the poses as a view of the values of the graph if they stand there one behind the other, as in
/// every drive; otherwise a copy. @param owner keeps the graph alive
py::array_t<double> pose_array(const Graph& graph, const std::vector<VertexIndex>& poses,
                               const py::object& owner) {
  bool in_a_row = true;
  for (std::size_t i = 1; i < poses.size(); ++i)
    in_a_row = in_a_row && graph.value(poses[i]).data() == graph.value(poses[i - 1]).data() + 3;
  if (in_a_row && !poses.empty())
    return read_only(
        py::array_t<double>({length(poses), py::ssize_t{3}}, graph.value(poses.front()).data(), owner));
  std::vector<double> numbers;
  for (const VertexIndex v : poses) {
    const auto value = graph.value(v);
    numbers.insert(numbers.end(), value.begin(), value.end());
  }
  return read_only(array_of(std::move(numbers), {length(poses), 3}));
}

/// Returns (n, 3, 3): the covariance of each pose, NaN where it is not known.
py::array_t<double> covariance_array(const formats::GraphDocument& document,
                                     const std::vector<VertexIndex>& poses) {
  std::vector<const Eigen::MatrixXd*> known(document.graph.vertex_count());
  for (const formats::VertexCovariance& block : document.covariances)
    known[static_cast<std::size_t>(block.vertex)] = &block.covariance;
  std::vector<double> numbers;
  numbers.reserve(9 * poses.size());
  for (const VertexIndex v : poses) {
    if (const Eigen::MatrixXd* covariance = known[static_cast<std::size_t>(v)]) {
      append(*covariance, numbers);
    } else {
      numbers.insert(numbers.end(), 9, kNone);
    }
  }
  return read_only(array_of(std::move(numbers), {length(poses), 3, 3}));
}

py::dict trajectory(const std::shared_ptr<Fused>& fused) {
  const formats::GraphDocument& document = fused->document();
  const std::vector<VertexIndex> poses = poses_of(document.graph);
  const auto projection = projection_of(document);
  std::vector<std::int64_t> stamps;
  std::vector<std::int64_t> ids;
  std::vector<double> places;
  for (const VertexIndex v : poses) {
    stamps.push_back(document.graph.stamp(v)->nanoseconds);
    ids.push_back(to_number(document.graph.id(v)));
    if (!projection) continue;
    const auto value = document.graph.value(v);
    const GeodeticPoint place = projection->to_geodetic({value[0], value[1]});
    places.insert(places.end(), {place.latitude_deg, place.longitude_deg});
  }
  if (!projection) places.assign(2 * poses.size(), kNone);
  py::dict table;
  table["time_ns"] = read_only(array_of(std::move(stamps)));
  table["id"] = read_only(array_of(std::move(ids)));
  table["pose"] = pose_array(document.graph, poses, py::cast(fused));
  table["place"] = read_only(array_of(std::move(places), {length(poses), 2}));
  table["covariance"] = covariance_array(document, poses);
  return table;
}

std::string source_name(const program::LoadedDrive& loaded, const Fix& fix) {
  return loaded.drive.receivers[static_cast<std::size_t>(fix.source)].name;
}

void add_fix(const Fix& fix, const evaluation::EpochResult& epoch, const std::string& source,
             Columns& columns) {
  columns.add("time_ns", fix.stamp.nanoseconds);
  columns.add("id", to_number(fix.vertex));
  columns.add("source", source);
  columns.add("status", std::string(to_string(fix.status)));
  columns.add("reason", fix.reason);
  columns.add("quality", std::string(to_string(fix.told.quality)));
  columns.add("position", fix.position);
  columns.add_or_none("place", epoch.raw_place
                                   ? std::optional(Eigen::Vector2d(epoch.raw_place->latitude_deg,
                                                                   epoch.raw_place->longitude_deg))
                                   : std::nullopt);
  columns.add("sigma", epoch.fix_sigma_m);
  columns.add_or_none("residual", epoch.fix_residual_m);
  columns.add("nis", epoch.nu);
  columns.add_or_none("error", epoch.gnss_offset_m);
  columns.add_or_none("fused_position", epoch.fused_position);
  columns.add_or_none("fused_covariance", epoch.position_covariance);
  columns.add_or_none("fused_error", epoch.fused_offset_m);
  columns.add("fused_heading_error", epoch.heading_error_rad);
  columns.add("nees", epoch.nees);
}

py::dict fixes(const Fused& fused) {
  const formats::GraphDocument& document = fused.document();
  const auto& epochs = fused.run().evaluation.evaluation.epochs;
  Columns columns;
  for (std::size_t i = 0; i < document.fixes.size(); ++i)
    add_fix(document.fixes[i], epochs[i], source_name(fused.all->run.loaded, document.fixes[i]), columns);
  return columns.take();
}

/// Returns the residuals of every edge, by type.
py::dict residuals(const Fused& fused) {
  evaluation::GraphResiduals all = evaluation::residuals_by_type(fused.document().graph, 0);
  py::dict types;
  for (evaluation::TypeResiduals& type : all.types) {
    Columns columns;
    for (const evaluation::EdgeResidual& edge : type.edges) {
      columns.add("time_ns", edge.stamp ? edge.stamp->nanoseconds : std::numeric_limits<std::int64_t>::min());
      columns.add("squared", edge.squared);
      columns.add("weight", edge.weight);
    }
    py::dict table = columns.take();
    const py::ssize_t dimension = length(type.components);
    table["whitened"] = read_only(array_of(std::move(type.whitened), {length(type.edges), dimension}));
    py::list components;
    for (const auto& component : type.components) components.append(component.name);
    table["components"] = components;
    table["role"] = evaluation::to_string(type.role);
    types[py::str(type.tag)] = table;
  }
  return types;
}

py::list states(const Fused& fused) {
  py::list all;
  for (const evaluation::StateReport& state : fused.run().states) {
    py::dict one;
    one["name"] = state.name;
    one["unit"] = state.unit;
    one["value"] = state.last;
    one["sigma"] = state.sigma;
    one["prior_sigma"] = state.prior_sigma;
    one["observed"] = state.observed;
    std::vector<std::int64_t> stamps;
    for (const Stamp& stamp : state.stamps) stamps.push_back(stamp.nanoseconds);
    one["time_ns"] = read_only(array_of(std::move(stamps)));
    one["values"] = read_only(array_of(std::vector<double>(state.wandering)));
    all.append(one);
  }
  return all;
}

py::object frame(const Fused& fused) {
  const auto& known = fused.document().frame;
  if (!known || known->zone == 0) return py::none();
  py::dict frame;
  frame["utm_zone"] = known->north ? known->zone : -known->zone;
  frame["origin"] = py::make_tuple(known->origin_easting_m, known->origin_northing_m);
  return frame;
}

std::vector<std::string> files(const Fused& fused) {
  std::vector<std::string> all = fused.run().written.files;
  if (!fused.run().written.page.empty()) all.push_back(fused.run().written.page);
  const auto& common = fused.all->run.common_files;
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

}  // namespace

py::dict summary_of(const MultiStartSummary& result) {
  const Summary& s = result.summary;
  py::dict summary;
  summary["converged"] = s.converged();
  summary["termination"] = std::string(to_string(s.termination));
  summary["message"] = s.message;
  summary["initial_chi2"] = s.initial_chi2;
  summary["chi2"] = s.final_chi2;
  summary["iterations"] = s.iterations;
  summary["start"] = result.start;
  summary["algorithm"] = s.algorithm;
  summary["solver"] = s.solver;
  summary["unknowns"] = s.unknowns;
  summary["seconds"] = result.total_seconds;
  summary["notes"] = s.notes;
  std::vector<double> chi2;
  for (const IterationRecord& record : s.records) chi2.push_back(record.chi2);
  summary["chi2_of_steps"] = read_only(array_of(std::move(chi2)));
  return summary;
}

void bind_fused(py::module_& module) {
  py::class_<Fused, std::shared_ptr<Fused>>(module, "Fused")
      .def_property_readonly("modeling", [](const Fused& fused) { return fused.run().evaluation.label; })
      .def("summary", [](const Fused& fused) { return summary_of(fused.run().result); })
      .def("trajectory", &trajectory)
      .def("fixes", &fixes)
      .def("residuals", &residuals)
      .def("states", &states)
      .def("frame", &frame)
      .def("files", &files)
      .def("noise_json", [](const Fused& fused) { return program::noise_json(fused.run().noise).dump(); })
      .def("metrics_json", [](const Fused& fused) { return fused.all->run.metrics; })
      .def("time_scale",
           [](const Fused& fused) { return std::string(to_string(fused.document().time_scale)); })
      .def("warnings", [](const Fused& fused) { return fused.all->warnings; })
      .def("notes", [](const Fused& fused) { return fused.all->notes; })
      .def("provenance", [](const Fused& fused) { return fused.document().provenance; })
      .def("graph", [](const Fused& fused) { return PythonGraph(fused.document(), fused.all->registry); });
}

}  // namespace waymark::python
