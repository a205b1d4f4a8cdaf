/// Edge types written in Python: an error as a function of arrays, derivatives by differences or given.
/// They are slower than those of C++ by the calls of Python, and have the same minimum.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>
#include <Eigen/Core>

#include <waymark/core/graph/edge_batch.hpp>

namespace waymark::python {

namespace py = pybind11;

/// An edge type of Python. The functions get an array for each vertex, then one for each field (a float
/// for a field of one number). A function that is vectorised gets those of many edges at once, with one
/// more dimension in front, and returns as many errors.
struct PythonEdge {
  std::string tag;
  std::vector<std::string> vertices;  ///< tags of their types
  int dimension = 0;                  ///< of the error
  std::vector<FieldInfo> fields;
  py::function error;
  /// returns the derivatives of the error by the tangent of each vertex; None: by differences
  py::object jacobians;
  bool vectorized = false;
};

/// Owns an edge type. Its last owner may be a graph that ends without the lock of the interpreter.
using SharedPythonEdge = std::shared_ptr<const PythonEdge>;

[[nodiscard]] SharedPythonEdge make_python_edge(PythonEdge edge);
[[nodiscard]] EdgeType edge_type_of(const SharedPythonEdge& edge);

/// The edges of one type. Every pass over edges takes the lock of the interpreter.
class PythonEdgeBatch final : public EdgeBatchBase {
 public:
  explicit PythonEdgeBatch(SharedPythonEdge type) : type_(std::move(type)) {}

  [[nodiscard]] std::unique_ptr<EdgeBatchBase> clone() const override {
    return std::make_unique<PythonEdgeBatch>(*this);
  }
  [[nodiscard]] std::size_t size() const override { return informations_.size(); }
  [[nodiscard]] std::span<const VertexIndex> vertices(std::size_t edge) const override {
    return {vertices_.data() + edge * arity(), arity()};
  }
  [[nodiscard]] int error_dimension(std::size_t) const override { return type_->dimension; }
  [[nodiscard]] VertexTable vertex_table() const override {
    return {vertices_.data(), arity() * sizeof(VertexIndex), static_cast<int>(arity())};
  }
  void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const> types,
              std::span<const double> fields, const Eigen::MatrixXd& information) override;
  void fields(std::size_t edge, std::vector<double>& out) const override;
  [[nodiscard]] Eigen::MatrixXd information(std::size_t edge) const override { return informations_[edge]; }

  using EdgeBatchBase::chi2;
  /// @throws what the functions raise, as the exception of Python
  [[nodiscard]] double chi2(const ValueView& view, EdgeRange range) const override;
  double linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                   const NormalView& normal) const override;
  void linearize_edge(std::size_t edge, const ValueView& view, Eigen::VectorXd& error,
                      std::vector<Eigen::MatrixXd>& jacobians) const override;
  void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const override;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// The values of the vertices of some edges: one matrix per vertex of an edge, one row per edge.
  using Values = std::vector<Rows>;
  /// The derivatives of some edges: per vertex of an edge, one matrix per edge.
  using Jacobians = std::vector<std::vector<Eigen::MatrixXd>>;

  void remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) override;
  [[nodiscard]] std::size_t arity() const { return type_->vertices.size(); }
  [[nodiscard]] std::size_t field_size() const;
  [[nodiscard]] Values values(const ValueView& view, EdgeRange range) const;
  /// Returns the arguments of a call: of all edges of the range, or of one of them.
  [[nodiscard]] py::tuple arguments(const Values& values, EdgeRange range, std::size_t row) const;
  [[nodiscard]] Rows errors(const Values& values, EdgeRange range) const;
  [[nodiscard]] Jacobians given_jacobians(const Values& values, EdgeRange range) const;
  /// @param here the errors at these values
  [[nodiscard]] Jacobians differences(const Values& values, const Rows& here, EdgeRange range) const;
  [[nodiscard]] Jacobians jacobians(const Values& values, const Rows& here, EdgeRange range) const;
  /// Adds the place of an edge to the exception that is being handled, and raises it again.
  [[noreturn]] void raise_at(std::size_t edge, py::error_already_set& error) const;

  SharedPythonEdge type_;
  std::vector<VertexType> types_;      // per vertex of an edge
  std::vector<VertexIndex> vertices_;  // arity() per edge
  std::vector<double> fields_;         // field_size() per edge
  std::vector<Eigen::MatrixXd> informations_;
};

void bind_edges(py::module_& module);

}  // namespace waymark::python
