/// The dense front through which a window is eliminated, and what each vertex leaves behind.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace waymark::detail {

/// The rows of the factor, one panel for each vertex: L^T d + W d_rest = -y.
class FrontPanels {
 public:
  void clear();
  /// Solves for the panels [first, last), from the last one to the first.
  void solve(std::size_t first, std::size_t last, std::span<double> step) const;
  /// Returns how much less chi2 is at the minimum of the quadratic model, by the panels from one on.
  [[nodiscard]] double decrement(std::size_t first) const;
  /// Returns the triangle of the last panels, from one on, in their order.
  [[nodiscard]] Eigen::MatrixXd triangle(std::size_t first) const;
  /// Forgets the panels from one on.
  void cut(std::size_t first);
  [[nodiscard]] std::size_t size() const { return panels_.size(); }

 private:
  friend class Front;
  struct Panel {
    std::int64_t numbers = 0;  // L column by column, y, W row by row
    std::int64_t others = 0;   // places of the rest in the step
    std::int32_t own = 0;      // place of the vertex in the step
    std::int32_t size = 0;
    std::int32_t rest = 0;
  };
  std::vector<Panel> panels_;
  LargeArray<double> numbers_;
  LargeArray<std::int32_t> others_;
};

/// A symmetric matrix over the vertices that are joined to an eliminated one and are not eliminated
/// themselves. It takes their edges, and eliminates vertex by vertex.
class Front {
 public:
  struct Member {
    VertexIndex vertex;
    int row;
    int size;
    std::int32_t step;
  };
  /// A front as it was before a vertex was eliminated.
  struct Saved {
    std::vector<Member> members;
    std::vector<double> lower;  // column by column
    std::vector<double> gradient;
  };

  void clear();
  [[nodiscard]] Saved save() const;
  void restore(const Saved& saved);
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  /// Moves the reference of the quadratic model by a step: g += H step. @param step of all members
  void move_reference(std::span<const double> step);

  [[nodiscard]] int dimension() const { return dimension_; }

  /// Returns the first row of a vertex. It enters the front if it is new. @param step its place in the step
  [[nodiscard]] int row_of(VertexIndex v, int size, std::int32_t step) {
    for (const Member& member : members_)
      if (member.vertex == v) return member.row;
    return enter(v, size, step);
  }
  void add_gradient(int row, int size, const double* numbers) {
    for (int i = 0; i < size; ++i) gradient_[static_cast<std::size_t>(row + i)] += numbers[i];
  }
  /// Adds a block of the matrix, stored column by column.
  void add_block(int row, int rows, int column, int columns, const double* numbers, int stride) {
    if (row >= column) {
      for (int c = 0; c < columns; ++c) {
        double* to = number(row, column + c);
        for (int r = 0; r < rows; ++r) to[r] += numbers[c * stride + r];
      }
    } else {
      for (int r = 0; r < rows; ++r) {
        double* to = number(column, row + r);
        for (int c = 0; c < columns; ++c) to[c] += numbers[c * stride + r];
      }
    }
  }

  /// Eliminates a vertex. @returns false if its pivot is not positive
  [[nodiscard]] bool eliminate(VertexIndex v, FrontPanels& panels);

 private:
  [[nodiscard]] int enter(VertexIndex v, int size, std::int32_t step);
  [[nodiscard]] const double* number(int row, int column) const {
    return lower_.data() + static_cast<std::ptrdiff_t>(column) * capacity_ + row;
  }
  [[nodiscard]] double* number(int row, int column) {
    return lower_.data() + static_cast<std::ptrdiff_t>(column) * capacity_ + row;
  }
  void grow();
  template <int kSize>
  [[nodiscard]] bool eliminate_rows(int first, FrontPanels& panels, FrontPanels::Panel& panel);
  [[nodiscard]] bool eliminate_any(int first, FrontPanels& panels, FrontPanels::Panel& panel);
  [[nodiscard]] bool eliminate_plain(int first, FrontPanels& panels, FrontPanels::Panel& panel);
  [[nodiscard]] bool eliminate_fused(int first, FrontPanels& panels, FrontPanels::Panel& panel);

  std::vector<Member> members_;  // in the order of their rows
  std::vector<double> lower_;    // lower triangle, column by column
  std::vector<double> gradient_;
  std::vector<double> factors_;
  int dimension_ = 0;
  int capacity_ = 0;
};

}  // namespace waymark::detail
