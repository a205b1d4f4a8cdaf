/// Tells by pairs of readings whether odometry and GNSS measure the same motion.
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace waymark::drive {

class CommonMotion {
 public:
  /// Takes a reading of GNSS and the mean of the odometry over its time. @param follows the pair before is shortly
  /// before it
  void add(double odometry, double gnss, bool follows);
  [[nodiscard]] std::size_t size() const { return pairs_.count; }
  /// Returns Pearson's correlation; 0 if one of both is constant.
  [[nodiscard]] double correlation() const;
  /// Returns the log-likelihood of a common motion against none: n/2 log(s0^2 / s^2). s is what is new in each
  /// residual of gnss = a + b odometry after the one before (autoregressive of first order; Cochrane and Orcutt
  /// 1949), s0 the same without odometry. Two ramps resemble each other by chance, their steps do not. A slope b
  /// that is not positive counts as none.
  [[nodiscard]] double score() const;

 private:
  template <int size>
  struct Sums {
    std::size_t count = 0;
    Eigen::Matrix<double, size, 1> sum = Eigen::Matrix<double, size, 1>::Zero();
    Eigen::Matrix<double, size, size> products = Eigen::Matrix<double, size, size>::Zero();

    void add(const Eigen::Matrix<double, size, 1>& values);
    [[nodiscard]] Eigen::Matrix<double, size, size> covariance() const;
  };

  Sums<2> pairs_;  // odometry, gnss
  Sums<4> next_;   // and both of the pair before
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

}  // namespace waymark::drive
