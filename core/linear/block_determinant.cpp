#include <cmath>

#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/linear/detail/chain_kernels.hpp>

namespace waymark {

// The factor stores reciprocals: of the pivots D in L D L^T of a chain, and of the diagonal of
// L in a front.
double BlockCholesky::log_determinant() const {
  double sum = 0;
  for (const Supernode& node : symbolic_.nodes) {
    const double* numbers = factor_.data() + node.panel;
    for (int link = 0; link < node.links; ++link, numbers += Supernode::kLinkNumbers) {
      for (const unsigned pivot : kLinkPivots) sum -= std::log(numbers[pivot]);
    }
    if (node.links > 0) continue;
    for (int c = 0; c < node.columns; ++c) sum -= 2 * std::log(numbers[std::int64_t{node.stride} * c + c]);
  }
  return sum;
}

}  // namespace waymark
