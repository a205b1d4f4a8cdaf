// The clock of the odometry steps alone, while fixes go on: nothing is lost, and the poses are where they would be.
#include <cmath>
#include <variant>

#include <catch2/catch.hpp>

#include "live_drive.hpp"

namespace clock_steps_test {

using namespace waymark;
using namespace waymark::live;
using namespace waymark_test;

namespace {

bool is_odometry(const Sample& sample) {
  return std::holds_alternative<OdometrySample>(sample);
}

/// The stamps of the odometry are others from a share of the drive on; the order of arrival stays.
Arrivals with_step(const LiveDrive& drive, double step_s, double from_share) {
  Arrivals arrivals = drive.arrivals;
  for (auto i = static_cast<std::size_t>(from_share * static_cast<double>(arrivals.size()));
       i < arrivals.size(); ++i)
    if (auto* odometry = std::get_if<OdometrySample>(&arrivals[i]))
      odometry->stamp = odometry->stamp.later(step_s);
  return arrivals;
}

}  // namespace

TEST_CASE("a step of the odometry's clock alone is told and undone: no reset, no pose less, none elsewhere",
          "[live]") {
  const double step_s = GENERATE(-3600.0, -100.0, -20.0, -4.0, 4.0, 20.0, 100.0, 3600.0);
  CAPTURE(step_s);
  const LiveDrive drive = live_drive("rural", 55);
  const Said straight = listen(drive.arrivals);
  const Said said = listen(with_step(drive, step_s, 0.5));
  CHECK(said.count("clock") == 1);
  CHECK(said.counts.resets == 0);
  CHECK(said.counts.refused.empty());
  // A fix that waited for the odometry may come between other poses.
  CHECK(std::abs(static_cast<double>(said.poses.size()) - static_cast<double>(straight.poses.size())) <= 2);
  CHECK(rms(errors_m(said, drive)) < 1.1 * rms(errors_m(straight, drive)) + 0.1);
}

TEST_CASE("an odometry that was silent while its clock stepped goes on at the time of the fixes", "[live]") {
  const LiveDrive drive = live_drive("rural", 55);
  Arrivals arrivals;
  const Stamp begin = stamp_of(drive.arrivals.front());
  for (const Sample& sample : with_step(drive, 500, 0.5)) arrivals.push_back(sample);
  const Stamp half = stamp_of(drive.arrivals[arrivals.size() / 2]);
  std::erase_if(arrivals, [&](const Sample& sample) {
    const double after_s = seconds_between(half, stamp_of(sample)) - 500;
    return is_odometry(sample) && after_s >= -1 && after_s < 3 &&
           seconds_between(begin, stamp_of(sample)) > 400;
  });
  const Said said = listen(arrivals);
  CHECK(said.count("clock") == 1);
  // Its time is known to the lateness of the fixes, which are of another second.
  CHECK(rms(errors_m(said, drive)) < 6);
}

TEST_CASE("a silence of the odometry between fixes is no step of its clock", "[live]") {
  const LiveDrive drive = live_drive("rural", 55);
  Arrivals arrivals = drive.arrivals;
  const Stamp begin = stamp_of(arrivals.front());
  const bool fixes_too = GENERATE(false, true);
  std::erase_if(arrivals, [&](const Sample& sample) {
    const double at_s = seconds_between(begin, stamp_of(sample));
    return at_s > 30 && at_s < 35 && (fixes_too || is_odometry(sample));
  });
  const Said said = listen(arrivals);
  CHECK(said.count("clock") == 0);
  CHECK(said.counts.resets == 0);
}

TEST_CASE("clocks that are apart from the first sample on are joined by the order of arrival", "[live]") {
  const double apart_s = GENERATE(-1e6, 1e6);
  const LiveDrive drive = live_drive("rural", 55);
  const Said said = listen(with_step(drive, apart_s, 0));
  CHECK(said.count("jump") == 1);
  CHECK(said.state == State::tracking);
  CHECK(errors_m(said, drive).size() > 25 * 30);
  CHECK(rms(errors_m(said, drive)) < 1.5 * rms(errors_m(listen(drive.arrivals), drive)) + 1);
}

}  // namespace clock_steps_test
