#include <algorithm>
#include <utility>

#include <waymark/core/base/guard.hpp>
#include <waymark/core/graph/edge_batch.hpp>

namespace waymark {

EdgeBatchBase::~EdgeBatchBase() = default;

int EdgeType::field_size() const {
  int total = 0;
  for (const FieldInfo& field : fields) total += field.size;
  return total;
}

void EdgeBatchBase::set_loss(std::size_t edge, Loss loss) {
  edge_loss_.resize(std::max(edge_loss_.size(), edge + 1), -1);
  auto known = std::find(losses_.begin(), losses_.end(), loss);
  if (known == losses_.end()) known = losses_.insert(losses_.end(), std::move(loss));
  edge_loss_[edge] = static_cast<std::int32_t>(known - losses_.begin());
}

void EdgeBatchBase::remove(std::span<const char> gone, std::span<const VertexIndex> new_index) {
  remove_records(gone, new_index);
  const std::vector<Loss> losses = std::exchange(losses_, {});
  const std::vector<std::int32_t> chosen = std::exchange(edge_loss_, {});
  std::size_t kept = 0;
  for (std::size_t e = 0; e < chosen.size(); ++e) {
    if (gone[e] != 0) continue;
    if (chosen[e] >= 0) set_loss(kept, losses[static_cast<std::size_t>(chosen[e])]);
    ++kept;
  }
}

namespace {

std::string numbered(std::string_view tag, std::size_t edge) {
  return std::string(tag) + " number " + std::to_string(edge + 1);
}

}  // namespace

std::string EdgeBatchBase::name_in(std::string_view tag, std::size_t edge, std::string_view function) {
  return numbered(tag, edge) + ": " + std::string(function);
}

void EdgeBatchBase::throw_edge_error(std::string_view tag, const ValueView& view, EdgeRange range) const {
  Eigen::VectorXd error;
  std::vector<Eigen::MatrixXd> jacobians;
  for (std::size_t edge = range.first; edge + 1 < range.last; ++edge) {
    try {
      linearize_edge(edge, view, error, jacobians);
      (void)evaluate_loss(edge, error.dot(information(edge) * error));
    } catch (...) {
      throw_plugin_error(numbered(tag, edge), tag);
    }
  }
  throw_plugin_error(range.last > range.first ? numbered(tag, range.last - 1) : std::string(tag), tag);
}

const Loss* EdgeBatchBase::loss(std::size_t edge) const {
  if (edge < edge_loss_.size() && edge_loss_[edge] >= 0)
    return &losses_[static_cast<std::size_t>(edge_loss_[edge])];
  return batch_loss();
}

LossValue EdgeBatchBase::evaluate_loss(std::size_t edge, double squared) const {
  const Loss* chosen = loss(edge);
  if (chosen == nullptr) return {squared, 1, 0};
  return chosen->at(squared);
}

}  // namespace waymark
