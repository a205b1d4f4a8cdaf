/// Steps that converge linearly, made longer by what the steps before have shown.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace waymark::detail {

/// Anderson's acceleration of steps that reweight losses (Walker and Ni, "Anderson acceleration for fixed-point
/// iterations", 2011). Where a loss bends down, such a step is much shorter than the way to the minimum: a share r of the
/// way leaves 1 - r, in each direction another one. How the last steps have changed with what was gone tells these shares.
/// Nothing is allocated behind the constructor.
class StepAcceleration {
 public:
  explicit StepAcceleration(Eigen::Index unknowns);

  /// Forgets the steps so far: the next one comes from elsewhere.
  void reset();
  /// Forgets them, and begins with a step.
  void begin(const Eigen::VectorXd& step);
  /// Takes a step, and computes the accelerated one. @param step proposed at the present values
  /// @param weights of the squares of its coordinates @returns whether there is one
  bool accelerate(const Eigen::VectorXd& step, const Eigen::VectorXd& weights);
  [[nodiscard]] const Eigen::VectorXd& accelerated() const { return accelerated_; }
  /// Tells what was gone from the values at which the last step was proposed; heard if there is one.
  void moved(const Eigen::VectorXd& by);

 private:
  static constexpr int kMemory = 5;
  struct Move {
    Eigen::VectorXd by;      ///< from the values of one step to those of the next one
    Eigen::VectorXd change;  ///< of the step
  };
  /// The one that is told next, or complete with the next step.
  [[nodiscard]] Move& present() { return moves_[static_cast<std::size_t>(next_)]; }

  std::array<Move, kMemory> moves_;  ///< in turn
  int count_ = 0;                    ///< of those that are known
  int next_ = 0;
  bool knows_step_ = false;
  bool knows_move_ = false;
  Eigen::VectorXd last_step_;
  Eigen::VectorXd accelerated_;
};

inline StepAcceleration::StepAcceleration(Eigen::Index unknowns)
    : last_step_(unknowns), accelerated_(unknowns) {
  for (Move& move : moves_) {
    move.by.resize(unknowns);
    move.change.resize(unknowns);
  }
}

inline void StepAcceleration::reset() {
  count_ = 0;
  knows_step_ = knows_move_ = false;
}

inline void StepAcceleration::begin(const Eigen::VectorXd& step) {
  reset();
  last_step_ = step;
  knows_step_ = true;
}

inline bool StepAcceleration::accelerate(const Eigen::VectorXd& step, const Eigen::VectorXd& weights) {
  constexpr double kDamping = 1e-8;  // of directions that the moves hardly show
  if (knows_step_ && knows_move_) {
    present().change = step - last_step_;
    next_ = (next_ + 1) % kMemory;
    count_ = std::min(count_ + 1, kMemory);
  }
  last_step_ = step;
  knows_step_ = true;
  knows_move_ = false;
  if (count_ == 0) return false;
  // the shares of the changes that leave least of the step
  const auto change = [&](int i) -> const Eigen::VectorXd& {
    return moves_[static_cast<std::size_t>(i)].change;
  };
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMemory, kMemory> products(count_, count_);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMemory, 1> shares(count_);
  for (int i = 0; i < count_; ++i) {
    shares[i] = (weights.array() * change(i).array() * step.array()).sum();
    for (int j = 0; j <= i; ++j)
      products(i, j) = products(j, i) = (weights.array() * change(i).array() * change(j).array()).sum();
  }
  products.diagonal() *= 1 + kDamping;
  products.ldlt().solveInPlace(shares);
  accelerated_ = step;
  for (int i = 0; i < count_; ++i)
    accelerated_ -= shares[i] * (moves_[static_cast<std::size_t>(i)].by + change(i));
  return accelerated_.allFinite();
}

inline void StepAcceleration::moved(const Eigen::VectorXd& by) {
  if (!knows_step_) return;
  present().by = by;
  knows_move_ = true;
}

}  // namespace waymark::detail
