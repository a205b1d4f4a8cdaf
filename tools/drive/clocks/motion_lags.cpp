#include <waymark/tools/drive/clocks/motion_lags.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/clocks/lagged_path.hpp>

namespace waymark::drive {
namespace {

constexpr double kLargestLag_s = 1.5;
constexpr std::size_t kFewestWindows = 8;

/// What is estimated.
enum Unknown { speed_lag_s, yaw_rate_lag_s, scale, bias_radps, arm_m, yaw_scale, kUnknowns };
using LagUnknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using PerFix = std::vector<Eigen::Vector2d>;  // of each fix, m

/// Fixes in windows, each laid on the dead reckoning of its time.
class WindowFit {
 public:
  WindowFit(const std::vector<OdometrySample>& odometry, const std::vector<const Fix*>& fixes);

  /// The fixes of one window: [first, end).
  struct Window {
    std::size_t first, end;
  };
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  [[nodiscard]] double weight(std::size_t fix) const { return weights_[fix]; }
  /// Returns fix less odometry. Every window is moved and turned so that its weighted squares are least.
  [[nodiscard]] PerFix residuals(const LagUnknowns& unknowns) const;
  /// Returns the usual residual per axis, from the median of their lengths.
  [[nodiscard]] double usual(const PerFix& residuals) const;
  /// Fixes with large residuals count less, by Cauchy's loss.
  void weigh(const PerFix& residuals);
  void leave_out(std::size_t window) {
    windows_.erase(windows_.begin() + static_cast<std::ptrdiff_t>(window));
  }

 private:
  void add(double moment_s, const Fix& fix);
  /// @param way at the fixes of the window
  void lay(const Window& window, const PerFix& way, PerFix& residuals) const;

  LaggedPath path_;
  Eigen::Vector2d antenna_m_;
  std::vector<double> moments_s_;
  PerFix places_;
  std::vector<double> weights_;
  std::vector<Window> windows_;
};

/// Keeps enough windows, at equal distances: a day tells no more of a lag than half an hour does.
void thin(std::vector<WindowFit::Window>& windows) {
  constexpr std::size_t kMost = 90;
  if (windows.size() <= kMost) return;
  std::vector<WindowFit::Window> kept;
  for (std::size_t i = 0; i < kMost; ++i) kept.push_back(windows[i * windows.size() / kMost]);
  windows = std::move(kept);
}

WindowFit::WindowFit(const std::vector<OdometrySample>& odometry, const std::vector<const Fix*>& fixes)
    : path_(odometry), antenna_m_(fixes.front()->antenna_m) {
  constexpr double kSpacing_s = 0.9;
  constexpr std::size_t kFewestFixes = 8;
  for (const Fix* fix : fixes) {
    const double moment_s = path_.seconds_of(fix->stamp);
    const bool is_near = !moments_s_.empty() && moment_s - moments_s_.back() < kSpacing_s;
    if (!is_near && path_.is_measured(moment_s - kLargestLag_s, moment_s + kLargestLag_s))
      add(moment_s, *fix);
  }
  std::erase_if(windows_, [](const Window& window) { return window.end - window.first < kFewestFixes; });
  thin(windows_);
  weights_.assign(places_.size(), 1.0);
}

void WindowFit::add(double moment_s, const Fix& fix) {
  constexpr double kLength_s = 20;
  constexpr double kSilence_s = 3.5;
  const bool continues = !windows_.empty() && moment_s - moments_s_.back() < kSilence_s &&
                         moment_s - moments_s_[windows_.back().first] <= kLength_s &&
                         path_.is_measured(moments_s_.back(), moment_s);
  if (!continues) windows_.push_back({places_.size(), places_.size()});
  moments_s_.push_back(moment_s);
  places_.push_back(fix.position / fix.grid_scale);
  windows_.back().end = places_.size();
}

PerFix WindowFit::residuals(const LagUnknowns& unknowns) const {
  const double stretch = 1 + unknowns[scale];
  const Eigen::Vector2d antenna_m = antenna_m_ + Eigen::Vector2d(unknowns[arm_m], 0);
  const LaggedPath::Errors errors{unknowns[speed_lag_s], unknowns[yaw_rate_lag_s], unknowns[bias_radps],
                                  unknowns[yaw_scale]};
  PerFix residuals(places_.size(), Eigen::Vector2d::Zero());
  for (const Window& window : windows_) {
    const std::span moments_s(moments_s_.begin() + static_cast<std::ptrdiff_t>(window.first),
                              window.end - window.first);
    PerFix way = path_.antenna_at(moments_s, errors, antenna_m / stretch);
    for (Eigen::Vector2d& place : way) place *= stretch;
    lay(window, way, residuals);
  }
  return residuals;
}

void WindowFit::lay(const Window& window, const PerFix& way, PerFix& residuals) const {
  double weight = 0;
  Eigen::Vector2d of_way = Eigen::Vector2d::Zero();
  Eigen::Vector2d of_fixes = Eigen::Vector2d::Zero();
  for (std::size_t i = window.first; i < window.end; ++i) {
    weight += weights_[i];
    of_way += weights_[i] * way[i - window.first];
    of_fixes += weights_[i] * places_[i];
  }
  of_way /= weight;
  of_fixes /= weight;
  double along = 0;
  double across = 0;
  for (std::size_t i = window.first; i < window.end; ++i) {
    const Eigen::Vector2d from = way[i - window.first] - of_way;
    const Eigen::Vector2d to = places_[i] - of_fixes;
    along += weights_[i] * from.dot(to);
    across += weights_[i] * (from.x() * to.y() - from.y() * to.x());
  }
  const Eigen::Rotation2Dd turn(std::atan2(across, along));
  for (std::size_t i = window.first; i < window.end; ++i)
    residuals[i] = places_[i] - of_fixes - turn * (way[i - window.first] - of_way);
}

double WindowFit::usual(const PerFix& residuals) const {
  constexpr double kLeast_m = 0.005;
  constexpr double kMedianLength = 1.1774;  // of normal errors of 1 per axis
  std::vector<double> lengths;
  for (const Window& window : windows_)
    for (std::size_t i = window.first; i < window.end; ++i) lengths.push_back(residuals[i].norm());
  return std::max(kLeast_m, upper_median(std::move(lengths)) / kMedianLength);
}

void WindowFit::weigh(const PerFix& residuals) {
  constexpr double kScale = 2.4;
  const double scale_m = kScale * usual(residuals);
  for (std::size_t i = 0; i < residuals.size(); ++i)
    weights_[i] = 1 / (1 + residuals[i].squaredNorm() / (scale_m * scale_m));
}

/// Changes of the residuals with each unknown, by central differences.
std::array<PerFix, kUnknowns> slopes_at(const WindowFit& fit, const LagUnknowns& unknowns) {
  const LagUnknowns steps{{0.05, 0.05, 0.01, 0.0005, 0.2, 0.01}};
  std::array<PerFix, kUnknowns> slopes;
  for (int k = 0; k < kUnknowns; ++k) {
    const LagUnknowns step = steps[k] * LagUnknowns::Unit(k);
    PerFix& slope = slopes[static_cast<std::size_t>(k)];
    slope = fit.residuals(unknowns + step);
    const PerFix before = fit.residuals(unknowns - step);
    for (std::size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - before[i]) / (2 * steps[k]);
  }
  return slopes;
}

/// What windows tell of a lag.
struct Telling {
  double sum = 0;      ///< of their information
  double squares = 0;  ///< of that of each
  double largest = 0;
  std::size_t loudest = 0;  ///< the window that tells most

  void add(double information, std::size_t window) {
    sum += information;
    squares += information * information;
    if (information <= largest) return;
    largest = information;
    loudest = window;
  }
  /// How many windows tell of it, as if each told as much.
  [[nodiscard]] double windows() const { return squares > 0 ? sum * sum / squares : 0; }
};

/// The normal equations of one step, in units of the usual residual.
struct LagEquations {
  Information information;
  LagUnknowns gradient;
  Information spread;                ///< of the gradient, from its parts by window
  std::array<Telling, 2> telling{};  ///< of the lags

  void add(const WindowFit& fit, std::size_t window, const PerFix& residuals,
           const std::array<PerFix, kUnknowns>& slopes, double usual_m) {
    LagUnknowns part = LagUnknowns::Zero();
    Information own = Information::Zero();
    for (std::size_t i = fit.windows()[window].first; i < fit.windows()[window].end; ++i) {
      Eigen::Matrix<double, 2, kUnknowns> slope;
      for (int k = 0; k < kUnknowns; ++k) slope.col(k) = slopes[static_cast<std::size_t>(k)][i];
      const double weight = fit.weight(i) / (usual_m * usual_m);
      own += weight * slope.transpose() * slope;
      part += weight * slope.transpose() * residuals[i];
    }
    information += own;
    gradient += part;
    spread += part * part.transpose();
    telling[0].add(own(speed_lag_s, speed_lag_s), window);
    telling[1].add(own(yaw_rate_lag_s, yaw_rate_lag_s), window);
  }
};

LagEquations equations_at(const WindowFit& fit, const LagUnknowns& unknowns, const Information& prior) {
  const PerFix residuals = fit.residuals(unknowns);
  const auto slopes = slopes_at(fit, unknowns);
  const double usual_m = fit.usual(residuals);
  LagEquations equations{prior, prior * unknowns, prior};
  for (std::size_t window = 0; window < fit.windows().size(); ++window)
    equations.add(fit, window, residuals, slopes, usual_m);
  return equations;
}

/// The lags that fit the windows best.
struct BestFit {
  MotionLags lags;
  Telling least;  ///< of the lag of which fewer windows tell
};

std::optional<BestFit> best_fit(WindowFit& fit, const Information& prior) {
  constexpr int kMostSteps = 10;
  constexpr double kLongestStep_s = 0.3;
  constexpr double kConverged_s = 0.001;
  // What it costs to know the spread from few windows.
  const auto windows = static_cast<double>(fit.windows().size());
  const double few = windows / (windows - 3);
  LagUnknowns unknowns = LagUnknowns::Zero();
  BestFit best;
  for (int i = 0; i < kMostSteps; ++i) {
    fit.weigh(fit.residuals(unknowns));
    const LagEquations equations = equations_at(fit, unknowns, prior);
    const Information inverse = equations.information.inverse();
    LagUnknowns step = -inverse * equations.gradient;
    for (const Unknown lag : {speed_lag_s, yaw_rate_lag_s})
      step[lag] = std::clamp(step[lag], -kLongestStep_s, kLongestStep_s);
    unknowns += step;
    if (!(unknowns.head<2>().cwiseAbs().maxCoeff() < kLargestLag_s)) return std::nullopt;
    const Information covariance = few * inverse * equations.spread * inverse;
    best.lags = {unknowns[speed_lag_s], unknowns[yaw_rate_lag_s], covariance.topLeftCorner<2, 2>(),
                 unknowns[arm_m]};
    const auto& [speed, yaw_rate] = equations.telling;
    best.least = speed.windows() < yaw_rate.windows() ? speed : yaw_rate;
    if (step.head<2>().cwiseAbs().maxCoeff() < kConverged_s) break;
  }
  return best;
}

}  // namespace

double MotionLags::difference_sigma_s() const {
  return std::sqrt(std::max(0.0, covariance_s2(0, 0) + covariance_s2(1, 1) - 2 * covariance_s2(0, 1)));
}

std::optional<MotionLags> estimate_motion_lags(const std::vector<OdometrySample>& odometry,
                                               const std::vector<const Fix*>& fixes, double arm_sigma_m) {
  constexpr double kFewestTelling = 4;
  constexpr int kMostLeftOut = 3;
  if (odometry.size() < 2 || fixes.empty()) return std::nullopt;
  WindowFit fit(odometry, fixes);
  const LagUnknowns prior_sigma{{1e3, 1e3, 0.2, 0.1, arm_sigma_m, 0.2}};
  const Information prior = prior_sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  for (int left_out = 0; left_out <= kMostLeftOut; ++left_out) {
    if (fit.windows().size() < kFewestWindows) break;
    const std::optional<BestFit> best = best_fit(fit, prior);
    if (!best) break;
    if (best->least.windows() >= kFewestTelling) return best->lags;
    fit.leave_out(best->least.loudest);
  }
  return std::nullopt;
}

}  // namespace waymark::drive
