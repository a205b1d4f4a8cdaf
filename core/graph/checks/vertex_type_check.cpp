#include <waymark/core/graph/checks/vertex_type_check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace waymark {
namespace {

using Numbers = std::vector<double>;

constexpr int kTrials = 50;

template <typename... Part>
std::string sentence(const Part&... part) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  (out << ... << part);
  return out.str();
}

double largest_of(const Numbers& a, const Numbers& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// Draws values of a type, and tests its chart at them.
class ChartCheck {
 public:
  explicit ChartCheck(const VertexType& type) : type_(type) {}

  std::vector<std::string> run() {
    for (int trial = 0; trial < kTrials && broken_.empty(); ++trial) {
      const Numbers value = draw();
      at_zero(value);
      inverse(value);
      if (type_.linear_chart) linear(value);
      if (type_.rigid_motion != nullptr) rigid(value);
    }
    return broken_;
  }

 private:
  static constexpr double kClose = 1e-9;

  [[nodiscard]] Numbers tangent(double size) {
    Numbers delta(static_cast<std::size_t>(type_.tangent_size));
    std::uniform_real_distribution<double> unit(-1, 1);
    for (double& d : delta) d = size * unit(random_);
    return delta;
  }
  /// A value that the type itself has normalised.
  [[nodiscard]] Numbers draw() {
    Numbers value(static_cast<std::size_t>(type_.value_size));
    std::uniform_real_distribution<double> unit(-1, 1);
    for (double& x : value) x = 3 * unit(random_);
    return retracted(value, Numbers(static_cast<std::size_t>(type_.tangent_size), 0.0));
  }
  [[nodiscard]] Numbers retracted(Numbers value, const Numbers& delta) const {
    type_.retract(value.data(), delta.data());
    return value;
  }
  [[nodiscard]] Numbers local(const Numbers& from, const Numbers& to) const {
    Numbers delta(static_cast<std::size_t>(type_.tangent_size));
    type_.local(from.data(), to.data(), delta.data());
    return delta;
  }
  void expect(bool holds, const std::string& promise) {
    if (!holds) broken_.push_back(promise);
  }

  void at_zero(const Numbers& value) {
    const Numbers zero(static_cast<std::size_t>(type_.tangent_size), 0.0);
    expect(largest_of(retracted(value, zero), value) < 1e-12, "retract by 0 changes a value");
    expect(largest_of(local(value, value), zero) < 1e-12, "local(v, v) is not 0");
  }
  void inverse(const Numbers& value) {
    const Numbers delta = tangent(0.5);
    const double off = largest_of(local(value, retracted(value, delta)), delta);
    expect(off < kClose, sentence("local is not the inverse of retract: off by ", off));
  }
  void linear(const Numbers& value) {
    const Numbers other = retracted(value, tangent(0.5));  // near, so that no angle wraps
    const Numbers delta = tangent(0.5);
    const Numbers moved = local(value, retracted(other, delta));
    Numbers sum = local(value, other);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += delta[i];
    expect(largest_of(moved, sum) < kClose, "kLinearChart: local(r, x [+] d) is not local(r, x) + d");
  }
  /// The derivative of the position along each rigid motion is that of the plane.
  void rigid(const Numbers& value) {
    constexpr double kStep = 1e-5;
    const Eigen::Vector2d centre(0.7, -1.3);
    const double extent = 2.5;
    const auto size = static_cast<std::size_t>(type_.tangent_size);
    Numbers columns(3 * size);
    type_.rigid_motion(value.data(), centre, extent, columns.data());
    const Eigen::Vector2d from_centre = type_.position(value.data()) - centre;
    const Eigen::Vector2d expected[3] = {
        {1, 0}, {0, 1}, Eigen::Vector2d(-from_centre[1], from_centre[0]) / extent};
    for (std::size_t k = 0; k < 3; ++k) {
      Numbers ahead(size);
      Numbers back(size);
      for (std::size_t i = 0; i < size; ++i) {
        ahead[i] = kStep * columns[k * size + i];
        back[i] = -ahead[i];
      }
      const Eigen::Vector2d moved =
          (type_.position(retracted(value, ahead).data()) - type_.position(retracted(value, back).data())) /
          (2 * kStep);
      expect((moved - expected[k]).norm() < 1e-6,
             sentence("rigid_motion: column ", k, " does not move the position as a rigid motion does"));
    }
  }

  const VertexType& type_;
  std::mt19937_64 random_{5};
  std::vector<std::string> broken_;
};

bool is_finite(const LossValue& value) {
  return std::isfinite(value.rho) && std::isfinite(value.weight) && std::isfinite(value.curvature);
}

/// The derivative of a function by differences of fourth order. @returns NaN at a corner, and where the
/// function is not finite
template <typename Function>
double derivative(const Function& function, double at, double step) {
  const double wide = (function(at + 2 * step) - function(at - 2 * step)) / (4 * step);
  const double narrow = (function(at + step) - function(at - step)) / (2 * step);
  const bool smooth = std::abs(wide - narrow) < 1e-3 * (1e-3 + std::abs(narrow));
  return smooth ? (4 * narrow - wide) / 3 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<std::string> broken_promises(const VertexType& type) {
  return ChartCheck(type).run();
}

std::vector<std::string> broken_promises(const LossType& type) {
  constexpr double kSteps[] = {0.01, 0.1, 0.5, 0.9, 1.7, 3.1, 7.3, 20, 150};
  std::vector<std::string> broken;
  for (const double scale : {0.5, 1.0, 3.0}) {
    const Loss loss{type.name, type.evaluate, scale};
    const auto at = [&](double s) { return loss.at(s); };
    const LossValue zero = at(0);
    if (std::abs(zero.rho) > 1e-12 || std::abs(zero.weight - 1) > 1e-12)
      broken.push_back(
          sentence("scale ", scale, ": rho(0) is ", zero.rho, " and rho'(0) ", zero.weight, ", not 0 and 1"));
    double before = 1;
    for (const double step : kSteps) {
      const double s = step * scale * scale;
      const LossValue value = at(s);
      if (!is_finite(value)) {
        broken.push_back(sentence("scale ", scale, ", s = ", s, ": rho is ", value.rho, ", the weight ",
                                  value.weight, ", the curvature ", value.curvature,
                                  "; all three must be finite"));
        break;
      }
      if (!(value.weight >= 0) || value.weight > before + 1e-12)
        broken.push_back(sentence("scale ", scale, ", s = ", s, ": the weight ", value.weight,
                                  " is negative or larger than before"));
      before = value.weight;
      const double slope = derivative([&](double x) { return at(x).rho; }, s, 1e-3 * s);
      if (std::abs(slope - value.weight) > 1e-6 * (1 + std::abs(slope)))
        broken.push_back(sentence("scale ", scale, ", s = ", s, ": the weight is ", value.weight,
                                  ", rho' by differences ", slope));
      const double bend = derivative([&](double x) { return at(x).weight; }, s, 1e-3 * s);
      if (std::abs(bend - value.curvature) > 1e-5 * (1e-3 + std::abs(bend)))
        broken.push_back(sentence("scale ", scale, ", s = ", s, ": the curvature is ", value.curvature,
                                  ", rho'' by differences ", bend));
    }
  }
  return broken;
}

}  // namespace waymark
