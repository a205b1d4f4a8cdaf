#include <waymark/tools/live/session/lag_study.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include <waymark/tools/drive/sensors/sensor_logs.hpp>
#include <waymark/tools/live/session/session.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

/// Compares poses with the truth. Stamps should ascend.
class Comparison {
 public:
  explicit Comparison(const drive::PreparedDrive& drive) : drive_(drive) {}

  /// @param covariance null: not known @param height_m empty: not known
  void add(Stamp stamp, const Eigen::Vector3d& pose, const Eigen::Matrix3d* covariance,
           const std::optional<double>& height_m) {
    const std::optional<Eigen::Vector3d> truth = at(stamp);
    if (!truth) return;
    const Eigen::Vector2d off = pose.head<2>() + rotate(pose[2], drive_.truth_reference_m) - truth->head<2>();
    if (height_m && std::isfinite(truth->z())) {
      squares_3d_ += off.squaredNorm() + (*height_m - truth->z()) * (*height_m - truth->z());
      ++with_height_;
    }
    ++errors_.poses;
    squares_ += off.squaredNorm();
    errors_.max_m = std::max(errors_.max_m, off.norm());
    if (covariance == nullptr) return;
    const Eigen::Matrix2d spread = covariance->topLeftCorner<2, 2>();
    const double normalised = off.dot(spread.inverse() * off);
    constexpr double kChiSquare95 = 5.991464547107979;
    inside_ += normalised < kChiSquare95;
    normalised_ += normalised;
  }

  [[nodiscard]] LagErrors errors() const {
    LagErrors errors = errors_;
    if (errors.poses == 0) return errors;
    const auto count = static_cast<double>(errors.poses);
    errors.rmse_m = std::sqrt(squares_ / count);
    errors.inside95 = static_cast<double>(inside_) / count;
    errors.nees = normalised_ / count;
    if (with_height_ > 0) errors.rmse_3d_m = std::sqrt(squares_3d_ / static_cast<double>(with_height_));
    return errors;
  }

 private:
  /// Returns x, y and height of the truth at a moment, a height that it does not have as NaN; empty where it has a
  /// gap.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(Stamp stamp) const {
    constexpr double kGap = 1.5;
    const std::vector<TruthPose>& truth = drive_.truth;
    const auto after = std::lower_bound(truth.begin(), truth.end(), stamp,
                                        [](const TruthPose& of, Stamp moment) { return of.stamp < moment; });
    if (after == truth.end() || after == truth.begin()) return std::nullopt;
    const TruthPose& before = *std::prev(after);
    const double apart_s = seconds_between(before.stamp, after->stamp);
    if (apart_s > kGap) return std::nullopt;
    const double share = seconds_between(before.stamp, stamp) / apart_s;
    const auto in_space = [](const TruthPose& of) {
      return Eigen::Vector3d(of.position.x(), of.position.y(), of.height_m);
    };
    return Eigen::Vector3d((1 - share) * in_space(before) + share * in_space(*after));
  }

  const drive::PreparedDrive& drive_;
  LagErrors errors_;
  double squares_ = 0;
  double normalised_ = 0;
  double squares_3d_ = 0;
  std::size_t with_height_ = 0;
  std::size_t inside_ = 0;
};

LagResult replay(const std::vector<Sample>& samples, const drive::DriveFile& file, double window_s,
                 const drive::PreparedDrive& drive, const TypeRegistry& registry) {
  LiveSettings live;
  live.window_s = window_s;
  Estimator estimator(file.description, file.settings, live, registry);
  Comparison at_once(drive);
  Comparison later(drive);
  LatencyHistogram cycles;
  const auto hear = [&] {
    bool solved = false;
    for (const Report& report : estimator.reports()) {
      if (const auto* pose = std::get_if<LivePose>(&report)) {
        if (pose->heading_known && !pose->corrected)
          at_once.add(pose->stamp, pose->pose, &pose->covariance, pose->height_m);
        solved = solved || pose->corrected;
      }
      if (const auto* pose = std::get_if<SettledPose>(&report))
        later.add(pose->stamp, pose->pose, nullptr, {});
    }
    return solved;
  };
  for (const Sample& sample : samples) {
    const auto begin = std::chrono::steady_clock::now();
    estimator.take(sample);
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    if (hear()) cycles.add(us);
  }
  estimator.finish();
  (void)hear();
  return {window_s, at_once.errors(), later.errors(), cycles.quantile_us(0.5)};
}

}  // namespace

std::vector<LagResult> study_lags(const drive::DriveFile& file, const drive::FusionSettings& settings,
                                  const drive::PreparedDrive& drive, std::span<const double> windows_s,
                                  const TypeRegistry& registry, const std::function<void(double)>& begun) {
  drive::DriveFile own = file;
  own.settings = settings;
  put_nodes_first(own.description);
  drive::resolve_sensors(own.description, registry);
  own.description.state_frame(drive.frame);
  Session session(own, {}, registry);
  const std::vector<Sample> samples = session.decode_files();
  own.description = session.description();
  std::vector<LagResult> results;
  for (const double window_s : windows_s) {
    if (begun) begun(window_s);
    results.push_back(replay(samples, own, window_s, drive, registry));
  }
  return results;
}

}  // namespace waymark::live
