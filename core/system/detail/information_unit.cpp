#include <waymark/core/system/detail/information_unit.hpp>

#include <algorithm>

namespace waymark {

double information_unit(const Graph& graph) {
  double largest = 0;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const EdgeBatchBase& batch = graph.batch(b);
    for (std::size_t edge = 0; edge < batch.size(); ++edge) {
      const Eigen::VectorXd diagonal = batch.information(edge).diagonal();
      // not maxCoeff(), which is undefined for NaN
      for (Eigen::Index i = 0; i < diagonal.size(); ++i) largest = std::max(largest, diagonal[i]);
      if (largest >= 1) return 1;
    }
  }
  return largest > 0 ? largest : 1;
}

}  // namespace waymark
