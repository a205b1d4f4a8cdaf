/// Fixed-lag fusion of samples as they arrive. It reads nothing, writes nothing, knows no wall clock and
/// starts no thread: what it says depends on the stamps of the samples and on the order of their arrival
/// alone. So a replay says the same, bit by bit.
///
///   Estimator estimator(file.description, file.settings, {}, registry);
///   estimator.take(odometry_sample); estimator.take(fix);
///   for (const Report& report : estimator.reports()) ...
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/live/estimator/announcements.hpp>
#include <waymark/tools/live/estimator/fix_judge.hpp>
#include <waymark/tools/live/estimator/guards/receiver_comparison.hpp>
#include <waymark/tools/live/estimator/guards/speed_guard.hpp>
#include <waymark/tools/live/estimator/guards/spot_turns.hpp>
#include <waymark/tools/live/estimator/intake.hpp>
#include <waymark/tools/live/estimator/odometries.hpp>
#include <waymark/tools/live/estimator/reckoning.hpp>
#include <waymark/tools/live/estimator/reports.hpp>
#include <waymark/tools/live/estimator/rough_places.hpp>
#include <waymark/tools/live/estimator/settings.hpp>
#include <waymark/tools/live/estimator/start/alignment.hpp>
#include <waymark/tools/live/estimator/state_rules.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>
#include <waymark/tools/live/learning/learner.hpp>

namespace waymark::live {

class Estimator {
 public:
  /// @param description sources, mounting, frame; its logs are not opened
  /// @param settings as for a whole drive; the noise is that of the options
  /// @param registry must outlive the object
  /// @throws UsageError for settings with names that the registry does not have
  Estimator(drive::DriveDescription description, const drive::FusionSettings& settings,
            const LiveSettings& live, const TypeRegistry& registry);
  ~Estimator();

  /// Lets the search for the noise run elsewhere, in another thread for example. By default take() does it
  /// when its time has come. Call it before the first sample.
  void learn_beside(Beside beside) { learner_.run_beside(std::move(beside)); }
  /// Ends a search when this is set, also while take() waits for it. @param stop must outlive the object
  void stop_learning_with(const std::atomic<bool>& stop) { learner_.stop_with(stop); }
  /// Names the source of an odometry's yaw rate, if the description does not state it. Call it before its first
  /// sample. @param odometry index in the description @param source one of drive::kYawRateSources
  void know_yaw_rate(std::size_t odometry, std::string_view source);
  /// Begins at a pose that is known from a former run. Call it before the first sample.
  void begin_with(const WarmStart& start);

  /// Takes a sample, on the time scale of the drive. @throws PluginError from plugins
  void take(Sample sample);
  /// Ends the input: what waits for other samples is used.
  void finish();
  /// Returns what there is to say since the last call, in order.
  [[nodiscard]] std::vector<Report> reports() { return says_.take(); }

  [[nodiscard]] State state() const { return says_.state(); }
  [[nodiscard]] const Counts& counts() const { return says_.counts; }
  /// Returns the frame; empty before the first fix unless it is stated.
  [[nodiscard]] const std::optional<Frame>& frame() const { return frame_; }
  /// Places the frame at the first place of the drive, if none is known.
  void begin_at(const GeodeticPoint& place) { (void)projection_at(place); }
  /// Returns the present estimate for a later run; empty while there is none.
  [[nodiscard]] std::optional<WarmStart> warm_start() const;
  /// Returns the vertices of the window.
  [[nodiscard]] std::size_t window_size() const;

 private:
  void work();
  void hear(std::size_t source, const OdometrySample& sample);
  [[nodiscard]] OdometrySample guarded(std::size_t source, const OdometrySample& sample);
  void advance(std::size_t source, const OdometrySample& sample);
  void add_motion(std::size_t source, const OdometrySample& sample);
  [[nodiscard]] bool has_several_odometries() const { return description_.odometry.size() > 1; }
  void use_pending();
  void compare_receivers(const Fix& fix);
  void use(const GeodeticFix& fix);
  void use(const SensorReading& reading);
  void use_rough_places();
  [[nodiscard]] const drive::Projection& projection_at(const GeodeticPoint& place);
  [[nodiscard]] Fix projected(const GeodeticFix& fix);
  [[nodiscard]] Eigen::Vector2d smoothed_m(const Fix& fix) const;
  void begin_at_believed(int source);
  void align();
  void align_warm();
  void begin_window(PlacedStretch stretch, std::optional<drive::FirstPose> first_pose);
  void cycle();
  void drop();
  void forget_motion();
  [[nodiscard]] bool is_left_out(const Sample& sample);
  void set_up();
  void learn(Stamp now);
  void begin_search(Stamp now);
  void adopt(Learned learned);
  void tell(const Lesson& lesson);
  void leave_out(const std::set<std::string>& sources);
  void take_over(Learned learned);
  [[nodiscard]] Eigen::Matrix3d covariance() const;
  void reset(const std::string& kind, const std::string& text);
  void publish(bool corrected);
  void publish_place(const Fix& fix);
  void judge_state();
  void say(const std::string& kind, const std::string& source, const std::string& text);
  void refuse(const Sample& sample, const std::string& reason, const std::string& text);
  [[nodiscard]] bool is_open(const drive::NoiseParameter& parameter) const;
  [[nodiscard]] std::string source_of(const Sample& sample) const;

  drive::DriveDescription description_;
  drive::FusionSettings stated_;  // without what was learned
  FusionSetup setup_;             // of the windows to come
  LiveSettings live_;
  const TypeRegistry& registry_;
  Intake intake_;
  Odometries odometries_;
  std::vector<SpeedGuard> guards_;  // by odometry
  std::vector<SpotTurns> spot_turns_;
  RoughPlaces rough_;
  Reckoning reckoning_;
  FixJudge judge_;
  ReceiverComparison receivers_;
  DriveSoFar so_far_;
  Learner learner_;
  std::set<std::string> left_out_;                    // sources that the others contradict, as learned
  drive::NoiseEstimate noise_;                        // the last that was learned
  Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();  // of the newest pose: noise_spread.hpp
  std::unique_ptr<Window> window_;
  std::optional<Frame> frame_;
  std::optional<drive::Projection> projection_;
  std::optional<WarmStart> warm_;

  std::deque<Sample> pending_;          // fixes and readings that wait for the odometry around them
  std::deque<Fix> fixes_;               // accepted ones or rough places, while there is no window
  std::deque<SensorReading> readings_;  // while there is no window
  PlaceTimes places_;
  int epoch_ = -1;
  Stamp now_;  // of the newest sample of the odometry
  Stamp last_cycle_;
  Eigen::Vector3d smooth_ = Eigen::Vector3d::Zero();
  int failures_ = 0;

  Announcements says_;
};

}  // namespace waymark::live
