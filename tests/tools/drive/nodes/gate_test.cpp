// Every ruling of the outlier gate (tools/drive/README.md, "The gate").
#include <algorithm>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/comparison/frozen_fixes.hpp>
#include <waymark/tools/drive/nodes/gate.hpp>

namespace gate_test {

namespace {

using namespace waymark;
using namespace waymark::drive;

constexpr double kDegree = std::numbers::pi / 180;

/// Perfect fixes and the odometry that belongs to them, in a frame of its own (turned by 2 rad and moved).
struct Scene {
  std::vector<Fix> fixes;
  std::vector<Eigen::Vector3d> odometry;

  void add(double seconds, const Eigen::Vector2d& position, int source = 0) {
    Fix fix;
    fix.stamp = Stamp::from_seconds(seconds);
    fix.position = position;
    fix.epoch = static_cast<int>(fixes.size());
    fix.source = source;
    fixes.push_back(fix);
    const double c = std::cos(2.0);
    const double s = std::sin(2.0);
    odometry.emplace_back(c * position[0] - s * position[1] + 70, s * position[0] + c * position[1] - 30, 0);
  }
  GateSummary judge(const GateOptions& options = {}) { return apply_gate(fixes, odometry, options); }
  [[nodiscard]] std::vector<std::size_t> rejected() const {
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < fixes.size(); ++i)
      if (fixes[i].status == FixStatus::rejected) which.push_back(i);
    return which;
  }
};

using Indices = std::vector<std::size_t>;

/// Along a circle of 100 m radius.
Scene circle(double period_s, double speed, int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const double angle = speed * period_s * i / 100;
    scene.add(period_s * i, {100 * std::sin(angle), 100 * (1 - std::cos(angle))});
  }
  return scene;
}

Scene straight(double speed, int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) scene.add(i, {speed * i, 0});
  return scene;
}

}  // namespace

TEST_CASE("gate: fixes that follow the odometry agree, whatever its frame") {
  Scene scene = circle(1, 10, 60);
  const GateSummary summary = scene.judge();
  CHECK(summary.accepted == 60);
  CHECK(summary.rejected_percent() == 0);
  CHECK(summary.reasons.at("agrees") == 60);  // the first two too: judged backwards
  for (const Fix& fix : scene.fixes) {
    CHECK(std::abs(fix.chord_angle_rad) < 1e-9);
    CHECK(fix.displacement_m < 1e-9);
  }
}

TEST_CASE("gate: the angle limit is 1.5 degrees between the chords of one second") {
  for (const double degrees : {1.4, 1.6, -1.4, -1.6}) {
    Scene scene = straight(10, 3);
    scene.fixes[2].position = {10 + 10 * std::cos(degrees * kDegree), 10 * std::sin(degrees * kDegree)};
    scene.judge();
    CHECK(scene.fixes[2].chord_angle_rad == Approx(degrees * kDegree));
    CHECK(scene.fixes[2].reason == (std::abs(degrees) < 1.5 ? "agrees" : "angle"));
  }
}

TEST_CASE("gate: the displacement is compared as a vector and its limit is 15 m") {
  for (const double ahead : {14.0, 16.0}) {
    Scene scene = straight(30, 3);
    scene.fixes[2].position[0] += ahead;
    scene.judge();
    CHECK(scene.fixes[2].displacement_m == Approx(ahead));
    CHECK(scene.fixes[2].reason == (ahead < 15 ? "agrees" : "displacement"));
  }
  Scene sideways = straight(30, 3);
  sideways.fixes[2].position = {30, 30};  // right length, wrong direction
  sideways.judge();
  CHECK(sideways.fixes[2].displacement_m == Approx(30 * std::sqrt(2.0)));
  CHECK(sideways.fixes[2].reason == "both");
}

TEST_CASE("gate: one outlier costs itself and the two fixes whose chords contain it") {
  Scene scene = straight(10, 20);
  scene.fixes[10].position[1] += 40;
  scene.judge();
  CHECK(scene.rejected() == Indices{10, 11, 12});
}

TEST_CASE("gate: a lasting jump does not lock the gate out") {
  Scene scene = straight(10, 40);
  for (std::size_t i = 20; i < 40; ++i) scene.fixes[i].position[1] += 25;
  scene.judge();
  CHECK(scene.rejected() == Indices{20, 21});
}

TEST_CASE("gate: fixes between a jump and the jump back are rejected, also without the gate") {
  GateOptions off;
  off.enabled = false;
  Scene there_and_back = circle(1, 10, 200);
  for (std::size_t i = 50; i < 110; ++i) there_and_back.fixes[i].position += Eigen::Vector2d(60, -80);
  there_and_back.fixes[80].status = FixStatus::withheld;
  CHECK(there_and_back.judge(off).reasons.at("jump") == 59);
  CHECK(there_and_back.rejected().front() == 50);
  CHECK(there_and_back.rejected().back() == 109);

  // A block that is off by 30 m agrees in itself as well.
  Scene block = circle(1, 10, 200);
  for (std::size_t i = 50; i < 110; ++i) block.fixes[i].position += Eigen::Vector2d(0, 30);
  CHECK(block.judge(off).reasons.at("jump") == 60);

  // Which of two places is wrong is not known if the fixes do not come back.
  Scene elsewhere = circle(1, 10, 200);
  for (std::size_t i = 50; i < 200; ++i) elsewhere.fixes[i].position += Eigen::Vector2d(60, -80);
  CHECK(elsewhere.judge(off).rejected == 0);
  for (std::size_t i = 110; i < 200; ++i) elsewhere.fixes[i].position += Eigen::Vector2d(60, 80);
  CHECK(elsewhere.judge(off).rejected == 0);

  // The longer part is believed.
  Scene mostly_there = circle(1, 10, 200);
  for (std::size_t i = 50; i < 170; ++i) mostly_there.fixes[i].position += Eigen::Vector2d(60, -80);
  CHECK(mostly_there.judge(off).rejected == 0);
}

TEST_CASE("gate: the first two fixes are judged by their successors") {
  Scene scene = straight(10, 10);
  scene.fixes[0].position[1] += 40;
  scene.judge();
  CHECK(scene.fixes[0].reason == "both");
  CHECK(scene.fixes[1].status == FixStatus::accepted);
  CHECK(scene.rejected() == Indices{0, 2});
}

TEST_CASE("gate: two fixes are judged by the length of their chord, one is accepted") {
  Scene two = straight(10, 2);
  two.judge();
  CHECK(two.fixes[0].reason == "pair");
  CHECK(two.fixes[1].reason == "pair");
  CHECK(std::isnan(two.fixes[1].chord_angle_rad));
  two.fixes[1].position[0] += 20;
  two.judge();
  CHECK(two.rejected() == Indices{0, 1});
  CHECK_THROWS_WITH(require_accepted_fix(two.judge()),
                    Catch::StartsWith("all 2 fixes were rejected by the gate;"));

  Scene one = straight(10, 1);
  CHECK_NOTHROW(require_accepted_fix(one.judge()));
  CHECK(one.fixes[0].reason == "alone");
}

TEST_CASE("gate: no chord is formed across a gap") {
  Scene scene;
  for (int i = 0; i < 5; ++i) scene.add(i, {10.0 * i, 0});
  for (int i = 25; i < 30; ++i) scene.add(i, {10.0 * i, 0});
  // The odometry turned by 20 degrees unseen in the gap: no matter, each side is judged by itself.
  for (std::size_t i = 5; i < 10; ++i) {
    const Eigen::Vector3d p = scene.odometry[i];
    const double a = 20 * kDegree;
    scene.odometry[i] << std::cos(a) * p[0] - std::sin(a) * p[1], std::sin(a) * p[0] + std::cos(a) * p[1], 0;
  }
  CHECK(scene.judge().rejected == 0);
  // A bad first fix after it is found by its successors.
  scene.fixes[5].position[1] += 60;
  scene.judge();
  CHECK(scene.fixes[5].reason == "both");
  CHECK(scene.fixes[6].reason == "agrees");
}

TEST_CASE("gate: missing epochs lengthen the chords and the angle limit with them") {
  const auto turned = [](double degrees) {
    Scene scene;
    for (const double t : {0.0, 3.0, 6.0}) scene.add(t, {10 * t, 0});
    scene.fixes[2].position = {30 + 30 * std::cos(degrees * kDegree), 30 * std::sin(degrees * kDegree)};
    scene.judge();
    return scene.fixes[2].reason;
  };
  CHECK(turned(4.4) == "agrees");  // 1.5 degrees per second over 3 s: a possible gyro bias
  CHECK(turned(4.6) == "angle");
}

TEST_CASE("gate: at other rates the chords still span a second") {
  for (const double period : {0.04, 0.1, 0.2, 0.9, 1.0, 1.1}) {
    Scene scene = circle(period, 10, 200);
    // A sideways error of 10 cm is 0.57 degrees of a chord of 10 m: harmless, yet 5.7 degrees of one at 10
    // Hz.
    const Eigen::Vector2d across = (scene.fixes[100].position - Eigen::Vector2d(0, 100)).normalized();
    scene.fixes[100].position += 0.1 * across;
    CHECK(scene.judge().rejected == 0);
    // One of 50 cm is 2.9 degrees at any rate: the fix itself, and those a chord later.
    scene.fixes[100].position += 0.4 * across;
    scene.judge();
    CHECK(scene.fixes[100].reason == "angle");
    CHECK(scene.fixes[99].status == FixStatus::accepted);
    CHECK(scene.rejected().size() == 3);
  }
}

TEST_CASE("gate: short chords have no angle, the displacement alone decides") {
  Scene creeping = straight(0.8, 10);
  creeping.fixes[5].position[1] += 3;  // 75 degrees, and mere noise
  const GateSummary summary = creeping.judge();
  CHECK(summary.accepted == 10);
  CHECK(creeping.fixes[5].reason == "short");
  CHECK(std::isnan(creeping.fixes[5].chord_angle_rad));
  creeping.fixes[5].position[1] += 20;
  creeping.judge();
  CHECK(creeping.fixes[5].reason == "displacement");
}

TEST_CASE(
    "gate: fixes that slide away and back, or come back while none are received, are rejected as well") {
  GateOptions off;
  off.enabled = false;
  const auto wave = [](Scene& scene) {  // so that there is something usual to compare with
    for (std::size_t i = 0; i < scene.fixes.size(); ++i)
      scene.fixes[i].position[0] += 0.5 * std::sin(0.7 * static_cast<double>(i));
  };
  for (const double slide_s : {4.0, 8.0, 16.0}) {
    INFO("they slide for " << slide_s << " s");
    Scene slides = circle(1, 10, 400);
    wave(slides);
    for (std::size_t i = 0; i < 400; ++i) {
      const double away = std::min(static_cast<double>(i) - 100, 250 - static_cast<double>(i)) / slide_s;
      slides.fixes[i].position += std::clamp(away, 0.0, 1.0) * Eigen::Vector2d(24, 32);
    }
    REQUIRE(slides.judge(off).reasons.contains("jump"));
    CHECK(slides.rejected().front() >= 98);
    CHECK(slides.rejected().front() <= 103);  // the first of a slide are as good as right
    CHECK(slides.rejected().back() >= 245);
    CHECK(slides.rejected().back() <= 255);  // to 5 s
  }

  Scene gap;
  const Scene whole = circle(1, 10, 400);
  for (std::size_t i = 0; i < 400; ++i)
    if (i < 240 || i >= 255) gap.add(static_cast<double>(i), whole.fixes[i].position);
  wave(gap);
  for (std::size_t i = 100; i < 240; ++i) gap.fixes[i].position += Eigen::Vector2d(24, 32);
  CHECK(gap.judge(off).reasons.at("jump") == 140);

  // One slide says only that fixes and odometry differ.
  Scene once = circle(1, 10, 400);
  wave(once);
  for (std::size_t i = 100; i < 400; ++i)
    once.fixes[i].position += std::min(1.0, (static_cast<double>(i) - 100) / 8) * Eigen::Vector2d(24, 32);
  CHECK(once.judge(off).rejected == 0);
}

TEST_CASE("gate: of fixes at two places in turn those are rejected that are there for less than a third") {
  GateOptions off;
  off.enabled = false;
  const auto move = [](Scene& scene, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) scene.fixes[i].position += Eigen::Vector2d(0, 30);
  };
  // The end of the first burst and the beginning of the second enclose the right fixes.
  Scene bursts = circle(1, 10, 300);
  move(bursts, 0, 40);
  move(bursts, 100, 130);
  CHECK(bursts.judge(off).reasons.at("jump") == 30);
  CHECK(bursts.rejected().front() == 100);

  Scene more = circle(1, 10, 300);
  for (const std::size_t burst : {40U, 120U, 220U}) move(more, burst, burst + 20);
  CHECK(more.judge(off).reasons.at("jump") == 60);
  CHECK(more.rejected().front() == 40);

  Scene even = circle(1, 10, 300);
  move(even, 0, 70);
  move(even, 150, 220);
  CHECK(even.judge(off).rejected == 0);
}

TEST_CASE("gate: at standstill only a jump is rejected") {
  Scene parked = straight(0, 10);
  parked.fixes[4].position = {2, 3};
  parked.fixes[7].position = {0, 20};
  parked.judge();
  CHECK(parked.fixes[4].reason == "standstill");
  CHECK(parked.rejected() == Indices{7, 8});  // into the jump and out of it
}

TEST_CASE("gate: a receiver that stands while the vehicle moves is frozen") {
  Scene scene = straight(10, 20);
  for (std::size_t i = 10; i < 15; ++i) scene.fixes[i].position = scene.fixes[9].position;
  scene.judge();
  for (std::size_t i = 10; i < 15; ++i) CHECK(scene.fixes[i].reason == "frozen");
  for (std::size_t i = 10; i < 15; ++i) CHECK(scene.fixes[i].status == FixStatus::rejected);
}

TEST_CASE("gate: withheld fixes are neither judged nor used") {
  Scene scene = straight(10, 20);
  scene.fixes[10].status = FixStatus::withheld;
  scene.fixes[10].position[1] += 100;
  const GateSummary summary = scene.judge();
  CHECK(summary.withheld == 1);
  CHECK(summary.rejected == 0);
  CHECK(summary.accepted == 19);
  CHECK(scene.fixes[10].status == FixStatus::withheld);
  CHECK(scene.fixes[10].reason == "unjudged");
}

TEST_CASE("gate: receivers are judged apart: their offset is not a jump") {
  Scene scene;
  for (int i = 0; i < 20; ++i) {
    scene.add(i, {10.0 * i, 0}, 0);
    scene.add(i, {10.0 * i, 0}, 1);
    scene.fixes.back().position[1] += 30;
  }
  CHECK(scene.judge().rejected == 0);
}

TEST_CASE("gate: the gate can be off, and options are checked") {
  Scene scene = straight(10, 5);
  scene.fixes[2].position[1] += 100;
  scene.judge();
  GateOptions off;
  off.enabled = false;
  const GateSummary summary = scene.judge(off);  // overwrites an earlier verdict
  CHECK(summary.accepted == 5);
  CHECK(scene.fixes[2].reason == "off");
  CHECK(std::isnan(scene.fixes[2].displacement_m));

  GateOptions bad;
  bad.max_angle_rad = 0;
  CHECK_THROWS_AS(scene.judge(bad), UsageError);
  scene.odometry.pop_back();
  CHECK_THROWS_AS(scene.judge(), UsageError);
}

TEST_CASE("gate: a drive without a fix, or with all rejected, is an error with a remedy") {
  CHECK_THROWS_WITH(require_accepted_fix(GateSummary{}), "the drive has no GNSS fix");
  GateSummary rejected;
  rejected.rejected = 7;
  CHECK_THROWS_WITH(
      require_accepted_fix(rejected),
      Catch::StartsWith("all 7 fixes were rejected by the gate;") && Catch::Contains("turn the gate off"));
}

TEST_CASE("gate: more rejected than accepted fixes are warned about with the remedy") {
  GateSummary summary;
  summary.accepted = 50;
  summary.rejected = 50;
  CHECK(warning_of(summary).empty());
  summary.rejected = 450;
  CHECK_THAT(warning_of(summary), Catch::StartsWith("the gate rejects 450 of 500 fixes (90 %)") &&
                                      Catch::Contains("'correlated' needs no gate"));
  summary.reasons = {{"frozen", 440}};  // also a verdict of the gate
  CHECK_FALSE(warning_of(summary).empty());
  summary.reasons = {{"held", 440}};
  CHECK(warning_of(summary).empty());
}

TEST_CASE(
    "gate: fixes that repeat a position while the odometry moves are rejected, also if the gate is off") {
  std::vector<Fix> fixes(30);
  std::vector<Eigen::Vector3d> reckoned(30);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const auto second = static_cast<double>(i);
    fixes[i].stamp = Stamp::from_seconds(second);
    const bool stands = i >= 20;  // the vehicle itself
    reckoned[i] = Eigen::Vector3d(stands ? 200 : 10 * second, 0, 0);
    const bool frozen = i > 8 && i < 15;
    fixes[i].position = frozen ? Eigen::Vector2d(80, 0) : Eigen::Vector2d(reckoned[i].head<2>());
  }
  fixes[12].status = FixStatus::withheld;
  const std::vector<FrozenFixes> found = find_frozen_fixes(fixes, reckoned);
  REQUIRE(found.size() == 1);
  CHECK(found[0].repeated == std::vector<std::size_t>{9, 10, 11, 12, 13, 14});
  CHECK(found[0].distance_m == Approx(60));
  CHECK_THAT(warning_of(found[0], fixes[0].stamp),
             Catch::StartsWith("6 fixes repeat one position from 8.0 s to 14.0 s"));
  GateOptions off;
  off.enabled = false;
  const GateSummary summary = apply_gate(fixes, reckoned, off);
  CHECK(summary.rejected == 5);
  CHECK(summary.reasons.at("frozen") == 5);
  CHECK(fixes[8].status == FixStatus::accepted);
  CHECK(fixes[12].status == FixStatus::withheld);
  CHECK(fixes[25].status == FixStatus::accepted);
}

TEST_CASE("gate: a log that holds each fix until the next one has one fix of each") {
  GateOptions off;
  off.enabled = false;
  const auto driven = [](std::size_t held) {
    std::vector<Fix> fixes(100);
    std::vector<Eigen::Vector3d> reckoned(100);
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      fixes[i].stamp = Stamp::from_seconds(0.04 * static_cast<double>(i));
      reckoned[i] = Eigen::Vector3d(0.6 * static_cast<double>(i), 0, 0);  // 15 m/s
      fixes[i].position = reckoned[i / held * held].head<2>();
    }
    return std::pair(fixes, reckoned);
  };
  auto [fixes, reckoned] = driven(5);
  const std::vector<FrozenFixes> found = find_frozen_fixes(fixes, reckoned);
  REQUIRE(found.size() == 1);
  CHECK(found[0].repeated.size() == 80);
  CHECK(found[0].distance_m == Approx(20 * 4 * 0.6));
  CHECK_THAT(warning_of(found[0], fixes[0].stamp),
             Catch::StartsWith("the log holds each fix until the next one: 80"));
  const GateSummary summary = apply_gate(fixes, reckoned, off);
  CHECK(summary.accepted == 20);
  CHECK(summary.reasons.at("held") == 80);
  CHECK(fixes[5].status == FixStatus::accepted);

  // Each a place of its own; and a vehicle that stands repeats itself rightly.
  auto [all, reckoned_all] = driven(1);
  CHECK(apply_gate(all, reckoned_all, off).rejected == 0);
  for (Eigen::Vector3d& pose : reckoned) pose.setZero();
  for (Fix& fix : fixes) fix.position.setZero();
  CHECK(find_frozen_fixes(fixes, reckoned).empty());
}

}  // namespace gate_test
