#include <waymark/tools/python/binding/edges.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/detail/dense_edge.hpp>
#include <waymark/tools/python/binding/numpy.hpp>

namespace waymark::python {
namespace {

/// Of differences. Errors of some thousand metres are rounded to 1e-12; at this step rounding and
/// curvature both cost the derivatives about 1e-8 of the error.
constexpr double kStep = 1e-4;

std::size_t count_of(EdgeRange range) {
  return range.last - range.first;
}

/// Returns the derivative from the errors before, here and after. An angle that is wrapped jumps by a full
/// turn on one side only; the other side then tells.
template <typename Rows>
Rows slope(const Rows& before, const Rows& here, const Rows& after) {
  constexpr double kJump = 3;  // of the second difference; that of a smooth error is below 1e-6
  Rows change(here.rows(), here.cols());
  for (Eigen::Index i = 0; i < here.size(); ++i) {
    const double left = here.data()[i] - before.data()[i];
    const double right = after.data()[i] - here.data()[i];
    const bool jumps = std::abs(right - left) > kJump;
    const double both = jumps ? 2 * (std::abs(left) < std::abs(right) ? left : right) : left + right;
    change.data()[i] = both / (2 * kStep);
  }
  return change;
}

/// Returns a row as an array of one dimension, or a number.
py::object row_of(const double* numbers, std::size_t size, bool as_number) {
  if (as_number) return py::float_(*numbers);
  return py::array_t<double>(static_cast<py::ssize_t>(size), numbers);
}

/// Takes the numbers that a function has returned. @throws UsageError for another count
Numbers returned(const PythonEdge& type, const char* function, const py::object& result,
                 py::ssize_t expected) {
  Numbers numbers;
  try {
    numbers = py::cast<Numbers>(result);
  } catch (const py::cast_error&) {
    throw UsageError(fmt::format("{}: {} returned no array of numbers but {}", type.tag, function,
                                 py::cast<std::string>(py::repr(result))));
  }
  if (numbers.size() != expected)
    throw UsageError(fmt::format("{}: {} returned {} numbers where {} are expected", type.tag, function,
                                 numbers.size(), expected));
  return numbers;
}

}  // namespace

SharedPythonEdge make_python_edge(PythonEdge edge) {
  return {new PythonEdge(std::move(edge)), [](const PythonEdge* of) {
            if (Py_IsInitialized() == 0) return;  // the process ends, and its memory with it
            const py::gil_scoped_acquire acquire;
            delete of;
          }};
}

EdgeType edge_type_of(const SharedPythonEdge& edge) {
  EdgeType type;
  type.tag = edge->tag;
  type.form = "python";
  type.arity = static_cast<int>(edge->vertices.size());
  type.vertex_tags = edge->vertices;
  type.error_dimension = edge->dimension;
  type.fields = edge->fields;
  type.make_batch = [edge] { return std::make_unique<PythonEdgeBatch>(edge); };
  return type;
}

std::size_t PythonEdgeBatch::field_size() const {
  std::size_t size = 0;
  for (const FieldInfo& field : type_->fields) size += static_cast<std::size_t>(field.size);
  return size;
}

void PythonEdgeBatch::append(std::span<const VertexIndex> vertices, std::span<const VertexType* const> types,
                             std::span<const double> fields, const Eigen::MatrixXd& information) {
  if (types_.empty())
    for (const VertexType* type : types) types_.push_back(*type);
  vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
  fields_.insert(fields_.end(), fields.begin(), fields.end());
  informations_.push_back(information);
}

void PythonEdgeBatch::fields(std::size_t edge, std::vector<double>& out) const {
  const double* first = fields_.data() + edge * field_size();
  out.insert(out.end(), first, first + field_size());
}

void PythonEdgeBatch::remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) {
  const PythonEdgeBatch before = *this;
  vertices_.clear();
  fields_.clear();
  informations_.clear();
  for (std::size_t edge = 0; edge < before.size(); ++edge) {
    if (gone[edge] != 0) continue;
    for (const VertexIndex v : before.vertices(edge))
      vertices_.push_back(new_index[static_cast<std::size_t>(v)]);
    before.fields(edge, fields_);
    informations_.push_back(before.informations_[edge]);
  }
}

PythonEdgeBatch::Values PythonEdgeBatch::values(const ValueView& view, EdgeRange range) const {
  Values all;
  for (std::size_t k = 0; k < arity(); ++k) {
    Rows& rows = all.emplace_back(static_cast<Eigen::Index>(count_of(range)), types_[k].value_size);
    for (std::size_t i = 0; i < count_of(range); ++i) {
      const VertexIndex vertex = vertices_[(range.first + i) * arity() + k];
      std::copy_n(view.values + view.offsets[vertex], types_[k].value_size,
                  rows.row(static_cast<Eigen::Index>(i)).data());
    }
  }
  return all;
}

py::tuple PythonEdgeBatch::arguments(const Values& values, EdgeRange range, std::size_t row) const {
  py::tuple all(arity() + type_->fields.size());
  const bool many = type_->vectorized;
  const auto count = static_cast<py::ssize_t>(count_of(range));
  for (std::size_t k = 0; k < arity(); ++k) {
    const Rows& rows = values[k];
    all[k] = many ? py::object(py::array_t<double>({count, rows.cols()}, rows.data()))
                  : row_of(rows.data() + row * static_cast<std::size_t>(rows.cols()),
                           static_cast<std::size_t>(rows.cols()), false);
  }
  std::size_t offset = 0;
  for (std::size_t f = 0; f < type_->fields.size(); ++f) {
    const auto size = static_cast<std::size_t>(type_->fields[f].size);
    const double* first = fields_.data() + (range.first + (many ? 0 : row)) * field_size() + offset;
    if (many) {
      const auto stride = static_cast<py::ssize_t>(field_size() * sizeof(double));
      constexpr auto kNumber = static_cast<py::ssize_t>(sizeof(double));
      all[arity() + f] =
          size == 1 ? py::array_t<double>({count}, {stride}, first)
                    : py::array_t<double>({count, static_cast<py::ssize_t>(size)}, {stride, kNumber}, first);
    } else {
      all[arity() + f] = row_of(first, size, size == 1);
    }
    offset += size;
  }
  return all;
}

PythonEdgeBatch::Rows PythonEdgeBatch::errors(const Values& values, EdgeRange range) const {
  const std::size_t count = count_of(range);
  const auto dimension = static_cast<std::size_t>(type_->dimension);
  Rows result(static_cast<Eigen::Index>(count), type_->dimension);
  const std::size_t calls = type_->vectorized ? 1 : count;
  const std::size_t each = type_->vectorized ? count * dimension : dimension;
  for (std::size_t call = 0; call < calls; ++call) {
    try {
      const py::object error = type_->error(*arguments(values, range, call));
      const Numbers numbers = returned(*type_, "error", error, static_cast<py::ssize_t>(each));
      std::copy_n(numbers.data(), each, result.data() + call * each);
    } catch (py::error_already_set& error) {
      raise_at(range.first + call, error);
    }
  }
  return result;
}

PythonEdgeBatch::Jacobians PythonEdgeBatch::given_jacobians(const Values& values, EdgeRange range) const {
  Jacobians all(arity(), std::vector<Eigen::MatrixXd>(count_of(range)));
  const std::size_t calls = type_->vectorized ? 1 : count_of(range);
  const std::size_t edges = type_->vectorized ? count_of(range) : 1;
  for (std::size_t call = 0; call < calls; ++call) {
    try {
      const py::object given = type_->jacobians(*arguments(values, range, call));
      const auto matrices = py::cast<py::sequence>(given);
      if (matrices.size() != arity())
        throw UsageError(fmt::format("{}: jacobians returned {} matrices for {} vertices", type_->tag,
                                     matrices.size(), arity()));
      for (std::size_t k = 0; k < arity(); ++k) {
        const Eigen::Index size = Eigen::Index{type_->dimension} * types_[k].tangent_size;
        const Numbers numbers =
            returned(*type_, "jacobians", matrices[k], static_cast<py::ssize_t>(edges) * size);
        for (std::size_t e = 0; e < edges; ++e)
          all[k][call + e] = Eigen::Map<const Rows>(numbers.data() + static_cast<Eigen::Index>(e) * size,
                                                    type_->dimension, types_[k].tangent_size);
      }
    } catch (py::error_already_set& error) {
      raise_at(range.first + call, error);
    }
  }
  return all;
}

PythonEdgeBatch::Jacobians PythonEdgeBatch::differences(const Values& values, const Rows& here,
                                                        EdgeRange range) const {
  const auto count = static_cast<Eigen::Index>(count_of(range));
  Jacobians all;
  for (std::size_t k = 0; k < arity(); ++k) {
    const int tangent = types_[k].tangent_size;
    all.emplace_back(count_of(range), Eigen::MatrixXd(type_->dimension, tangent));
    for (int column = 0; column < tangent; ++column) {
      const auto errors_at = [&](double step) {
        Values moved = values;
        const Eigen::VectorXd delta = step * Eigen::VectorXd::Unit(tangent, column);
        for (Eigen::Index i = 0; i < count; ++i) types_[k].retract(moved[k].row(i).data(), delta.data());
        return errors(moved, range);
      };
      const Rows change = slope(errors_at(-kStep), here, errors_at(kStep));
      for (Eigen::Index i = 0; i < count; ++i)
        all[k][static_cast<std::size_t>(i)].col(column) = change.row(i).transpose();
    }
  }
  return all;
}

PythonEdgeBatch::Jacobians PythonEdgeBatch::jacobians(const Values& values, const Rows& here,
                                                      EdgeRange range) const {
  return type_->jacobians.is_none() ? differences(values, here, range) : given_jacobians(values, range);
}

void PythonEdgeBatch::raise_at(std::size_t edge, py::error_already_set& error) const {
  const std::string place = type_->vectorized ? fmt::format("in {}", type_->tag)
                                              : fmt::format("in {} number {}", type_->tag, edge + 1);
  error.value().attr("add_note")(place);
  throw error;
}

double PythonEdgeBatch::chi2(const ValueView& view, EdgeRange range) const {
  if (range.first == range.last) return 0;
  const py::gil_scoped_acquire acquire;
  const Rows all = errors(values(view, range), range);
  double sum = 0;
  for (std::size_t i = 0; i < count_of(range); ++i) {
    const Eigen::VectorXd e = all.row(static_cast<Eigen::Index>(i)).transpose();
    sum += evaluate_loss(range.first + i, e.dot(informations_[range.first + i] * e)).rho;
  }
  return sum;
}

double PythonEdgeBatch::linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                                  const NormalView& normal) const {
  if (range.first == range.last) return 0;
  const py::gil_scoped_acquire acquire;
  const Values at = values(view, range);
  const Rows all = errors(at, range);
  const Jacobians derivatives = jacobians(at, all, range);
  const std::size_t pairs = arity() * (arity() + 1) / 2;
  std::vector<Eigen::MatrixXd> of_edge(arity());
  double sum = 0;
  for (std::size_t i = 0; i < count_of(range); ++i) {
    const std::size_t edge = range.first + i;
    const Eigen::VectorXd e = all.row(static_cast<Eigen::Index>(i)).transpose();
    for (std::size_t k = 0; k < arity(); ++k) of_edge[k] = derivatives[k][i];
    const LossValue loss = evaluate_loss(edge, e.dot(informations_[edge] * e));
    sum += detail::add_dense_edge(e, of_edge, informations_[edge], loss,
                                  scatter.gradient.data() + edge * arity(),
                                  scatter.blocks.data() + edge * pairs, normal);
  }
  return sum;
}

void PythonEdgeBatch::linearize_edge(std::size_t edge, const ValueView& view, Eigen::VectorXd& error,
                                     std::vector<Eigen::MatrixXd>& jacobians_of_edge) const {
  const py::gil_scoped_acquire acquire;
  const EdgeRange range{static_cast<std::uint32_t>(edge), static_cast<std::uint32_t>(edge + 1)};
  const Values at = values(view, range);
  const Rows here = errors(at, range);
  error = here.row(0).transpose();
  jacobians_of_edge.clear();
  for (std::vector<Eigen::MatrixXd>& of_vertex : jacobians(at, here, range))
    jacobians_of_edge.push_back(std::move(of_vertex.front()));
}

void PythonEdgeBatch::add_rigid_information(const ValueView& view, const RigidMotionView& motion) const {
  if (size() == 0) return;
  const py::gil_scoped_acquire acquire;
  const EdgeRange range{0, static_cast<std::uint32_t>(size())};
  const Values at = values(view, range);
  const Jacobians derivatives = jacobians(at, errors(at, range), range);
  for (std::size_t edge = 0; edge < size(); ++edge) {
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(type_->dimension, 3);
    std::int32_t component = -1;
    for (std::size_t k = 0; k < arity(); ++k) {
      const VertexIndex vertex = vertices(edge)[k];
      const std::int32_t own = motion.component[vertex];
      if (own < 0) continue;
      component = own;
      Eigen::MatrixXd columns(types_[k].tangent_size, 3);
      types_[k].rigid_motion(view.values + view.offsets[vertex], motion.places[own].centre,
                             motion.places[own].extent, columns.data());
      moved += derivatives[k][edge] * columns;
    }
    if (component >= 0) motion.information[component] += moved.transpose() * informations_[edge] * moved;
  }
}

void bind_edges(py::module_& module) {
  py::class_<PythonEdge, std::shared_ptr<PythonEdge>>(module, "EdgeFunctions")
      .def(py::init([](std::string tag, std::vector<std::string> vertices, int dimension,
                       const std::vector<std::pair<std::string, int>>& fields, py::function error,
                       py::object jacobians, bool vectorized) {
             PythonEdge edge{std::move(tag),   std::move(vertices),  dimension, {},
                             std::move(error), std::move(jacobians), vectorized};
             for (const auto& [name, size] : fields) edge.fields.push_back({name, size});
             return std::const_pointer_cast<PythonEdge>(make_python_edge(std::move(edge)));
           }),
           py::arg("tag"), py::arg("vertices"), py::arg("dimension"), py::arg("fields"), py::arg("error"),
           py::arg("jacobians"), py::arg("vectorized"))
      .def_readonly("tag", &PythonEdge::tag);
}

}  // namespace waymark::python
