#include <algorithm>
#include <cmath>
#include <map>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/detail/processor.hpp>
#include <waymark/core/window/detail/front.hpp>

namespace waymark::detail {
namespace {

/// Factorises a small matrix in place: its lower triangle becomes the root. Column by column.
[[nodiscard]] bool factorize_pivot(double* lower, int size) {
  for (int c = 0; c < size; ++c) {
    double pivot = lower[c * size + c];
    // Rounding may leave a small positive number of a pivot that is zero.
    const double whole = pivot;
    for (int k = 0; k < c; ++k) pivot -= lower[k * size + c] * lower[k * size + c];
    if (!(pivot > 1e-14 * whole) || !std::isfinite(pivot)) return false;
    pivot = std::sqrt(pivot);
    lower[c * size + c] = pivot;
    for (int r = c + 1; r < size; ++r) {
      double sum = lower[c * size + r];
      for (int k = 0; k < c; ++k) sum -= lower[k * size + r] * lower[k * size + c];
      lower[c * size + r] = sum / pivot;
    }
  }
  return true;
}

/// to[i] = from[i] - sum_k w_k[i] f_k, where w_k are rows of length `count`.
template <int kSize>
[[gnu::always_inline]] inline void subtract(double* to, const double* from, const double* rows, int stride,
                                            const double* factors, int size, int count) {
  const int n = kSize > 0 ? kSize : size;
  // `to` may lie before `from` in the same column: each number is read before its place is written.
  for (int i = 0; i < count; ++i) {
    double sum = from[i];
    for (int k = 0; k < n; ++k) sum -= rows[k * stride + i] * factors[k];
    to[i] = sum;
  }
}

}  // namespace

void FrontPanels::clear() {
  panels_.clear();
  numbers_.clear();
  others_.clear();
}

void FrontPanels::cut(std::size_t first) {
  if (first >= panels_.size()) return;
  numbers_.resize(at(panels_[first].numbers));
  others_.resize(at(panels_[first].others));
  panels_.resize(first);
}

void FrontPanels::solve(std::size_t first, std::size_t last, std::span<double> step) const {
  for (std::size_t p = last; p-- > first;) {
    const Panel& panel = panels_[p];
    const int size = panel.size;
    const double* lower = numbers_.data() + panel.numbers;
    const double* y = lower + size * size;
    const double* w = y + size;
    const std::int32_t* others = others_.data() + panel.others;
    double* own = step.data() + panel.own;
    for (int k = 0; k < size; ++k) {
      double sum = -y[k];
      for (int i = 0; i < panel.rest; ++i) sum -= w[k * panel.rest + i] * step[at(others[i])];
      own[k] = sum;
    }
    for (int k = size; k-- > 0;) {
      for (int r = k + 1; r < size; ++r) own[k] -= lower[k * size + r] * own[r];
      own[k] /= lower[k * size + k];
    }
  }
}

double FrontPanels::decrement(std::size_t first) const {
  double sum = 0;
  for (const Panel& panel : std::span(panels_).subspan(first)) {
    const double* y = numbers_.data() + panel.numbers + panel.size * panel.size;
    for (int k = 0; k < panel.size; ++k) sum += y[k] * y[k];
  }
  return sum;
}

Eigen::MatrixXd FrontPanels::triangle(std::size_t first) const {
  std::map<std::int32_t, Eigen::Index> column_of;  // by place in the step
  Eigen::Index dimension = 0;
  for (std::size_t p = first; p < panels_.size(); ++p)
    for (std::int32_t k = 0; k < panels_[p].size; ++k) column_of[panels_[p].own + k] = dimension++;
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(dimension, dimension);
  for (std::size_t p = first; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    const double* lower = numbers_.data() + panel.numbers;
    const double* w = lower + panel.size * panel.size + panel.size;
    const Eigen::Index own = column_of.at(panel.own);
    for (int k = 0; k < panel.size; ++k) {
      for (int r = k; r < panel.size; ++r) root(own + k, own + r) = lower[k * panel.size + r];
      for (int i = 0; i < panel.rest; ++i)
        root(own + k, column_of.at(others_[at(panel.others + i)])) = w[k * panel.rest + i];
    }
  }
  return root;
}

Front::Saved Front::save() const {
  Saved saved{members_, {}, {gradient_.begin(), gradient_.begin() + dimension_}};
  saved.lower.reserve(at(dimension_ * dimension_));
  for (int c = 0; c < dimension_; ++c)
    saved.lower.insert(saved.lower.end(), number(0, c), number(0, c) + dimension_);
  return saved;
}

void Front::restore(const Saved& saved) {
  members_ = saved.members;
  dimension_ = static_cast<int>(saved.gradient.size());
  if (dimension_ > capacity_) grow();
  for (int c = 0; c < dimension_; ++c)
    std::copy_n(saved.lower.data() + at(c) * at(dimension_), dimension_, number(0, c));
  std::copy(saved.gradient.begin(), saved.gradient.end(), gradient_.begin());
}

void Front::move_reference(std::span<const double> step) {
  for (int r = 0; r < dimension_; ++r)
    for (int c = 0; c < dimension_; ++c)
      gradient_[at(r)] += (r >= c ? *number(r, c) : *number(c, r)) * step[at(c)];
}

void Front::clear() {
  members_.clear();
  dimension_ = 0;
}

int Front::enter(VertexIndex v, int size, std::int32_t step) {
  const int row = dimension_;
  members_.push_back({v, row, size, step});
  dimension_ += size;
  if (dimension_ > capacity_) grow();
  for (int c = 0; c < dimension_; ++c) {
    const int from = std::max(row, c);
    std::fill(number(from, c), number(dimension_, c), 0.0);
  }
  std::fill(gradient_.begin() + row, gradient_.begin() + dimension_, 0.0);
  return row;
}

void Front::grow() {
  const int before = capacity_;
  capacity_ = std::max(32, 2 * dimension_);
  std::vector<double> larger(at(capacity_) * at(capacity_), 0.0);
  for (int c = 0; c < before; ++c)
    std::copy_n(lower_.data() + at(c) * at(before), before, larger.data() + at(c) * at(capacity_));
  lower_ = std::move(larger);
  gradient_.resize(at(capacity_), 0.0);
}

template <int kSize>
[[gnu::always_inline]] inline bool Front::eliminate_rows(int first, FrontPanels& panels,
                                                         FrontPanels::Panel& panel) {
  const int size = kSize > 0 ? kSize : panel.size;
  const int rest = panel.rest;
  if (factors_.size() < at(size)) factors_.resize(at(size));
  panels.numbers_.resize(at(panel.numbers) + at(size * size + size + size * rest));
  double* lower = panels.numbers_.data() + panel.numbers;
  double* y = lower + size * size;
  double* w = y + size;
  for (int c = 0; c < size; ++c)
    for (int r = c; r < size; ++r) lower[c * size + r] = *number(first + r, first + c);
  if (!factorize_pivot(lower, size)) return false;
  for (int k = 0; k < size; ++k) {
    y[k] = gradient_[at(first + k)];
    for (int i = 0; i < first; ++i) w[k * rest + i] = *number(first + k, i);
    std::copy_n(number(first + size, first + k), rest - first, w + k * rest + first);
    for (int j = 0; j < k; ++j) {
      const double factor = lower[j * size + k];
      y[k] -= factor * y[j];
      for (int i = 0; i < rest; ++i) w[k * rest + i] -= factor * w[j * rest + i];
    }
    const double inverse = 1 / lower[k * size + k];
    y[k] *= inverse;
    for (int i = 0; i < rest; ++i) w[k * rest + i] *= inverse;
  }
  // The rest moves up to the place of the vertex, and loses what the vertex took.
  for (int j = 0; j < rest; ++j) {
    const int from = j < first ? j : j + size;
    double* factors = factors_.data();
    for (int k = 0; k < size; ++k) factors[k] = w[k * rest + j];
    if (j < first) subtract<kSize>(number(j, j), number(j, from), w + j, rest, factors, size, first - j);
    const int below = std::max(j, first);
    subtract<kSize>(number(below, j), number(below + size, from), w + below, rest, factors, size,
                    rest - below);
    double sum = gradient_[at(from)];
    for (int k = 0; k < size; ++k) sum -= factors[k] * y[k];
    gradient_[at(j)] = sum;
  }
  return true;
}

[[gnu::always_inline]] inline bool Front::eliminate_any(int first, FrontPanels& panels,
                                                        FrontPanels::Panel& panel) {
  switch (panel.size) {
    case 1:
      return eliminate_rows<1>(first, panels, panel);
    case 2:
      return eliminate_rows<2>(first, panels, panel);
    case 3:
      return eliminate_rows<3>(first, panels, panel);
    default:
      return eliminate_rows<0>(first, panels, panel);
  }
}

bool Front::eliminate_plain(int first, FrontPanels& panels, FrontPanels::Panel& panel) {
  return eliminate_any(first, panels, panel);
}

#if defined(__x86_64__)
// The same, compiled for processors with fused multiply-add.
[[gnu::target("avx2,fma")]] bool Front::eliminate_fused(int first, FrontPanels& panels,
                                                        FrontPanels::Panel& panel) {
  return eliminate_any(first, panels, panel);
}
#endif

bool Front::eliminate(VertexIndex v, FrontPanels& panels) {
  const auto own = std::find_if(members_.begin(), members_.end(),
                                [&](const Member& member) { return member.vertex == v; });
  if (own == members_.end()) return false;
  const Member gone = *own;
  FrontPanels::Panel panel;
  panel.numbers = static_cast<std::int64_t>(panels.numbers_.size());
  panel.others = static_cast<std::int64_t>(panels.others_.size());
  panel.own = gone.step;
  panel.size = gone.size;
  panel.rest = dimension_ - gone.size;
  for (const Member& member : members_) {
    if (member.vertex == v) continue;
    for (int i = 0; i < member.size; ++i) panels.others_.push_back(member.step + i);
  }
#if defined(__x86_64__)
  if (!(has_fused_multiply() ? eliminate_fused(gone.row, panels, panel)
                             : eliminate_plain(gone.row, panels, panel)))
    return false;
#else
  if (!eliminate_plain(gone.row, panels, panel)) return false;
#endif
  panels.panels_.push_back(panel);
  members_.erase(own);
  for (Member& member : members_)
    if (member.row > gone.row) member.row -= gone.size;
  dimension_ -= gone.size;
  return true;
}

}  // namespace waymark::detail
