#include <algorithm>
#include <array>
#include <cmath>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/linear/detail/chain_kernels.hpp>
#include <waymark/core/linear/inverse_form.hpp>

namespace waymark {

using detail::at;

InverseForm::InverseForm(const BlockCholesky& factor)
    : symbolic_(factor.symbolic_),
      factor_(factor.factor_.data()),
      number_(symbolic_.column.size()),
      node_(symbolic_.column.size()),
      marked_(symbolic_.nodes.size(), 0),
      passed_(symbolic_.nodes.size(), 0) {
  for (std::size_t k = 0; k < number_.size(); ++k) number_[at(symbolic_.column[k])] = static_cast<int>(k);
  for (std::size_t s = 0; s < symbolic_.nodes.size(); ++s) {
    for (int k = symbolic_.nodes[s].first; k < symbolic_.nodes[s].last; ++k)
      node_[at(k)] = static_cast<int>(s);
  }
}

Eigen::MatrixXd InverseForm::operator()(std::span<const BlockRow> rows) {
  const Eigen::Index columns = rows.empty() ? 0 : rows.front().values.cols();
  form_.setZero(columns, columns);
  find_way(rows);
  std::int64_t passed = 0;
  for (const int s : way_) {
    passed_[at(s)] = passed;
    passed += symbolic_.nodes[at(s)].below;
  }
  vectors_.resize(std::max(vectors_.size(), at(passed * columns)));
  for (const int s : way_) {
    const Supernode& node = symbolic_.nodes[at(s)];
    front_.setZero(node.columns + node.below, columns);
    add_rows(node, rows);
    add_children(node);
    node.links > 0 ? substitute_chain(node) : substitute_front(node);
    Eigen::Map<Eigen::MatrixXd>(vectors_.data() + passed_[at(s)] * columns, node.below, columns) =
        front_.bottomRows(node.below);
  }
  for (const int s : way_) marked_[at(s)] = 0;
  return form_;
}

void InverseForm::find_way(std::span<const BlockRow> rows) {
  way_.clear();
  for (const BlockRow& row : rows) {
    for (int s = node_[at(number_[at(row.column)])]; s >= 0 && marked_[at(s)] == 0;
         s = symbolic_.nodes[at(s)].parent) {
      marked_[at(s)] = 1;
      way_.push_back(s);
    }
  }
  std::sort(way_.begin(), way_.end());
}

void InverseForm::add_rows(const Supernode& node, std::span<const BlockRow> rows) {
  for (const BlockRow& row : rows) {
    const int k = number_[at(row.column)];
    if (k < node.first || k >= node.last) continue;
    front_.middleRows(symbolic_.start[at(k)] - node.start, row.values.rows()) += row.values;
  }
}

void InverseForm::add_children(const Supernode& node) {
  const Eigen::Index columns = front_.cols();
  for (int c = node.first_child; c >= 0; c = symbolic_.nodes[at(c)].next_sibling) {
    if (marked_[at(c)] == 0) continue;
    const Supernode& child = symbolic_.nodes[at(c)];
    const Eigen::Map<const Eigen::MatrixXd> from(vectors_.data() + passed_[at(c)] * columns, child.below,
                                                 columns);
    Eigen::Index row = 0;
    for (int i = 0; i < child.row_count; ++i) {
      const int size = symbolic_.size[at(symbolic_.rows[at(child.rows + i)])];
      // the first link of a chain receives what its children pass on
      const int position = node.links > 0 ? 0 : symbolic_.position[at(child.rows + i)];
      front_.middleRows(position, size) += from.middleRows(row, size);
      row += size;
    }
  }
}

// The diagonal of a front is stored as reciprocals.
void InverseForm::substitute_front(const Supernode& node) {
  const Eigen::Index rest = node.below;
  const double* panel = factor_ + node.panel;
  for (int j = 0; j < node.columns; ++j) {
    const double* column = panel + std::int64_t{j} * node.stride;
    front_.row(j) *= column[j];
    const Eigen::Index below = node.columns + rest - j - 1;
    const Eigen::Map<const Eigen::VectorXd> factor(column + j + 1, below);
    front_.bottomRows(below).noalias() -= factor * front_.row(j);
  }
  form_.noalias() += front_.topRows(node.columns).transpose() * front_.topRows(node.columns);
}

// A chain is factorised as L D L^T, with the reciprocals of D. solve_link gives D^-1 L^-1 b.
void InverseForm::substitute_chain(const Supernode& node) {
  constexpr int kSize = Supernode::kLinkSize;
  for (Eigen::Index c = 0; c < front_.cols(); ++c) {
    std::array<double, 3> carry{};
    for (int link = 0; link < node.links; ++link) {
      LinkFactor<double> factor;
      std::copy_n(factor_ + node.panel + std::int64_t{link} * Supernode::kLinkNumbers, factor.size(),
                  factor.begin());
      std::array<double, 3> x;
      double* own = front_.col(c).data() + std::int64_t{link} * kSize;
      solve_link(factor, {own[0], own[1], own[2]}, carry, x);
      for (unsigned i = 0; i < kSize; ++i) own[i] = x[i] / std::sqrt(factor[kLinkPivots[i]]);
    }
    std::copy_n(carry.begin(), kSize, front_.col(c).data() + node.columns);
  }
  form_.noalias() += front_.topRows(node.columns).transpose() * front_.topRows(node.columns);
}

}  // namespace waymark
