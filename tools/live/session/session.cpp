#include <waymark/tools/live/session/session.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/tools/drive/description/log_config.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>
#include <waymark/tools/live/session/state_file.hpp>

namespace waymark::live {
namespace {

constexpr double kSaveEvery = 30;       // s on the clock of the drive
constexpr std::size_t kEventsKept = 8;  // for the dashboard

drive::DriveFile resolved(drive::DriveFile file, const TypeRegistry& registry) {
  drive::resolve_sensors(file.description, registry);
  if (file.description.odometry.empty())
    throw InputError(file.description.path + ": no odometry log is named");
  put_nodes_first(file.description);
  return file;
}

std::vector<OdometryStream> streams_of(const drive::DriveDescription& description) {
  std::vector<OdometryStream> streams;
  for (const drive::OdometryConfig& odometry : description.odometry)
    streams.emplace_back(odometry.logs.size(), odometry.assembly, description.timeline.gap_s);
  return streams;
}

/// Searches give way, but not so much that a machine with other work lets the estimate wait for them.
std::future<Learned> in_another_thread(std::function<Learned()> work) {
  constexpr int kNice = 5;
  return std::async(std::launch::async, [work = std::move(work)] {
    (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
    return work();
  });
}

/// The time of what an estimator does with a sample, by what it does.
class Stopwatch {
 public:
  Stopwatch(const Estimator& estimator, Latencies& latencies)
      : counts_(estimator.counts()),
        latencies_(latencies),
        solutions_(counts_.solutions),
        lessons_(counts_.lessons) {}

  /// Ends the time.
  void stop() {
    LatencyHistogram& of = counts_.lessons > lessons_       ? latencies_.learn
                           : counts_.solutions > solutions_ ? latencies_.solve
                                                            : latencies_.predict;
    of.add(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin_).count());
  }

 private:
  const Counts& counts_;
  Latencies& latencies_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::size_t solutions_;
  std::size_t lessons_;
};

}  // namespace

Session::Session(drive::DriveFile file, const LiveSettings& settings, const TypeRegistry& registry)
    : file_(resolved(std::move(file), registry)),
      registry_(registry),
      parts_(streams_of(file_.description)),
      estimator_(file_.description, file_.settings, settings, registry) {
  estimator_.learn_beside(in_another_thread);
  const drive::DriveDescription& description = file_.description;
  for (std::size_t odometry = 0; odometry < description.odometry.size(); ++odometry)
    for (std::size_t i = 0; i < description.odometry[odometry].logs.size(); ++i)
      add_channel(Channel::Role::odometry, description.odometry[odometry].logs[i], i, odometry);
  for (std::size_t i = 0; i < description.gnss.size(); ++i) {
    if (description.gnss[i].velocity)
      throw UsageError(description.gnss[i].place + "live fusion does not read a 'velocity' beside the fixes");
    add_channel(Channel::Role::gnss, description.gnss[i], i);
  }
  for (std::size_t i = 0; i < description.sensors.size(); ++i)
    if (description.sensors[i].log) add_channel(Channel::Role::sensor, *description.sensors[i].log, i);
}

void Session::add_channel(Channel::Role role, const drive::LogConfig& stated, std::size_t index,
                          std::size_t odometry) {
  drive::LogConfig log = stated;
  if (drive::is_address(log.file) && log.format == "auto") {
    if (log.file.rfind("gpsd://", 0) == 0) {
      log.format = "gpsd_json";
    } else if (log.file.rfind("can://", 0) == 0) {
      log.format = "candump";
    } else {
      throw InputError(log.place + log.file + ": the format of a live source must be stated: 'format: nmea'");
    }
  }
  const std::size_t channel = channels_.size();
  channels_.emplace_back(role, log, index, file_.description.scale(), parts_[odometry], odometry, registry_);
  const auto known = std::find_if(inputs_.begin(), inputs_.end(),
                                  [&](const Input& input) { return input.file == log.file; });
  if (known == inputs_.end()) {
    inputs_.push_back({log.file, {channel}});
  } else {
    known->channels.push_back(channel);
  }
}

void Session::add_output(std::unique_ptr<ReportWriter> writer, std::unique_ptr<ByteOutput> output,
                         double rate_hz) {
  outputs_.push_back({std::move(writer), std::move(output), rate_hz, std::nullopt, false});
}

void Session::use_state_file(const std::string& path) {
  state_file_ = path;
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown)) estimator_.begin_with(read_state_file(path));
}

const drive::Projection* Session::projection() {
  if (!projection_ && estimator_.frame()) projection_.emplace(*estimator_.frame());
  return projection_ ? &*projection_ : nullptr;
}

void Session::take(std::size_t input, std::string_view bytes) {
  Stopwatch watch(estimator_, latencies_);
  bool any = false;
  for (const std::size_t channel : inputs_[input].channels) {
    std::vector<Sample> samples;
    try {
      samples = bytes.empty() ? channels_[channel].pause(projection())
                              : channels_[channel].take(bytes, projection());
    } catch (const InputError& error) {
      tell("unreadable", error.what());
      continue;
    }
    any = any || !samples.empty();
    name_yaw_rates();
    hand_over(std::move(samples));
  }
  if (any) watch.stop();
}

/// Names the sources of yaw rates that are found by the channels of the parts.
void Session::name_yaw_rates() {
  for (std::size_t odometry = 0; odometry < parts_.size(); ++odometry) {
    std::string_view& known = file_.description.odometry[odometry].assembly.yaw_rate_from;
    const std::string_view found = parts_[odometry].yaw_rate_from();
    if (found.empty() || found == known) continue;
    known = found;
    estimator_.know_yaw_rate(odometry, found);
  }
}

void Session::hand_over(std::vector<Sample> samples) {
  for (Sample& sample : samples) {
    estimator_.take(std::move(sample));
    say();
  }
}

void Session::take(const Sample& sample) {
  Stopwatch watch(estimator_, latencies_);
  estimator_.take(sample);
  say();
  watch.stop();
}

std::vector<Sample> Session::decode_files() {
  std::vector<Sample> samples;
  const auto append = [&](std::vector<Sample> more) {
    samples.insert(samples.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  for (const Input& input : inputs_) {
    const std::string error = formats::read_in_pieces(input.file, [&](std::string_view piece) {
      for (const std::size_t channel : input.channels) append(channels_[channel].take(piece, projection()));
    });
    for (const std::size_t channel : input.channels) append(channels_[channel].finish(projection()));
    if (!error.empty()) tell("unreadable", error);
  }
  name_yaw_rates();
  const auto by_stamp = [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); };
  std::stable_sort(samples.begin(), samples.end(), by_stamp);
  // The first fix gives the frame, for which places and headings of sensors wait.
  const auto first = std::find_if(samples.begin(), samples.end(), [](const Sample& sample) {
    return std::holds_alternative<GeodeticFix>(sample);
  });
  const bool any_waits =
      std::any_of(channels_.begin(), channels_.end(), [](const Channel& channel) { return channel.waits(); });
  if (any_waits && first != samples.end()) {
    const auto& fix = std::get<GeodeticFix>(*first);
    estimator_.begin_at({fix.latitude_deg, fix.longitude_deg});
    for (Channel& channel : channels_) append(channel.pause(projection()));
    std::stable_sort(samples.begin(), samples.end(), by_stamp);
  }
  return samples;
}

void Session::say_to(Output& output, const Report& report, const Surroundings& around) {
  if (const auto* pose = std::get_if<LivePose>(&report); pose != nullptr && output.rate_hz > 0) {
    if (output.last && *output.last <= pose->stamp &&
        seconds_between(*output.last, pose->stamp) < 1 / output.rate_hz - 1e-6)
      return;
    output.last = pose->stamp;
  }
  const std::string lines = output.writer->write(report, around);
  if (!output.frame_told && around.projection != nullptr) {
    // Who connects from now on misses the line of the frame, unless it is part of the header.
    output.bytes->use_header(output.writer->header());
    output.frame_told = true;
  }
  output.bytes->write(lines);
}

void Session::say() {
  const std::vector<Report> reports = estimator_.reports();
  if (reports.empty()) return;
  const Surroundings around{projection(), file_.description.scale()};
  for (const Report& report : reports) {
    for (Output& output : outputs_) say_to(output, report, around);
    if (const auto* pose = std::get_if<LivePose>(&report)) {
      last_pose_ = *pose;
      track_.add(*pose);
    }
    if (const auto* event = std::get_if<Event>(&report)) {
      last_events_.push_back(*event);
      if (last_events_.size() > kEventsKept) last_events_.erase(last_events_.begin());
    }
  }
  if (state_file_.empty() || !last_pose_) return;
  if (saved_ && std::abs(seconds_between(*saved_, last_pose_->stamp)) < kSaveEvery) return;
  saved_ = last_pose_->stamp;
  save_state();
}

void Session::save_state() const {
  if (const std::optional<WarmStart> state = estimator_.warm_start()) write_state_file(state_file_, *state);
}

void Session::tell(const std::string& kind, const std::string& text) {
  const Event event{last_pose_ ? last_pose_->stamp : Stamp{}, kind, "", text};
  const Surroundings around{projection(), file_.description.scale()};
  for (Output& output : outputs_) say_to(output, event, around);
  last_events_.push_back(event);
  if (last_events_.size() > kEventsKept) last_events_.erase(last_events_.begin());
}

void Session::work() {
  for (Output& output : outputs_) {
    output.bytes->work();
    if (const std::string news = output.bytes->news(); !news.empty()) tell("output", news);
  }
}

void Session::reopen() {
  for (Output& output : outputs_) output.bytes->reopen();
}

void Session::finish() {
  estimator_.finish();
  say();
  if (!state_file_.empty()) save_state();
  for (Output& output : outputs_) {
    output.bytes->write(output.writer->footer());
    output.bytes->flush();
  }
}

std::size_t Session::lines_dropped() const {
  std::size_t dropped = 0;
  for (const Output& output : outputs_) dropped += output.bytes->dropped();
  return dropped;
}

std::vector<int> Session::listeners() const {
  std::vector<int> descriptors;
  for (const Output& output : outputs_)
    if (output.bytes->listener() >= 0) descriptors.push_back(output.bytes->listener());
  return descriptors;
}

std::size_t Session::corrupt() const {
  std::size_t count = 0;
  for (const Channel& channel : channels_) count += channel.data().corrupt;
  return count;
}

}  // namespace waymark::live
