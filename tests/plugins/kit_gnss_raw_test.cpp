// Sensor kit: pseudoranges and range rates of a receiver, with its clock.
#include <numbers>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/evidence.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>
#include <waymark/plugins/gnss_raw/detail/satellite_groups.hpp>
#include <waymark/plugins/gnss_raw/gnss_raw.hpp>

#include "plugins/kit_drive.hpp"

namespace kit_gnss_raw_test {

using namespace waymark;
using namespace waymark::plugins::gnss_raw;
using namespace waymark_test;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRadius_m = 6'371'000;
constexpr double kSigma_m = 3;
constexpr double kRateSigma_mps = 0.1;
constexpr double kHeight_m = 40;

/// A spherical Earth. The frame begins at latitude and longitude 0; its axes go east and north.
class Sphere final : public Geodesy {
 public:
  [[nodiscard]] const Frame& frame() const override { return frame_; }
  [[nodiscard]] GridPoint to_grid(const GeodeticPoint& point) const override {
    return {.position = kRadius_m * kDegree * Eigen::Vector2d(point.longitude_deg, point.latitude_deg)};
  }
  [[nodiscard]] GeodeticPoint to_geodetic(const Eigen::Vector2d& position) const override {
    const Eigen::Vector2d degrees = position / (kRadius_m * kDegree);
    return {.latitude_deg = degrees.y(), .longitude_deg = degrees.x()};
  }
  [[nodiscard]] Eigen::Vector3d to_ecef(const PointWithHeight& point) const override {
    const Eigen::Vector2d angles = point.position / kRadius_m;
    return (kRadius_m + point.height_m) * Eigen::Vector3d(std::cos(angles.y()) * std::cos(angles.x()),
                                                          std::cos(angles.y()) * std::sin(angles.x()),
                                                          std::sin(angles.y()));
  }
  [[nodiscard]] PointWithHeight from_ecef(const Eigen::Vector3d& point) const override {
    const double radius = point.norm();
    return {.position =
                kRadius_m * Eigen::Vector2d(std::atan2(point.y(), point.x()), std::asin(point.z() / radius)),
            .height_m = radius - kRadius_m};
  }

 private:
  Frame frame_{.zone = 31};
};

const Sphere& sphere() {
  static const Sphere earth;
  return earth;
}

struct Satellite {
  int system = 1;
  int number = 0;
  Eigen::Vector3d position, velocity;  // ECEF at time 0
};

/// Nine satellites of two systems all over the sky. At latitude and longitude 0 up is x, east y, north z.
std::vector<Satellite> sky() {
  std::vector<Satellite> satellites;
  for (int i = 0; i < 9; ++i) {
    const double azimuth = 40.0 * i * kDegree;
    const double elevation = (15 + 30.0 * (i % 3)) * kDegree;
    const Eigen::Vector3d towards(std::sin(elevation), std::cos(elevation) * std::sin(azimuth),
                                  std::cos(elevation) * std::cos(azimuth));
    satellites.push_back({i < 6 ? 1 : 4, i + 1, Eigen::Vector3d(kRadius_m, 0, 0) + 2.2e7 * towards,
                          Eigen::Vector3d(300.0 * i - 900, 1500 - 400.0 * i, 2000)});
  }
  return satellites;
}

/// What the receiver has beside noise.
struct Receiver {
  double bias_m = 30'000;
  double drift_mps = -50;
  double glonass_m = 5;
  double step_at_s = 1e9;  // the clock is set back by 1 ms
  double slow_m = 0;       // what each satellite's pseudoranges are wrong by, all the drive (sigma)
  double rate_time_s = 0;  // how long an error of a range rate lasts
  // sigma of small errors that last for 10 s; large ones are rather late than early
  double reflections_m = 0;
};

constexpr double kReflections_s = 10;
constexpr double kReflectionSkew = 0.6;

/// The errors of the satellites, one draw for each.
class SatelliteErrors {
 public:
  SatelliteErrors(const Receiver& receiver, Noise& noise)
      : decay_(receiver.rate_time_s > 0 ? std::exp(-1 / receiver.rate_time_s) : 0),
        reflections_m_(receiver.reflections_m),
        noise_(noise) {
    for (const Satellite& satellite : sky())
      slow_m_.push_back(receiver.slow_m * (satellite.system == 4 ? 2 : 1) * noise(1));
    for (std::size_t i = 0; i < slow_m_.size(); ++i) rate_mps_.push_back(noise(kRateSigma_mps));
    if (reflections_m_ > 0)
      for (std::size_t i = 0; i < slow_m_.size(); ++i) reflected_.push_back(noise(1));
  }

  [[nodiscard]] double range_m(std::size_t satellite) {
    return slow_m_[satellite] + noise_(kSigma_m) +
           (reflections_m_ > 0 ? reflection_m(reflected_[satellite]) : 0);
  }
  /// A second after the last one.
  [[nodiscard]] double rate_mps(std::size_t satellite) {
    double& rate = rate_mps_[satellite];
    rate = decay_ * rate + std::sqrt(1 - decay_ * decay_) * noise_(kRateSigma_mps);
    return rate;
  }

 private:
  /// A shifted log-normal distribution of median 0, a second after the last one.
  double reflection_m(double& x) {
    const double decay = std::exp(-1 / kReflections_s);
    x = decay * x + std::sqrt(1 - decay * decay) * noise_(1);
    return reflections_m_ * std::expm1(kReflectionSkew * x) / kReflectionSkew;
  }

  double decay_;
  double reflections_m_;
  Noise& noise_;
  std::vector<double> slow_m_, rate_mps_, reflected_;
};

/// Returns the log of a receiver on the vehicle, at the full seconds after the first.
Readings log_of(const KitDrive& drive, const Receiver& receiver, Noise& noise) {
  Readings log("gnss_raw");
  SatelliteErrors errors(receiver, noise);
  for (std::size_t node = kNodesPerSecond; node < drive.truth.size(); node += kNodesPerSecond) {
    const double t = static_cast<double>(node) / kNodesPerSecond;
    const auto place = [&](std::size_t at) {
      return sphere().to_ecef({.position = drive.truth[at].position, .height_m = kHeight_m});
    };
    const Eigen::Vector3d velocity = (place(node) - place(node - 1)) * kNodesPerSecond;
    double clock = receiver.bias_m + receiver.drift_mps * t;
    if (t >= receiver.step_at_s) clock -= kLight_mps / 1000;
    for (std::size_t i = 0; i < sky().size(); ++i) {
      const Satellite satellite = sky()[i];
      const Eigen::Vector3d left = satellite.position + t * satellite.velocity;
      const double travel_s = (left - place(node)).norm() / kLight_mps;
      const Eigen::Vector3d way = turned_with_earth(left, travel_s) - place(node);
      const Eigen::Vector3d closing = turned_with_earth(satellite.velocity, travel_s) - velocity;
      const double system = satellite.system == 1 ? 0 : receiver.glonass_m;
      log.add(drive.stamps[node],
              {{"system", satellite.system},
               {"satellite", satellite.number},
               {"pseudorange", way.norm() + clock + system + errors.range_m(i)},
               {"range_rate", way.normalized().dot(closing) + receiver.drift_mps + errors.rate_mps(i)},
               {"satellite_x", left.x()},
               {"satellite_y", left.y()},
               {"satellite_z", left.z()},
               {"satellite_vx", satellite.velocity.x()},
               {"satellite_vy", satellite.velocity.y()},
               {"satellite_vz", satellite.velocity.z()}});
    }
  }
  return log;
}

/// The noise that log_of() has: no elevations, no C/N0, normal; white unless the receiver says more.
const Options kWhite = {{"pseudorange_sigma", "3"}, {"range_rate_sigma", "0.1"}, {"multipath_sigma", "0"},
                        {"tails", "gaussian"},      {"drift_walk", "0.001"},     {"clock_walk", "0.001"},
                        {"height_walk", "0.001"},   {"slow_sigma", "0"},         {"range_rate_time", "0.01"}};

KitDrive raw_drive(const Receiver& receiver, std::uint64_t seed, Options options = kWhite) {
  KitRecipe recipe;
  recipe.last_fix_s = -1;  // there are no fixes
  KitDrive drive = make_kit_drive(recipe, seed);
  Noise noise(seed + 1000);
  const Readings log = log_of(drive, receiver, noise);
  DriveContext context;
  context.geodesy = &sphere();
  registry()
      .make_sensor_model("gnss_raw", options)
      ->extend({drive.nodes(), {}, {0, 0}, log.table(), 1, "raw", context}, drive.graph);
  return drive;
}

}  // namespace

TEST_CASE("gnss_raw: a pseudorange is the distance and the clock, without loss of digits") {
  // A satellite 20,000 km straight up; the antenna is 3 m above the reference point, and the clock 7 m ahead.
  EdgeGnssPseudorange edge;
  edge.satellite = {0, 0, 2e7};
  edge.reference = {100, 200, 50};
  const auto error = [&](const Pose2<double>& pose, double height) {
    return edge.error(pose, height, Eigen::Vector2d(7, 0), 0.0, 0.0, 0.0)[0];
  };
  CHECK(error({100, 200, 0}, 53) == Approx(-3 + 7).margin(1e-9));
  // 300 m to the side add 300^2 / (2 * 2e7) m.
  CHECK(error({400, 200, 0}, 50) == Approx(0.00225 + 7).margin(1e-9));
  edge.spread = 4;
  edge.slow_spread = 2;
  CHECK(edge.error(Pose2<double>(100, 200, 0), 50.0, Eigen::Vector2d(0, 0), 2.0, 0.5, -1.5)[0] ==
        Approx(2 + 4 * 0.5 - 2 * 1.5).margin(1e-9));
  // A log-normal error: a deviation of 2 makes a pseudorange longer by more than one of -2 makes it shorter.
  edge.skew = 0.5;
  const auto lasting = [&](double deviation) {
    return edge.error(Pose2<double>(100, 200, 0), 50.0, Eigen::Vector2d(0, 0), 0.0, deviation, 0.0)[0];
  };
  CHECK(lasting(2) == Approx(4 * (std::exp(1) - 1) / 0.5));
  CHECK(lasting(-2) == Approx(4 * (std::exp(-1) - 1) / 0.5));
  CHECK(lasting(1e-6) == Approx(4e-6));
  // From 4 on it is a line, without a bend.
  const double step = lasting(1001) - lasting(1000);
  CHECK(step == Approx(4 * std::exp(0.5 * 4)));
  CHECK((lasting(4 + 1e-6) - lasting(4 - 1e-6)) / 2e-6 == Approx(step));
}

TEST_CASE("gnss_raw: a range rate falls by the speed towards the satellite") {
  // East at 10 m/s, a satellite in the east at the horizon, a tenth of a second between the poses.
  const EdgeGnssRangeRate edge{0, {1, 0}, 10, {0, 0}};
  CHECK(edge.error(Pose2<double>(0, 0, 0), Pose2<double>(1, 0, 0), Eigen::Vector2d(0, -50))[0] ==
        Approx(-60));
  // An antenna 2 m ahead moves to the left while the vehicle turns: nothing towards the east.
  const EdgeGnssRangeRate ahead{0, {0, 1}, 10, {2, 0}};
  CHECK(ahead.error(Pose2<double>(0, 0, 0), Pose2<double>(0, 0, 0.1), Eigen::Vector2d(0, 0))[0] ==
        Approx(-20 * std::sin(0.1)));
}

/// The normalised errors of the first and the last pose over many drives are chi-square of 3.
void check_consistency(const Receiver& receiver, const Options& options, double largest_rms_m) {
  constexpr int kDrives = 40;
  double first = 0;
  double last = 0;
  for (int i = 0; i < kDrives; ++i) {
    KitDrive drive = raw_drive(receiver, static_cast<std::uint64_t>(i), options);
    const Solution solution = solve(drive);
    first += solution.normalised(kNodesPerSecond);
    last += solution.normalised(static_cast<int>(drive.poses.size()) - 1);
    CHECK(solution.rms_position() < largest_rms_m);
  }
  check_mean_chi_square(first, 3, kDrives);
  check_mean_chi_square(last, 3, kDrives);
}

TEST_CASE("gnss_raw: errors of a drive without fixes are as its covariances say") {
  check_consistency({}, kWhite, 2);
}

TEST_CASE("gnss_raw: so they are where satellites are wrong all the drive long, GLONASS by twice as much") {
  Options options = kWhite;
  options["slow_sigma"] = "3";
  check_consistency({.slow_m = 3}, options, 12);
}

TEST_CASE("gnss_raw: so they are where an error of a range rate lasts for four epochs") {
  Options options = kWhite;
  options["range_rate_time"] = "4";
  check_consistency({.rate_time_s = 4}, options, 2);
}

constexpr double kSlow_m = 3;
constexpr double kSpread_m = 4;

/// Returns the standard deviation of expm1(skew x) / skew for a standard normal x.
double late_deviation() {
  const double growth = std::exp(kReflectionSkew * kReflectionSkew);
  return std::sqrt(growth * (growth - 1)) / kReflectionSkew;
}

TEST_CASE("gnss_raw: so they are where reflections last, and are rather late than early") {
  Options options = kWhite;
  options["multipath_sigma"] = shortest(kSpread_m * late_deviation());
  options["multipath_time"] = "10";
  options["reflection_skew"] = "0.6";
  check_consistency({.reflections_m = kSpread_m}, options, 10);
}

/// Returns the sum of the -log likelihoods of a few drives, each at its minimum, as the search for noise sees
/// them: reflections early and late alike.
double unlikeliness(double multipath_sigma, double slow_sigma) {
  constexpr std::uint64_t kDrives = 6;
  Options options = kWhite;
  options["multipath_sigma"] = shortest(multipath_sigma);
  options["slow_sigma"] = shortest(slow_sigma);
  options["multipath_time"] = "10";
  options["reflection_skew"] = "0";
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    KitDrive drive = raw_drive({.slow_m = kSlow_m, .reflections_m = kSpread_m}, seed, options);
    (void)solve(drive);
    sum += evidence(drive.graph).negative_log();
  }
  return sum;
}

TEST_CASE("gnss_raw: the likelihood of drives tells how large reflections and slow errors are") {
  const double reflections_m = kSpread_m * late_deviation();
  const double right = unlikeliness(reflections_m, kSlow_m);
  CHECK(right < unlikeliness(reflections_m / 1.5, kSlow_m));
  CHECK(right < unlikeliness(reflections_m * 1.5, kSlow_m));
  CHECK(right < unlikeliness(reflections_m, kSlow_m / 2));
  CHECK(right < unlikeliness(reflections_m, kSlow_m * 2));
}

TEST_CASE("gnss_raw: height, bias of a system and a clock that is set back are found") {
  KitDrive drive = raw_drive({.step_at_s = 30}, 7);
  CHECK(solve(drive).rms_position() < 2);
  const auto state = [&](std::string_view tag) { return drive.graph.value(find_state(drive.graph, tag)); };
  CHECK(state("VERTEX_GNSS_HEIGHT")[0] == Approx(kHeight_m).margin(3));
  CHECK(state("VERTEX_GNSS_CLOCK")[1] == Approx(-50).margin(0.1));
  // The millisecond at the beginning is taken off as well: 30 km are a tenth of one.
  CHECK(state("VERTEX_GNSS_CLOCK")[0] == Approx(30'000 - 50).margin(5));
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(drive.graph.vertex_count()); ++v)
    if (drive.graph.vertex_type(v).tag == "VERTEX_GNSS_SYSTEM_BIAS" && !drive.graph.fixed(v))
      CHECK(drive.graph.value(v)[0] == Approx(5).margin(1.5));
}

TEST_CASE("gnss_raw: positions of single epochs bear three wrong satellites of nine") {
  KitRecipe recipe;
  recipe.last_fix_s = -1;
  const KitDrive drive = make_kit_drive(recipe, 1);
  Noise noise(2);
  SensorTable table = log_of(drive, {.glonass_m = 0}, noise).table();
  for (std::size_t row = 0; row < table.size(); ++row)
    if (row % 9 == 1 || row % 9 == 4 || row % 9 == 8) table.values[row * table.columns + 2] += 250;
  const auto positions = registry().make_sensor_model("gnss_raw", kWhite)->rough_positions(table);
  REQUIRE(positions.size() == 60);
  std::vector<double> errors;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Pose2<double>& truth = drive.truth[(i + 1) * kNodesPerSecond];
    errors.push_back((sphere().from_ecef(positions[i].ecef).position - truth.position).norm());
  }
  std::sort(errors.begin(), errors.end());
  CHECK(errors[30] < 3 * kSigma_m);
  CHECK(errors[54] < 10 * kSigma_m);
}

TEST_CASE("gnss_raw: an epoch of two satellites is used, and gives no position of its own") {
  KitDrive drive = make_kit_drive({}, 3);
  Noise noise(4);
  const SensorTable all = log_of(drive, {}, noise).table();
  SensorTable two{{}, {}, all.columns};
  for (std::size_t row = 0; row < 2; ++row) {
    two.stamps.push_back(all.stamps[row]);
    for (std::size_t c = 0; c < all.columns; ++c) two.values.push_back(all.at(row, c));
  }
  const auto model = registry().make_sensor_model("gnss_raw", kWhite);
  CHECK(model->rough_positions(two).empty());
  DriveContext context;
  context.geodesy = &sphere();
  model->extend({drive.nodes(), drive.fixes, {0, 0}, two, 1, "raw", context}, drive.graph);
  CHECK(edges_of(drive.graph, "EDGE_GNSS_PSEUDORANGE") == 2);
  CHECK(edges_of(drive.graph, "EDGE_GNSS_RANGE_RATE") == 2);
}

TEST_CASE("gnss_raw: tells which satellite each edge is of, where it stands, and how strong it is") {
  KitDrive drive = make_kit_drive({}, 3);
  Noise noise(4);
  SensorTable log = log_of(drive, {}, noise).table();
  constexpr std::size_t kCn0Column = 11;
  for (std::size_t row = 0; row < log.size(); ++row)
    log.values[row * log.columns + kCn0Column] = 30 + static_cast<double>(row % 9);
  DriveContext context;
  context.geodesy = &sphere();
  MeasurementGroups groups;
  registry()
      .make_sensor_model("gnss_raw", kWhite)
      ->extend({drive.nodes(), drive.fixes, {0, 0}, log, 1, "raw", context, &groups}, drive.graph);
  CHECK(groups.one == "satellite");
  CHECK(groups.signal_name == "C/N0");
  REQUIRE(groups.groups.size() == 9);
  CHECK(groups.groups[0].name == "G01");
  CHECK(groups.groups[0].family == "GPS");
  CHECK(groups.groups[8].name == "R09");
  CHECK(groups.groups[8].family == "GLONASS");
  REQUIRE(groups.quantities.size() == 2);
  CHECK(groups.quantities[0].unit == "m");
  CHECK(groups.quantities[1].name == "range rate");
  REQUIRE(groups.members.size() == 2 * log.size());
  for (std::size_t m = 0; m < 18; ++m) {  // the first epoch
    const MeasurementGroups::Member& member = groups.members[m];
    const auto i = static_cast<double>(member.group);
    const std::string tag = drive.graph.edge_type(member.edge.batch).tag;
    CHECK(tag == (member.quantity == 0 ? "EDGE_GNSS_PSEUDORANGE" : "EDGE_GNSS_RANGE_RATE"));
    CHECK(member.edge.edge == member.group);
    CHECK(member.signal == 30 + i);
    CHECK(member.elevation_rad ==
          Approx((15 + 30.0 * static_cast<double>(member.group % 3)) * kDegree).margin(1e-3));
    CHECK(std::remainder(member.bearing_rad - 40 * i * kDegree, 2 * std::numbers::pi) ==
          Approx(0).margin(1e-3));
  }
}

TEST_CASE("gnss_raw: satellites have the names of RINEX") {
  CHECK(satellite_name(1, 5) == "G05");
  CHECK(satellite_name(2, 123) == "S23");
  CHECK(satellite_name(8, 31) == "E31");
  CHECK(satellite_name(32, 60) == "C60");
  CHECK(satellite_name(16, 3) == "16-03");
  CHECK(system_name(16) == "system 16");
}

TEST_CASE("gnss_raw: impossible rows are named") {
  const auto model = registry().make_sensor_model("gnss_raw", {});
  const auto reading = [](const std::map<std::string, double>& row) {
    Readings log("gnss_raw");
    log.add(kit_stamp(0), row);
    return log.table();
  };
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH(model->rough_positions(reading({{"satellite", 3.5}})),
                    Contains("column 'satellite': expected a whole number"));
  CHECK_THROWS_WITH(model->rough_positions(reading(
                        {{"satellite", 3}, {"satellite_x", 20'000}, {"satellite_y", 0}, {"satellite_z", 0}})),
                    Contains("the satellite is 20 km from the centre of the Earth"));
  CHECK_THROWS_WITH(model->rough_positions(reading({{"satellite", 3},
                                                    {"range_rate", 5},
                                                    {"satellite_x", 2.6e7},
                                                    {"satellite_y", 0},
                                                    {"satellite_z", 0}})),
                    Contains("a range rate needs the velocity"));
}

}  // namespace kit_gnss_raw_test
