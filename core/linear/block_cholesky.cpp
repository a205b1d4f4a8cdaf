#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include <waymark/core/base/detail/index.hpp>
#include <waymark/core/base/detail/thread_pool.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/linear/detail/chain_kernels.hpp>

namespace waymark {
namespace {

using detail::at;

using Column = Eigen::Map<Eigen::VectorXd>;
using ConstColumn = Eigen::Map<const Eigen::VectorXd>;

/// Kernels read up to this many numbers after the end of an array.
constexpr std::int64_t kSlack = 16;

/// Loads the numbers of one chain, or of two chains side by side.
double join(double a) {
  return a;
}
NumberPair join(double a, double b) {
  return NumberPair{a, b};
}
void split(double value, double* a) {
  *a = value;
}
void split(const NumberPair& value, double* a, double* b) {
  *a = value[0];
  *b = value[1];
}

bool is_pivot(double value) {
  return value > 0 && value <= std::numeric_limits<double>::max();
}
bool is_pivot(const NumberPair& value) {
  return is_pivot(value[0]) && is_pivot(value[1]);
}

/// A walk along the links of a chain.
struct Walk {
  int node = -1;
  int link = 0;
  LinkUpdate<double> carry{};  // in a solve, the first three
};

}  // namespace

/// Processes the supernodes of one subtree, or those above all subtrees.
class BlockCholesky::Stream {
 public:
  Stream(BlockCholesky& owner, int index) : owner_(owner), symbolic_(owner.symbolic_) {
    scratch_ = owner.work_.data() + symbolic_.start.back() +
               std::int64_t{index} * (symbolic_.largest_front + kSlack);
    if (index < static_cast<int>(symbolic_.subtrees.size())) {
      next_ = symbolic_.subtrees[at(index)].first;
      end_ = symbolic_.subtrees[at(index)].last;
    } else {
      list_ = symbolic_.top.data();
      end_ = static_cast<int>(symbolic_.top.size());
    }
  }

  [[nodiscard]] bool failed() const { return failed_; }

  /// Takes one stream to its end, or two. If both are at chains, their links are
  /// processed together.
  template <typename Pass>
  static void walk(const Pass& pass, Stream& one, Stream* two) {
    while (two != nullptr && one.goes_on() && two->goes_on()) {
      if (!pass.at_chain(one)) {
        pass.front(one);
      } else if (!pass.at_chain(*two)) {
        pass.front(*two);
      } else {
        pass.open(one);
        pass.open(*two);
        pass.template links<NumberPair>(std::min(pass.links_left(one), pass.links_left(*two)), one, *two);
        pass.close(one);
        pass.close(*two);
      }
    }
    while (one.goes_on()) step(pass, one);
    while (two != nullptr && two->goes_on()) step(pass, *two);
  }

  /// The work of a walk at each supernode. Factorisation and forward substitution visit them in
  /// ascending order.
  struct Ascending {
    [[nodiscard]] bool at_chain(const Stream& s) const { return s.node().links > 0; }
    [[nodiscard]] int links_left(const Stream& s) const { return s.node().links - s.walk_.link; }
  };
  struct Factorization : Ascending {
    const double* values;
    explicit Factorization(const double* numbers) : values(numbers) {}
    void front(Stream& s) const {
      s.factorize_front(values);
      ++s.next_;
    }
    void open(Stream& s) const { s.open_chain(); }
    void close(Stream& s) const { s.close_chain(); }
    template <typename T, typename... S>
    void links(int count, S&... stream) const {
      factorize_links<T>(values, count, stream...);
    }
  };
  struct Forward : Ascending {
    const double* b;
    explicit Forward(const double* right) : b(right) {}
    void front(Stream& s) const {
      s.solve_front(b);
      ++s.next_;
    }
    void open(Stream& s) const { s.open_solve(); }
    void close(Stream& s) const { s.close_solve(); }
    template <typename T, typename... S>
    void links(int count, S&... stream) const {
      solve_links<T>(b, count, stream...);
    }
  };
  /// Backward substitution visits them in descending order: `next_` stays and `end_` moves.
  struct Backward {
    double* x;
    [[nodiscard]] bool at_chain(const Stream& s) const { return s.last_node().links > 0; }
    [[nodiscard]] int links_left(const Stream& s) const { return s.last_node().links - s.walk_.link; }
    void front(Stream& s) const {
      s.solve_front_back(x);
      --s.end_;
    }
    void open(Stream& s) const { s.open_back(x); }
    void close(Stream& s) const { s.close_back(); }
    template <typename T, typename... S>
    void links(int count, S&... stream) const {
      solve_links_back<T>(x, count, stream...);
    }
  };

 private:
  [[nodiscard]] bool goes_on() const { return next_ != end_ && !failed_; }

  template <typename Pass>
  static void step(const Pass& pass, Stream& stream) {
    if (!pass.at_chain(stream)) return pass.front(stream);
    pass.open(stream);
    pass.template links<double>(pass.links_left(stream), stream);
    pass.close(stream);
  }

  [[nodiscard]] int index_of(int i) const { return list_ == nullptr ? i : list_[i]; }
  [[nodiscard]] const Supernode& node() const { return symbolic_.nodes[at(index_of(next_))]; }
  [[nodiscard]] const Supernode& last_node() const { return symbolic_.nodes[at(index_of(end_ - 1))]; }

  [[nodiscard]] double* factor_at(const Supernode& node, int link) const {
    return owner_.factor_.data() + node.panel + std::int64_t{link} * Supernode::kLinkNumbers;
  }

  template <typename Visit>
  void for_each_child(const Supernode& node, Visit visit) const {
    for (int c = node.first_child; c >= 0; c = symbolic_.nodes[at(c)].next_sibling)
      visit(symbolic_.nodes[at(c)]);
  }

  /// The places of the lower triangle in the update of a chain, with columns of stride 4.
  static constexpr std::array<int, 6> kLower = {0, 1, 2, 5, 6, 10};

  void open_chain() {
    const int index = index_of(next_);
    if (walk_.node == index) return;
    walk_ = Walk{index, 0, {}};
    for_each_child(node(), [&](const Supernode& child) {
      const double* update = owner_.updates_.data() + child.update;
      for (unsigned i = 0; i < 6; ++i)
        walk_.carry[i] -= update[kLower[i]];  // updates are added, carries are subtracted
    });
  }

  void close_chain() {
    const Supernode& chain = node();
    if (walk_.link < chain.links) return;
    double* update = owner_.updates_.data() + chain.update;
    for (unsigned i = 0; i < 6; ++i) update[kLower[i]] = -walk_.carry[i];
    walk_.node = -1;
    ++next_;
  }

  template <typename T, typename... S>
  static void factorize_links(const double* values, int count, S&... stream) {
    LinkUpdate<T> carry;
    for (unsigned i = 0; i < 6; ++i) carry[i] = join(stream.walk_.carry[i]...);
    bool ok = true;
    for (int n = 0; n < count; ++n) {
      const auto load = [&](auto... place) { return join(values[place]...); };
      const auto link =
          std::make_tuple(&stream.symbolic_.links[at(stream.node().entries + stream.walk_.link)]...);
      std::array<T, 6> diagonal;
      std::array<T, 9> below;
      std::apply(
          [&](const auto*... l) {
            unsigned i = 0;
            for (unsigned c = 0; c < 3; ++c) {
              for (unsigned r = c; r < 3; ++r) {
                diagonal[i++] = load(l->diagonal + c * static_cast<unsigned>(l->diagonal_stride) + r...);
              }
            }
            for (unsigned c = 0; c < 3; ++c) {
              for (unsigned r = 0; r < 3; ++r) {
                below[c * 3 + r] = load(
                    l->below + (l->below_stride > 0 ? c * static_cast<unsigned>(l->below_stride) + r
                                                    : r * static_cast<unsigned>(-l->below_stride) + c)...);
              }
            }
          },
          link);
      LinkFactor<T> factor;
      std::array<T, 3> pivots;
      factorize_link(diagonal, below, carry, factor, pivots);
      for (const T& pivot : pivots) ok = ok && is_pivot(pivot);
      const auto place = std::make_tuple(stream.factor_at(stream.node(), stream.walk_.link)...);
      std::apply(
          [&](auto*... p) {
            for (unsigned i = 0; i < 15; ++i) split(factor[i], (p + i)...);
          },
          place);
      (++stream.walk_.link, ...);
    }
    for (unsigned i = 0; i < 6; ++i) split(carry[i], &stream.walk_.carry[i]...);
    if (!ok) ((stream.failed_ = true), ...);
  }

  void factorize_front(const double* values) {
    const Supernode& front = node();
    double* panel = owner_.factor_.data() + front.panel;
    std::fill_n(panel, std::int64_t{front.stride} * front.columns, 0.0);
    for (auto e = front.entries; e < front.entries_end; ++e) {
      const BlockEntry& entry = symbolic_.entries[at(e)];
      const double* source = values + entry.source;
      double* target = panel + entry.target;
      for (int c = 0; c < entry.columns; ++c, source += entry.stride) {
        for (int r = 0; r < entry.rows; ++r) {
          (entry.transposed ? target[c + r * front.stride] : target[r + c * front.stride]) = source[r];
        }
      }
    }
    double* update = owner_.updates_.data() + front.assembly;
    const std::int64_t update_size = std::int64_t{front.update_stride()} * front.below;
    std::fill_n(update, update_size, 0.0);
    for_each_child(front, [&](const Supernode& child) { extend_add(child, front, panel, update); });
    if (owner_.kernels_->factorize_panel(panel, front.columns + front.below, front.columns, front.stride) !=
        0) {
      failed_ = true;
      return;
    }
    if (front.below == 0) return;
    owner_.kernels_->subtract_product(panel + front.columns, front.stride, front.below, front.columns, update,
                                      front.update_stride());
    if (front.assembly != front.update) {
      std::memmove(owner_.updates_.data() + front.update, update, at(update_size) * sizeof(double));
    }
  }

  /// Adds the update of a child to the front of its parent. Rows that are adjacent in both are
  /// added as one run.
  void extend_add(const Supernode& child, const Supernode& front, double* panel, double* update) const {
    const double* from = owner_.updates_.data() + child.update;
    const int stride = child.update_stride();
    const int update_stride = front.update_stride();
    int column = 0;
    for (int j = 0; j < child.row_count; ++j) {
      const int width = symbolic_.size[at(symbolic_.rows[at(child.rows + j)])];
      const int place = symbolic_.position[at(child.rows + j)];
      double* target = place < front.columns
                           ? panel + std::int64_t{place} * front.stride
                           : update + std::int64_t{place - front.columns} * update_stride - front.columns;
      const int target_stride = place < front.columns ? front.stride : update_stride;
      int row = column;
      for (int i = j; i < child.row_count;) {
        const int first = symbolic_.position[at(child.rows + i)];
        int length = 0;
        do {
          length += symbolic_.size[at(symbolic_.rows[at(child.rows + i)])];
          ++i;
        } while (i < child.row_count && symbolic_.position[at(child.rows + i)] == first + length);
        for (int c = 0; c < width; ++c) {
          Column(target + first + std::int64_t{c} * target_stride, length) +=
              ConstColumn(from + row + std::int64_t{column + c} * stride, length);
        }
        row += length;
      }
      column += width;
    }
  }

  void open_solve() {
    const int index = index_of(next_);
    if (walk_.node == index) return;
    walk_ = Walk{index, 0, {}};
    for_each_child(node(), [&](const Supernode& child) {
      for (unsigned i = 0; i < 3; ++i) walk_.carry[i] += owner_.vectors_[at(child.vector) + i];
    });
  }

  void close_solve() {
    const Supernode& chain = node();
    if (walk_.link < chain.links) return;
    for (unsigned i = 0; i < 3; ++i) owner_.vectors_[at(chain.vector) + i] = walk_.carry[i];
    walk_.node = -1;
    ++next_;
  }

  template <typename T, typename... S>
  static void solve_links(const double* b, int count, S&... stream) {
    std::array<T, 3> carry;
    for (unsigned i = 0; i < 3; ++i) carry[i] = join(stream.walk_.carry[i]...);
    for (int n = 0; n < count; ++n) {
      LinkFactor<T> factor;
      std::array<T, 3> right;
      std::array<T, 3> x;
      const auto place = std::make_tuple(stream.factor_at(stream.node(), stream.walk_.link)...);
      const auto from =
          std::make_tuple(b + stream.symbolic_.outside[at(stream.node().first + stream.walk_.link)]...);
      const auto to = std::make_tuple(stream.owner_.work_.data() + stream.node().start +
                                      std::int64_t{Supernode::kLinkSize} * stream.walk_.link...);
      std::apply(
          [&](const auto*... p) {
            for (unsigned i = 0; i < 15; ++i) factor[i] = join(p[i]...);
          },
          place);
      std::apply(
          [&](const auto*... p) {
            for (unsigned i = 0; i < 3; ++i) right[i] = join(p[i]...);
          },
          from);
      solve_link(factor, right, carry, x);
      std::apply(
          [&](auto*... p) {
            for (unsigned i = 0; i < 3; ++i) split(x[i], (p + i)...);
          },
          to);
      (++stream.walk_.link, ...);
    }
    for (unsigned i = 0; i < 3; ++i) split(carry[i], &stream.walk_.carry[i]...);
  }

  void solve_front(const double* b) {
    const Supernode& front = node();
    const double* panel = owner_.factor_.data() + front.panel;
    const int height = front.columns + front.below;
    double* t = scratch_;
    for (int k = front.first, row = 0; k < front.last; row += symbolic_.size[at(k)], ++k) {
      std::copy_n(b + symbolic_.outside[at(k)], symbolic_.size[at(k)], t + row);
    }
    std::fill_n(t + front.columns, front.below, 0.0);
    for_each_child(front, [&](const Supernode& child) {
      const double* from = owner_.vectors_.data() + child.vector;
      for (int i = 0; i < child.row_count; ++i) {
        const int size = symbolic_.size[at(symbolic_.rows[at(child.rows + i)])];
        double* target = t + symbolic_.position[at(child.rows + i)];
        for (int r = 0; r < size; ++r) target[r] += *from++;
      }
    });
    for (int j = 0; j < front.columns; ++j) {
      const double* column = panel + std::int64_t{j} * front.stride;
      t[j] *= column[j];
      Column(t + j + 1, height - j - 1) -= t[j] * ConstColumn(column + j + 1, height - j - 1);
    }
    std::copy_n(t, front.columns, owner_.work_.data() + front.start);
    std::copy_n(t + front.columns, front.below, owner_.vectors_.data() + front.vector);
  }

  // The walk counts links from the end of the chain.
  void open_back(const double* x) {
    const int index = index_of(end_ - 1);
    if (walk_.node == index) return;
    walk_ = Walk{index, 0, {}};
    const double* next = x + symbolic_.outside[at(symbolic_.rows[at(last_node().rows)])];
    std::copy_n(next, 3, walk_.carry.begin());
  }

  void close_back() {
    if (walk_.link < last_node().links) return;
    walk_.node = -1;
    --end_;
  }

  template <typename T, typename... S>
  static void solve_links_back(double* x, int count, S&... stream) {
    std::array<T, 3> next;
    for (unsigned i = 0; i < 3; ++i) next[i] = join(stream.walk_.carry[i]...);
    for (int n = 0; n < count; ++n) {
      LinkFactor<T> factor;
      std::array<T, 3> z;
      const auto link = std::make_tuple((stream.last_node().links - 1 - stream.walk_.link)...);
      const auto each = [&](auto visit) {
        std::apply([&](auto... l) { visit(std::make_pair(&stream, l)...); }, link);
      };
      each([&](auto... s) {
        for (unsigned i = 0; i < 15; ++i)
          factor[i] = join(s.first->factor_at(s.first->last_node(), s.second)[i]...);
        for (unsigned i = 0; i < 3; ++i) {
          z[i] =
              join(s.first->owner_.work_[at(s.first->last_node().start + std::int64_t{3} * s.second) + i]...);
        }
      });
      solve_link_back(factor, next, z);
      each([&](auto... s) {
        for (unsigned i = 0; i < 3; ++i) {
          split(z[i], (x + s.first->symbolic_.outside[at(s.first->last_node().first + s.second)] + i)...);
        }
      });
      (++stream.walk_.link, ...);
    }
    for (unsigned i = 0; i < 3; ++i) split(next[i], &stream.walk_.carry[i]...);
  }

  void solve_front_back(double* x) {
    const Supernode& front = last_node();
    const double* panel = owner_.factor_.data() + front.panel;
    const int height = front.columns + front.below;
    double* t = scratch_;
    std::copy_n(owner_.work_.data() + front.start, front.columns, t);
    double* below = t + front.columns;
    for (int i = 0; i < front.row_count; ++i) {
      const int k = symbolic_.rows[at(front.rows + i)];
      below = std::copy_n(x + symbolic_.outside[at(k)], symbolic_.size[at(k)], below);
    }
    for (int j = front.columns - 1; j >= 0; --j) {
      const double* column = panel + std::int64_t{j} * front.stride;
      const int rest = height - j - 1;
      t[j] = (t[j] - ConstColumn(column + j + 1, rest).dot(Column(t + j + 1, rest))) * column[j];
    }
    for (int k = front.first, row = 0; k < front.last; row += symbolic_.size[at(k)], ++k) {
      std::copy_n(t + row, symbolic_.size[at(k)], x + symbolic_.outside[at(k)]);
    }
  }

  BlockCholesky& owner_;
  const BlockSymbolic& symbolic_;
  const int* list_ = nullptr;
  double* scratch_ = nullptr;
  int next_ = 0;
  int end_ = 0;
  Walk walk_;
  bool failed_ = false;
};

// Processes two subtrees at a time in one thread, unless there are more threads than pairs. The
// chains then hide each other's latency.
template <typename Work>
void BlockCholesky::for_each_subtree(Work work) {
  const int count = static_cast<int>(symbolic_.subtrees.size());
  const int threads = pool_ == nullptr ? 1 : pool_->threads();
  const bool pairs = threads == 1 || count >= 2 * threads;
  const int items = pairs ? (count + 1) / 2 : count;
  run_parallel(pool_, items, [&](int item) {
    if (!pairs) {
      work(item, -1);
    } else {
      work(2 * item, 2 * item + 1 < count ? 2 * item + 1 : -1);
    }
  });
}

void BlockCholesky::analyze(const BlockPattern& pattern) {
  symbolic_ = analyze_blocks(pattern);
  const auto streams = static_cast<std::int64_t>(symbolic_.subtrees.size()) + 1;
  factor_.resize(at(symbolic_.factor_size + kSlack));
  std::fill(factor_.end() - kSlack, factor_.end(), 0.0);
  updates_.assign(at(symbolic_.update_size + kSlack), 0.0);
  vectors_.assign(at(symbolic_.vector_size), 0.0);
  work_.assign(at(symbolic_.start.back() + streams * (symbolic_.largest_front + kSlack)), 0.0);
}

template <typename Pass>
bool BlockCholesky::walk_subtrees(const Pass& pass) {
  std::atomic<bool> ok = true;
  for_each_subtree([&](int one, int two) {
    Stream a(*this, one);
    if (two < 0) {
      Stream::walk(pass, a, nullptr);
    } else {
      Stream b(*this, two);
      Stream::walk(pass, a, &b);
      if (b.failed()) ok = false;
    }
    if (a.failed()) ok = false;
  });
  return ok;
}

template <typename Pass>
bool BlockCholesky::walk_top(const Pass& pass) {
  Stream top(*this, static_cast<int>(symbolic_.subtrees.size()));
  Stream::walk(pass, top, nullptr);
  return !top.failed();
}

FactorStatus BlockCholesky::factorize(std::span<const double> values) {
  const Stream::Factorization pass(values.data());
  const bool ok = walk_subtrees(pass) && walk_top(pass);
  return ok ? FactorStatus::ok : FactorStatus::not_positive_definite;
}

void BlockCholesky::solve(std::span<const double> b, std::span<double> x) {
  const Stream::Forward forward(b.data());
  walk_subtrees(forward);
  walk_top(forward);
  const Stream::Backward backward{x.data()};
  walk_top(backward);
  walk_subtrees(backward);
}

std::string BlockCholesky::description() const {
  return std::string("block_cholesky, ") + std::to_string(symbolic_.nodes.size()) + " supernodes, " +
         kernels_->name;
}

}  // namespace waymark
