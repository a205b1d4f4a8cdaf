#include <algorithm>

#include <Eigen/Core>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/linear/detail/chain_kernels.hpp>

namespace waymark {
namespace {

using detail::at;

using Matrix = Eigen::Map<Eigen::MatrixXd>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

// A product of zeros may be -0. Adding this removes the sign.
constexpr double kPlainZero = 0.0;

}  // namespace

/// Selected inversion (Takahashi, Fagan, Chin 1973; Erisman, Tinney 1975) by supernodes from the
/// roots down. The part of the inverse that a supernode needs is in the front of its parent.
/// Inverses of fronts are on a stack as long as children need them. For a chain the stack holds
/// only the block of its first link.
class BlockCholesky::DiagonalInverse {
 public:
  DiagonalInverse(const BlockCholesky& owner, std::span<double* const> blocks)
      : factor_(owner.factor_.data()), symbolic_(owner.symbolic_), blocks_(blocks) {}

  void run() {
    find_needed();
    for (int s = static_cast<int>(symbolic_.nodes.size()) - 1; s >= 0; --s) {
      if (!needed_[at(s)]) continue;
      const Supernode& node = symbolic_.nodes[at(s)];
      node.links > 0 ? invert_chain(node) : invert_front(node);
      keep(s, node.links > 0 ? Supernode::kLinkSize : node.columns + node.below);
    }
  }

 private:
  /// The whole inverse of a front on the stack.
  struct Open {
    int node = -1;
    int rows = 0;
    std::int64_t begin = 0;
  };

  /// Rows of a supernode that are also adjacent in the front of its parent.
  struct Run {
    int own = 0;     // first row below the supernode's columns
    int parent = 0;  // first row in the front of the parent
    int length = 0;
  };

  void find_needed() {
    needed_.assign(symbolic_.nodes.size(), 0);
    waiting_.assign(symbolic_.nodes.size(), 0);
    for (std::size_t s = 0; s < needed_.size(); ++s) {
      const Supernode& node = symbolic_.nodes[s];
      for (int k = node.first; k < node.last && !needed_[s]; ++k) {
        needed_[s] = blocks_[at(symbolic_.column[at(k)])] != nullptr;
      }
      if (!needed_[s] || node.parent < 0) continue;
      needed_[at(node.parent)] = 1;
      ++waiting_[at(node.parent)];
    }
  }

  /// Returns space above the open fronts for the inverse of the current supernode.
  double* room(int rows) {
    top_ = open_.empty() ? 0 : open_.back().begin + std::int64_t{open_.back().rows} * open_.back().rows;
    const std::size_t size = at(top_ + std::int64_t{rows} * rows);
    if (stack_.size() < size) stack_.resize(std::max(size, 2 * stack_.size()));
    return stack_.data() + top_;
  }

  /// Takes the parent off the stack if this was its last child. Keeps the new inverse if
  /// children follow.
  void keep(int s, int rows) {
    const std::int64_t made = top_;
    if (symbolic_.nodes[at(s)].parent >= 0 && --waiting_[at(open_.back().node)] == 0) {
      top_ = open_.back().begin;
      open_.pop_back();
    }
    if (waiting_[at(s)] == 0) return;
    std::copy_n(stack_.data() + made, std::int64_t{rows} * rows, stack_.data() + top_);
    open_.push_back({s, rows, top_});
  }

  [[nodiscard]] ConstMatrix parent_inverse() const {
    const Open& parent = open_.back();
    return {stack_.data() + parent.begin, parent.rows, parent.rows, Eigen::OuterStride<>(parent.rows)};
  }

  static void spread(const LinkInverse& z, double* block) {
    constexpr unsigned kPlace[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (unsigned i = 0; i < 9; ++i) block[i] = z[kPlace[i]] + kPlainZero;
  }

  void invert_chain(const Supernode& chain) {
    double* first = room(Supernode::kLinkSize);
    const auto position = symbolic_.position[at(chain.rows)];
    const auto next = parent_inverse().block<3, 3>(position, position);
    LinkInverse z = {next(0, 0), next(1, 0), next(2, 0), next(1, 1), next(2, 1), next(2, 2)};
    const double* factor = factor_ + chain.panel;
    for (int link = chain.links - 1; link >= 0; --link) {
      invert_link(factor + std::int64_t{link} * Supernode::kLinkNumbers, z);
      double* block = blocks_[at(symbolic_.column[at(chain.first + link)])];
      if (block != nullptr) spread(z, block);
    }
    spread(z, first);
  }

  /// Fills the part of the inverse for the rows below, from the front of the parent.
  void gather(const Supernode& front, Matrix& inverse) {
    runs_.clear();
    int row = 0;
    for (int i = 0; i < front.row_count; ++i) {
      const int size = symbolic_.size[at(symbolic_.rows[at(front.rows + i)])];
      const int position = symbolic_.position[at(front.rows + i)];
      if (!runs_.empty() && runs_.back().parent + runs_.back().length == position) {
        runs_.back().length += size;
      } else {
        runs_.push_back({row, position, size});
      }
      row += size;
    }
    const ConstMatrix parent = parent_inverse();
    for (const Run& b : runs_) {
      for (const Run& a : runs_) {
        inverse.block(front.columns + a.own, front.columns + b.own, a.length, b.length) =
            parent.block(a.parent, b.parent, a.length, b.length);
      }
    }
  }

  // With L = U R^-1, U of unit diagonal and R the reciprocals: Y = U21 U11^-1, Z21 = -Z22 Y,
  // Z11 = (R U11^-1)^T (R U11^-1) - Y^T Z21.
  void invert_front(const Supernode& front) {
    const int columns = front.columns;
    const int below = front.below;
    const int height = columns + below;
    Matrix inverse(room(height), height, height);
    if (below > 0) gather(front, inverse);
    const ConstMatrix factor(factor_ + front.panel, height, columns, Eigen::OuterStride<>(front.stride));
    work_.resize(std::max(work_.size(), at(std::int64_t{height + columns} * columns)));
    Matrix unit(work_.data(), height, columns);
    Matrix own(work_.data() + std::int64_t{height} * columns, columns, columns);
    unit = factor * factor.diagonal().asDiagonal();
    const auto lower = unit.topRows(columns).triangularView<Eigen::UnitLower>();
    own.setIdentity();
    lower.solveInPlace(own);
    own = factor.diagonal().asDiagonal() * own;
    inverse.topLeftCorner(columns, columns).noalias() = own.transpose() * own;
    if (below > 0) {
      auto y = unit.bottomRows(below);
      auto z21 = inverse.bottomLeftCorner(below, columns);
      lower.solveInPlace<Eigen::OnTheRight>(y);
      z21.noalias() = inverse.bottomRightCorner(below, below) * -y;
      inverse.topLeftCorner(columns, columns).noalias() -= y.transpose() * z21;
      inverse.topRightCorner(columns, below) = z21.transpose();
    }
    auto z11 = inverse.topLeftCorner(columns, columns);
    for (int c = 1; c < columns; ++c) z11.col(c).head(c) = z11.row(c).head(c).transpose();
    for (int k = front.first, row = 0; k < front.last; row += symbolic_.size[at(k)], ++k) {
      const int size = symbolic_.size[at(k)];
      double* block = blocks_[at(symbolic_.column[at(k)])];
      if (block == nullptr) continue;
      Matrix(block, size, size) = (z11.block(row, row, size, size).array() + kPlainZero).matrix();
    }
  }

  const double* factor_;
  const BlockSymbolic& symbolic_;
  std::span<double* const> blocks_;
  std::vector<char> needed_;  // per supernode: its inverse, or that of a descendant, is wanted
  std::vector<int> waiting_;  // needed children that are not processed yet
  std::vector<Open> open_;    // the last one is the parent of the current supernode
  LargeArray<double> stack_;  // inverses of the open fronts
  std::int64_t top_ = 0;      // begin of the current inverse
  std::vector<Run> runs_;
  LargeArray<double> work_;
};

void BlockCholesky::invert_diagonal(std::span<double* const> blocks) const {
  DiagonalInverse(*this, blocks).run();
}

}  // namespace waymark
