/// A live run: channels, estimator and outputs in one thread. What comes in are pieces of bytes, or samples
/// of a replay; what goes out are lines.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/live/estimator/estimator.hpp>
#include <waymark/tools/live/inputs/channel.hpp>
#include <waymark/tools/live/outputs/byte_output.hpp>
#include <waymark/tools/live/outputs/lines.hpp>
#include <waymark/tools/live/session/latency.hpp>
#include <waymark/tools/live/session/track.hpp>

namespace waymark::live {

/// How long the work took, by what it was.
struct Latencies {
  LatencyHistogram predict;  ///< from a sample of the odometry to its lines
  LatencyHistogram solve;    ///< from the bytes of a fix to the lines of the corrected pose
  /// the same where the noise of the drive so far was taken over; a replay waits for the search in it
  LatencyHistogram learn;
};

class Session {
 public:
  /// @param file its sensors need not be resolved
  /// @throws InputError, UsageError as the parts do
  Session(drive::DriveFile file, const LiveSettings& settings, const TypeRegistry& registry);

  /// An input that one or several logs of the description share.
  struct Input {
    std::string file;
    std::vector<std::size_t> channels;
  };
  [[nodiscard]] const std::vector<Input>& inputs() const { return inputs_; }

  /// @param rate_hz poses are thinned to it, by their stamps; 0: all
  void add_output(std::unique_ptr<ReportWriter> writer, std::unique_ptr<ByteOutput> output, double rate_hz);
  /// Reads a state of a former run if the file exists, and writes it every 30 s and at the end.
  /// @throws InputError for a file that is none
  void use_state_file(const std::string& path);

  /// Ends what runs beside the estimate when this is set. @param stop must outlive the object
  void stop_with(const std::atomic<bool>& stop) { estimator_.stop_learning_with(stop); }

  /// Takes bytes of an input. Empty: the sender pauses.
  void take(std::size_t input, std::string_view bytes);
  /// Returns the description, with what the inputs so far have told of it.
  [[nodiscard]] const drive::DriveDescription& description() const { return file_.description; }
  /// Takes a sample of a replay.
  void take(const Sample& sample);
  /// Decodes the files of all inputs. @returns their samples, sorted by stamp
  [[nodiscard]] std::vector<Sample> decode_files();
  /// Tells the outputs what an input or an output has to say.
  void tell(const std::string& kind, const std::string& text);
  /// Accepts clients, and sends what waits.
  void work();
  void reopen();
  /// Ends the run.
  void finish();

  [[nodiscard]] const Estimator& estimator() const { return estimator_; }
  [[nodiscard]] const Latencies& latencies() const { return latencies_; }
  [[nodiscard]] const std::optional<LivePose>& last_pose() const { return last_pose_; }
  [[nodiscard]] const Track& track() const { return track_; }
  [[nodiscard]] const std::vector<Event>& last_events() const { return last_events_; }
  [[nodiscard]] std::size_t lines_dropped() const;
  /// Descriptors of outputs that wait for clients.
  [[nodiscard]] std::vector<int> listeners() const;
  [[nodiscard]] std::size_t corrupt() const;

 private:
  struct Output {
    std::unique_ptr<ReportWriter> writer;
    std::unique_ptr<ByteOutput> bytes;
    double rate_hz = 0;
    std::optional<Stamp> last;
    bool frame_told = false;
  };
  void add_channel(Channel::Role role, const drive::LogConfig& log, std::size_t index,
                   std::size_t odometry = 0);
  void name_yaw_rates();
  void hand_over(std::vector<Sample> samples);
  void say();
  void say_to(Output& output, const Report& report, const Surroundings& around);
  void save_state() const;
  [[nodiscard]] const drive::Projection* projection();

  drive::DriveFile file_;
  const TypeRegistry& registry_;
  std::vector<OdometryStream> parts_;  // of each odometry
  Estimator estimator_;
  std::vector<Channel> channels_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::optional<drive::Projection> projection_;
  std::string state_file_;
  std::optional<Stamp> saved_;
  Latencies latencies_;
  std::optional<LivePose> last_pose_;
  Track track_;
  std::vector<Event> last_events_;
};

}  // namespace waymark::live
