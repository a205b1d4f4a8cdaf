/// The batch of run-time arity: a Gaussian over any number of vertices of any types.
/// Marginalisation (fixed lag) creates such priors. A user can also state a full-covariance prior
/// over several states.
#pragma once

#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace WAYMARK_EXPORT waymark {

/// The error over vertices x_1..x_k is e = [local(r_1, x_1); ...; local(r_k, x_k)] - d,
/// stacked in order, with reference values r and offset d. In text, the fields are the values
/// r_1..r_k and then d.
class GaussianPriorBatch final : public EdgeBatchBase {
 public:
  static constexpr std::string_view kTag = "EDGE_GAUSSIAN_PRIOR";

  [[nodiscard]] std::unique_ptr<EdgeBatchBase> clone() const override;
  [[nodiscard]] std::size_t size() const override { return records_.size(); }
  [[nodiscard]] std::span<const VertexIndex> vertices(std::size_t i) const override {
    return records_[i].vertices;
  }
  [[nodiscard]] int error_dimension(std::size_t i) const override;
  void append(std::span<const VertexIndex> vertices, std::span<const VertexType* const> types,
              std::span<const double> fields, const Eigen::MatrixXd& information) override;
  void fields(std::size_t i, std::vector<double>& out) const override;
  [[nodiscard]] Eigen::MatrixXd information(std::size_t i) const override { return records_[i].information; }
  using EdgeBatchBase::chi2;
  [[nodiscard]] double chi2(const ValueView& view, EdgeRange range) const override;
  double linearize(const ValueView& view, const Scatter& scatter, EdgeRange range,
                   const NormalView& normal) const override;
  void linearize_edge(std::size_t i, const ValueView& view, Eigen::VectorXd& error,
                      std::vector<Eigen::MatrixXd>& jacobians) const override;
  void add_rigid_information(const ValueView& view, const RigidMotionView& motion) const override;

 private:
  struct Record {
    std::vector<VertexIndex> vertices;
    std::vector<VertexType> types;
    std::vector<double> reference;  // values of all vertices
    Eigen::VectorXd offset;
    Eigen::MatrixXd information;
    // its first place in the scatter; it depends on the edges before
    std::size_t first_gradient = 0;
    std::size_t first_block = 0;
  };

  void remove_records(std::span<const char> gone, std::span<const VertexIndex> new_index) override;
  void add_record(Record record);
  static Eigen::VectorXd error(const Record& record, const ValueView& view);
  static Eigen::MatrixXd jacobian(const Record& record, std::size_t vertex, const ValueView& view);

  std::vector<Record> records_;
};

[[nodiscard]] EdgeType gaussian_prior_type();

}  // namespace waymark
