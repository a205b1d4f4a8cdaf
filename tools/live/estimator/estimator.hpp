/// Fixed-lag fusion of samples as they arrive. It reads nothing, writes nothing, knows no wall clock and
/// starts no thread: what it says depends on the stamps of the samples and on the order of their arrival
/// alone. So a replay says the same, bit by bit.
///
///   Estimator estimator(file.description, file.settings, {}, registry);
///   estimator.take(odometry_sample); estimator.take(fix);
///   for (const Report& report : estimator.reports()) ...
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/live/estimator/intake.hpp>
#include <waymark/tools/live/estimator/odometries.hpp>
#include <waymark/tools/live/estimator/reports.hpp>
#include <waymark/tools/live/estimator/rough_places.hpp>
#include <waymark/tools/live/estimator/settings.hpp>
#include <waymark/tools/live/estimator/window.hpp>

namespace waymark::live {

/// Counts of everything that was taken. Nothing is dropped in silence.
struct Counts {
  std::map<std::string, std::size_t> taken;    ///< by source
  std::map<std::string, std::size_t> refused;  ///< by "source: reason"
  std::size_t solutions = 0;
  std::size_t failures = 0;  ///< of solutions
  std::uint32_t resets = 0;
  std::size_t late_fixes = 0;  ///< that entered at their own time
};

/// What a later run may begin with.
struct WarmStart {
  Stamp stamp;
  Frame frame;
  std::optional<Eigen::Vector3d> pose{};  ///< none: only the states are known
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  std::vector<KnownState> states{};
};

class Estimator {
 public:
  /// @param description sources, mounting, frame; its logs are not opened
  /// @param settings as for a whole drive; the noise is that of the options
  /// @param registry must outlive the object
  /// @throws UsageError for settings with names that the registry does not have
  Estimator(drive::DriveDescription description, const drive::FusionSettings& settings,
            const LiveSettings& live, const TypeRegistry& registry);
  ~Estimator();

  /// Begins at a pose that is known from a former run. Call it before the first sample.
  void begin_with(const WarmStart& start);

  /// Takes a sample, on the time scale of the drive. @throws PluginError from plugins
  void take(Sample sample);
  /// Ends the input: what waits for other samples is used.
  void finish();
  /// Returns what there is to say since the last call, in order.
  [[nodiscard]] std::vector<Report> reports();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// Returns the frame; empty before the first fix unless it is stated.
  [[nodiscard]] const std::optional<Frame>& frame() const { return frame_; }
  /// Returns the present estimate for a later run; empty while there is none.
  [[nodiscard]] std::optional<WarmStart> warm_start() const;
  /// Returns the vertices of the window.
  [[nodiscard]] std::size_t window_size() const;

 private:
  /// A sample of the odometry and the dead reckoning up to it, from anywhere.
  struct Reckoned {
    OdometrySample sample;
    std::size_t giver = 0;  // the odometry that measured it
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    double way_m = 0;
  };
  /// What is kept of the fixes of a source.
  struct Receiver {
    std::vector<Fix> used;                 // the last ones: their claims
    std::deque<Fix> judged;                // the last seconds, all of them, with the dead reckoning
    std::deque<Eigen::Vector3d> reckoned;  // antenna at these
    std::optional<std::int64_t> period;    // of the last one that was taken
    std::optional<Eigen::Vector2d> still;  // a position that repeats
    double still_way_m = 0;                // of the odometry when it began
  };

  void work();
  void hear(std::size_t source, const OdometrySample& sample);
  void advance(std::size_t source, const OdometrySample& sample);
  void add_motion(std::size_t source, const OdometrySample& sample);
  /// Returns the motion to a sample from the one before its place in odometry_; those after it are not used.
  [[nodiscard]] Interval motion_to(const OdometrySample& sample, std::size_t place) const;
  [[nodiscard]] bool has_several_odometries() const { return description_.odometry.size() > 1; }
  void use_pending();
  void use(const GeodeticFix& fix);
  void use(const SensorReading& reading);
  void use_rough_places();
  [[nodiscard]] const drive::Projection& projection_at(const GeodeticPoint& place);
  [[nodiscard]] Fix projected(const GeodeticFix& fix);
  [[nodiscard]] bool is_thinned(const GeodeticFix& fix);
  /// Returns why a fix cannot be right; empty if it may be.
  [[nodiscard]] std::string reason_against(const Fix& fix);
  [[nodiscard]] std::string judged_by_gate(const Fix& fix);
  [[nodiscard]] bool repeats(const Fix& fix);
  [[nodiscard]] bool is_absurd(const Fix& fix) const;
  [[nodiscard]] bool convinces(const Fix& fix);
  void begin_at_believed();
  void note_place_at(Stamp stamp);
  [[nodiscard]] Reckoned reckoned_at(Stamp stamp) const;
  void align();
  void align_warm();
  [[nodiscard]] bool heading_is_known() const;
  [[nodiscard]] PlacedStretch stretch() const;
  [[nodiscard]] std::vector<Fix> measured_fixes() const;
  [[nodiscard]] drive::DriveFacts facts() const;
  [[nodiscard]] std::unique_ptr<Window> empty_window(std::optional<drive::FirstPose> first_pose) const;
  void begin_window(const PlacedStretch& stretch, std::optional<drive::FirstPose> first_pose);
  void cycle();
  void drop();
  void reset(const std::string& kind, const std::string& text);
  void publish(bool corrected);
  void publish_place(const Fix& fix);
  void change_state(State state, const std::string& why);
  void judge_state();
  void say(const std::string& kind, const std::string& source, const std::string& text);
  void refuse(const Sample& sample, const std::string& reason, const std::string& text);
  [[nodiscard]] std::string source_of(const Sample& sample) const;
  [[nodiscard]] double usual_interval_s() const;
  [[nodiscard]] double radius95_m() const;

  drive::DriveDescription description_;
  drive::FusionSettings settings_;
  LiveSettings live_;
  const TypeRegistry& registry_;
  Intake intake_;
  Odometries odometries_;
  RoughPlaces rough_;
  std::unique_ptr<Window> window_;
  std::optional<Frame> frame_;
  std::optional<drive::Projection> projection_;
  std::optional<WarmStart> warm_;
  double standstill_mps_ = 0;

  std::deque<Reckoned> odometry_;       // of the window
  std::deque<Sample> pending_;          // fixes and readings that wait for the odometry around them
  std::deque<Fix> fixes_;               // accepted ones or rough places, while there is no window
  std::deque<SensorReading> readings_;  // while there is no window
  std::vector<Fix> absurd_;             // the last ones in a row
  std::map<int, Receiver> receivers_;
  int epoch_ = -1;
  double grid_scale_ = 1;
  Stamp now_;                      // of the newest sample of the odometry
  std::optional<Stamp> last_fix_;  // that was used
  Stamp last_cycle_;
  std::deque<double> fix_intervals_s_;
  Eigen::Vector3d smooth_ = Eigen::Vector3d::Zero();
  int failures_ = 0;

  State state_ = State::waiting;
  Counts counts_;
  std::vector<Report> reports_;
};

}  // namespace waymark::live
