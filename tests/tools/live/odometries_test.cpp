// Several odometries while driving: which one gives the nodes, what the others add, and what remains if one
// falls silent. Also the header of an output whose readers connect late.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <waymark/core/window/window_solver.hpp>
#include <waymark/tools/live/estimator/odometries.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>
#include <waymark/tools/live/outputs/byte_output.hpp>
#include <waymark/tools/live/outputs/lines.hpp>
#include <waymark/types_se2/se2.hpp>

#include "live_drive.hpp"
#include "support/registry.hpp"

namespace odometries_test {

using namespace waymark;
using namespace waymark::live;
using waymark_test::LiveDrive;
using waymark_test::Said;

namespace {

Stamp at(double seconds) {
  return Stamp{1'000'000'000'000}.later(seconds);
}

/// Lets an estimator with two odometries hear a drive, without what `leaves_out` names.
template <typename LeavesOut>
Said listen_to_both(const LiveDrive& drive, const LeavesOut& leaves_out, bool first_only = false) {
  drive::DriveDescription description = waymark_test::live_description();
  description.odometry.resize(first_only ? 1 : 2);
  description.odometry[0].name = "wheels";
  if (!first_only) description.odometry[1].name = "visual";
  Estimator estimator(description, waymark_test::live_fusion(), {}, waymark_test::registry());
  Said said;
  for (const Sample& sample : drive.arrivals) {
    if (leaves_out(sample) || (first_only && std::holds_alternative<FurtherOdometry>(sample))) continue;
    estimator.take(sample);
    for (const Report& report : estimator.reports()) {
      if (const auto* pose = std::get_if<LivePose>(&report)) said.poses.push_back(*pose);
      if (const auto* event = std::get_if<Event>(&report)) said.events.push_back(*event);
    }
  }
  said.counts = estimator.counts();
  said.state = estimator.state();
  return said;
}

/// Adds a second odometry that has no errors, with less than half the rate of the first one.
void add_exact_odometry(LiveDrive& drive) {
  const std::vector<StampedPose>& truth = drive.simulated.poses;
  Stamp next = truth.front().stamp.later(0.1);
  for (std::size_t i = 1; i + 1 < truth.size(); ++i) {
    if (truth[i].stamp < next) continue;
    next = truth[i].stamp.later(0.1 - 1e-6);
    const double dt_s = seconds_between(truth[i - 1].stamp, truth[i + 1].stamp);
    const Eigen::Vector3d step = truth[i + 1].pose - truth[i - 1].pose;
    drive.arrivals.emplace_back(
        FurtherOdometry{truth[i].stamp, 1, step.head<2>().norm() / dt_s, step[2] / dt_s});
  }
  std::stable_sort(drive.arrivals.begin(), drive.arrivals.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
}

bool nothing(const Sample&) {
  return false;
}

double longest_silence_s(const Said& said) {
  double longest = 0;
  for (std::size_t i = 1; i < said.poses.size(); ++i)
    if (said.poses[i - 1].heading_known)  // before, there is one with each fix
      longest = std::max(longest, seconds_between(said.poses[i - 1].stamp, said.poses[i].stamp));
  return longest;
}

}  // namespace

TEST_CASE("each reading of a further odometry counts once, and its mean motion is exact", "[live]") {
  // The speed grows by 1 m/s^2 and the yaw rate by 0.1 rad/s^2: means are those in the middle.
  Odometries odometries(2, 0.5);
  std::vector<Stamp> nodes;
  std::vector<MeasuredWay> ways;
  for (int tick = 0; tick <= 400; ++tick) {
    const double now_s = 0.01 * tick;
    if (tick % 4 == 0) {
      REQUIRE(odometries.take(0, {at(now_s), 0, 0}));
      odometries.made_node(0, at(now_s));
      nodes.push_back(at(now_s));
    }
    if (tick % 10 == 3) REQUIRE(odometries.take(1, {at(now_s), now_s, 0.1 * now_s}));
    for (const MeasuredWay& way : odometries.ways(nodes, 0, 1)) ways.push_back(way);
  }
  REQUIRE(ways.size() >= 36);
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const MeasuredWay& way = ways[i];
    CHECK(way.source == 1);
    if (i > 0) CHECK(way.from == ways[i - 1].to);
    const double middle_s = 0.5 * (seconds_between(at(0), way.from) + seconds_between(at(0), way.to));
    CHECK(way.interval.speed_mps == Approx(middle_s).margin(1e-9));
    CHECK(way.interval.yaw_rate_radps == Approx(0.1 * middle_s).margin(1e-9));
    // Samples are 0.1 s apart, nodes 0.04 s.
    CHECK(way.interval.dt_s > 0.07);
    CHECK(way.interval.dt_s < 0.13);
  }
}

TEST_CASE("poses beside the nodes leave the front of the elimination at their time", "[live]") {
  // Wheels at 25 Hz give the nodes, a camera measures beside them every 0.12 s.
  drive::DriveFacts facts;
  facts.relative = {"wheels", "visual"};
  facts.absolute.push_back({.name = "gnss", .sources = {0}});
  const drive::FusionSettings settings =
      drive::decided(waymark_test::live_fusion(), waymark_test::registry());
  Window window(facts, {}, settings, waymark_test::registry());
  const Interval step{.speed_mps = 10, .yaw_rate_radps = 0.05, .dt_s = 0.04};
  const Interval way{.speed_mps = 10, .yaw_rate_radps = 0.05, .dt_s = 0.12};
  const Eigen::Vector3d twist(10 * 0.04, 0, 0.05 * 0.04);
  Pose2<double> pose(0, 0, 0);
  const auto fix_at = [&](Stamp stamp) {
    Fix fix;
    fix.stamp = stamp;
    fix.position = pose.position;
    fix.covariance = Eigen::Matrix2d::Identity();
    return fix;
  };
  PlacedStretch stretch;
  stretch.stamps = {at(0), at(0.04)};
  stretch.poses = {pose.vector(), compose(pose, se2_exp(twist)).vector()};
  stretch.intervals = {step};
  stretch.givers = {0};
  stretch.fixes = {fix_at(at(0))};
  pose = compose(pose, se2_exp(twist));
  stretch.fixes.push_back(fix_at(at(0.04)));
  REQUIRE(window.begin(stretch));
  std::vector<int> fronts;
  for (int node = 2; node <= 1500; ++node) {
    const Stamp now = at(0.04 * node);
    pose = compose(pose, se2_exp(twist));
    window.add_node(now, step, 0);
    if (node % 3 == 0 && node > 3) window.add_way({1, at(0.04 * (node - 3)), now, way});
    if (node % 25 == 0) window.add_fix(fix_at(now), {});
    if (node % 500 != 0) continue;
    REQUIRE(window.solve());
    Graph graph = window.graph();
    WindowSolver solver(graph);
    REQUIRE(solver.update({}).solved);
    fronts.push_back(solver.largest_front());
  }
  CAPTURE(fronts);
  // A pose of the nodes, the last one of either track, and the states that are open at a time: six of
  // calibration for each odometry, the delay, bias and multipath.
  CHECK(fronts.back() == fronts.front());
  CHECK(fronts.back() <= 30);
}

TEST_CASE("two odometries are both used, and the pose is better for it", "[live]") {
  double alone = 0;
  double both = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    LiveDrive drive = waymark_test::live_drive("mixed", 240, seed);
    add_exact_odometry(drive);
    const auto in_outage = [&](const Sample& sample) {
      const double at_s = seconds_between(stamp_of(drive.arrivals.front()), stamp_of(sample));
      return std::holds_alternative<GeodeticFix>(sample) && at_s > 120 && at_s < 180;
    };
    Said one = listen_to_both(drive, in_outage, true);
    Said two = listen_to_both(drive, in_outage);
    CHECK(two.counts.failures == 0);
    CHECK(two.counts.resets == 0);
    CHECK(two.counts.refused.empty());
    CHECK(two.counts.taken.at("visual") > 1000);
    // The nodes are those of the first one.
    CHECK(two.poses.size() == one.poses.size());
    alone += std::pow(waymark_test::rms(waymark_test::errors_m(one, drive)), 2);
    both += std::pow(waymark_test::rms(waymark_test::errors_m(two, drive)), 2);
  }
  CAPTURE(alone, both);
  CHECK(both < alone);
}

TEST_CASE("an odometry that falls silent is replaced by the next one, and takes over again", "[live]") {
  LiveDrive drive = waymark_test::live_drive("mixed", 300);
  add_exact_odometry(drive);
  const auto seconds = [&](const Sample& sample) {
    return seconds_between(stamp_of(drive.arrivals.front()), stamp_of(sample));
  };
  const Said whole = listen_to_both(drive, nothing);
  CHECK(whole.counts.failures == 0);
  CHECK(whole.counts.resets == 0);
  SECTION("the first one is gone for a minute") {
    const Said said = listen_to_both(drive, [&](const Sample& sample) {
      return std::holds_alternative<OdometrySample>(sample) && seconds(sample) > 120 && seconds(sample) < 180;
    });
    CHECK(said.counts.resets == 0);
    CHECK(said.counts.failures == 0);
    CHECK(said.count("odometry") >= 2);
    CHECK(longest_silence_s(said) < 1);
    CHECK(waymark_test::rms(waymark_test::errors_m(said, drive)) <
          1.5 * waymark_test::rms(waymark_test::errors_m(whole, drive)));
  }
  SECTION("the second one is switched on later and dies") {
    const Said said = listen_to_both(drive, [&](const Sample& sample) {
      return std::holds_alternative<FurtherOdometry>(sample) &&
             (seconds(sample) < 100 || seconds(sample) > 200);
    });
    CHECK(said.counts.resets == 0);
    CHECK(said.counts.failures == 0);
    CHECK(waymark_test::rms(waymark_test::errors_m(said, drive)) <
          1.5 * waymark_test::rms(waymark_test::errors_m(whole, drive)));
  }
}

TEST_CASE("an odometry that the others contradict is used no longer when the drive has shown it", "[live]") {
  LiveDrive drive = waymark_test::live_drive("mixed", 300);
  add_exact_odometry(drive);
  const Said sound = listen_to_both(drive, nothing);
  CHECK(sound.count("left_out") == 0);
  std::string wrong;
  SECTION("the one that gives the nodes, in km/h: the estimate begins anew with the other one") {
    wrong = "wheels";
    for (Sample& sample : drive.arrivals)
      if (auto* odometry = std::get_if<OdometrySample>(&sample)) odometry->speed_mps *= 3.6;
  }
  SECTION("another one, whose turns have the wrong sign") {
    wrong = "visual";
    for (Sample& sample : drive.arrivals)
      if (auto* odometry = std::get_if<FurtherOdometry>(&sample)) odometry->yaw_rate_radps *= -1;
  }
  const Said said = listen_to_both(drive, nothing);
  REQUIRE(said.count("left_out") == 1);
  for (const Event& event : said.events)
    if (event.kind == "left_out") CHECK(event.source == wrong);
  CHECK(said.counts.refused.at(wrong + ": left out") > 500);
  std::size_t begun_anew = 0;
  for (const Event& event : said.events)
    begun_anew += event.text.find("is left out now") != std::string::npos;
  CHECK(begun_anew == (wrong == "wheels" ? 1 : 0));
  const auto of_the_end = [&](const Said& of) {
    const std::vector<double> errors = waymark_test::errors_m(of, drive);
    return waymark_test::rms(std::span(errors).last(errors.size() / 3));
  };
  CHECK(of_the_end(said) < 1.5 * of_the_end(sound));
}

TEST_CASE("while all odometries are silent the state is lost, and is told once", "[live]") {
  const LiveDrive drive = waymark_test::live_drive("mixed", 120);
  const Said said = listen_to_both(drive, [&](const Sample& sample) {
    const double at_s = seconds_between(stamp_of(drive.arrivals.front()), stamp_of(sample));
    return std::holds_alternative<OdometrySample>(sample) && at_s > 60 && at_s < 68;
  });
  const auto lost = std::count_if(said.events.begin(), said.events.end(), [](const Event& event) {
    return event.text.find("-> lost") != std::string::npos;
  });
  CHECK(lost == 1);
  CHECK(said.counts.resets == 0);
  CHECK(said.state == State::tracking);
}

TEST_CASE("a client that connects later is told the frame first", "[live]") {
  const std::unique_ptr<ReportWriter> writer = make_json_writer();
  CHECK(writer->header().empty());
  const drive::Projection projection(Frame{32, true, 400'000, 5'800'000});
  const std::string lines = writer->write(Event{at(0), "state", "", "text"}, {&projection, TimeScale::gps});
  const std::string frame = lines.substr(0, lines.find('\n') + 1);
  CHECK(writer->header() == frame);
  CHECK(frame.find("\"kind\":\"frame\"") != std::string::npos);

  ByteOutput output(parse_address("tcp://127.0.0.1:0"), "", false);
  output.use_header(writer->header());
  sockaddr_in address{};
  socklen_t size = sizeof address;
  REQUIRE(::getsockname(output.listener(), reinterpret_cast<sockaddr*>(&address), &size) == 0);
  const int client = ::socket(AF_INET, SOCK_STREAM, 0);
  REQUIRE(::connect(client, reinterpret_cast<sockaddr*>(&address), size) == 0);
  output.work();
  output.write("next\n");
  std::string heard(frame.size() + 5, '\0');
  CHECK(::recv(client, heard.data(), heard.size(), MSG_WAITALL) == static_cast<ssize_t>(heard.size()));
  CHECK(heard == frame + "next\n");
  ::close(client);
}

}  // namespace odometries_test
