/// One log of the description as a stream: bytes in pieces of any length become samples on the scale of the
/// drive.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/logs/open_log.hpp>
#include <waymark/tools/live/estimator/intake.hpp>
#include <waymark/tools/live/inputs/odometry_stream.hpp>

namespace waymark::live {

class Channel {
 public:
  enum class Role { odometry, gnss, sensor };

  /// @param log as in the description, resolved (drive::resolve_sensors)
  /// @param index of the receiver or of the sensor; of the log among those of the odometry
  /// @param parts the odometry that is assembled from parts; it outlives the channel
  /// @param odometry index of the odometry that the log belongs to
  /// @throws InputError for a format that is unknown or cannot be recognised
  Channel(Role role, const drive::LogConfig& log, std::size_t index, TimeScale scale, OdometryStream& parts,
          std::size_t odometry, const TypeRegistry& registry);

  /// Decodes a piece. Readings that need the frame wait for it.
  /// @param projection of the frame, once it is known
  /// @throws InputError for errors that concern the whole stream
  [[nodiscard]] std::vector<Sample> take(std::string_view piece, const drive::Projection* projection);
  /// Ends the stream: what was held back comes.
  [[nodiscard]] std::vector<Sample> finish(const drive::Projection* projection);
  /// The sender pauses: a record that waits for its next part is complete.
  [[nodiscard]] std::vector<Sample> pause(const drive::Projection* projection);

  /// Tells whether readings wait for the frame.
  [[nodiscard]] bool waits() const { return waiting_.size() > 0; }
  [[nodiscard]] const std::string& name() const { return log_.file; }
  [[nodiscard]] const LogData& data() const { return decoder_->data(); }
  [[nodiscard]] const std::vector<std::string>& notes() const { return chosen_.notes; }

 private:
  [[nodiscard]] Sample labelled(const OdometrySample& sample) const;
  [[nodiscard]] std::vector<Sample> collect(const drive::Projection* projection);

  Role role_;
  drive::LogConfig log_;
  std::size_t index_;
  TimeScale scale_;
  OdometryStream& parts_;
  std::size_t odometry_;
  drive::ChosenReader chosen_;
  std::unique_ptr<LogDecoder> decoder_;
  SensorTable waiting_;  ///< readings of places and headings from before the frame was known
};

}  // namespace waymark::live
