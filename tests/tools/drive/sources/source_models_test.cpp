// What models see of a drive, and what is stated for single sources: options, losses, noise, places.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/drive/model/build.hpp>
#include <waymark/tools/drive/model/fuse.hpp>
#include <waymark/tools/drive/sensors/place_columns.hpp>
#include <waymark/tools/drive/sensors/sensor_logs.hpp>
#include <waymark/tools/evaluation/document/source_residuals.hpp>
#include <waymark/types_se2/g2o_edges.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace source_models_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Contains;

namespace {

constexpr double kSpeed = 8;
constexpr double kYawRate = 0.08;
constexpr double kLength_s = 120;

Pose2<double> truth_at(double t) {
  return compose(Pose2<double>(30, -20, 1.1), se2_exp<double>(Eigen::Vector3d(kSpeed * t, 0, kYawRate * t)));
}

/// What a sensor saw of its drive.
struct Seen {
  std::vector<std::string> sources;
  std::size_t odometry = 0;
  std::size_t readings = 0;
  Eigen::Vector3d ecef{0, 0, 0};
  double wheelbase_m = 0;
};

/// Measures the place of the body point; its options are structured.
class Positions final : public SensorModel {
 public:
  Positions(const CheckedOptions& options, Seen* seen) : sigma_(options.number("sigma")), seen_(seen) {
    const std::vector<double> shift = options.value("shift").numbers();
    shift_ = {shift[0], shift[1]};
  }

  void extend(const SensorInput& input, Graph& graph) override {
    if (seen_ != nullptr) look(input.context);
    for (std::size_t row = 0; row < input.readings.size(); ++row) {
      const auto node = nearest_node(input.nodes, input.readings.stamps[row]);
      if (!node) continue;
      const Eigen::Vector2d place(input.readings.at(row, 0), input.readings.at(row, 1));
      graph.add_edge(EdgePriorSe2Xy{place - shift_}, {input.nodes.poses[node->node]},
                     Eigen::Matrix2d::Identity() / (sigma_ * sigma_));
    }
  }

 private:
  void look(const DriveContext& context) const {
    for (const DriveSource& source : context.sources) seen_->sources.push_back(source.name);
    seen_->odometry = context.source("odometry").odometry.size();
    seen_->readings = context.source("beacons").readings->size();
    seen_->ecef = context.require_geodesy().to_ecef({{0, 0}, 40});
    seen_->wheelbase_m = context.vehicle.wheelbase_m;
  }

  double sigma_ = 1;
  Eigen::Vector2d shift_{0, 0};
  Seen* seen_ = nullptr;
};

SensorModelType positions_type(Seen* seen) {
  OptionInfo sigma{"sigma", "0.5", "m", OptionRange{1e-3, 100}, "of a position"};
  sigma.prior = NoisePrior{.mean = 0.5, .deviation = 1};
  return {"positions",
          "places of the body point",
          {{"x", "m", "x", true, "in the frame"}, {"y", "m", "y", true, "in the frame"}},
          {sigma,
           {.name = "shift",
            .value = "[0, 0]",
            .allowed = list_of({.unit = "m", .allowed = OptionRange{}}, 2, 2),
            .text = "added to every place"}},
          [seen](const CheckedOptions& options) { return std::make_unique<Positions>(options, seen); }};
}

TypeRegistry registry_with(Seen* seen = nullptr) {
  TypeRegistry registry = waymark_test::registry();
  registry.add_sensor_model(positions_type(seen));
  return registry;
}

/// A circle that only the sensor anchors. @param wild every twentieth reading is 100 m off
PreparedDrive circle(double sigma_m, bool wild = false) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  PreparedDrive drive;
  drive.frame = {33, true, 389600, 5818400};
  drive.vehicle.wheelbase_m = 2.7;
  PreparedSensor& sensor = drive.sensors.emplace_back();
  sensor.name = "positions";
  sensor.source = "beacons";
  sensor.readings.columns = 2;
  for (int i = 0; i <= 10 * kLength_s; ++i) {
    const Stamp stamp = Stamp::from_seconds(0.1 * i);
    drive.odometry.push_back({stamp, kSpeed, kYawRate});
    if (i % 5 != 0) continue;
    sensor.readings.stamps.push_back(stamp);
    const double off = wild && i % 100 == 0 ? 100 : 0;
    for (int axis = 0; axis < 2; ++axis)
      sensor.readings.values.push_back(truth_at(0.1 * i).position[axis] + sigma_m * normal(random) + off);
  }
  return drive;
}

FusionSettings stated_noise() {
  FusionSettings settings;
  settings.modeling = "g1";
  settings.calibration = Options();
  settings.estimates_noise = false;
  return settings;
}

/// Returns the rms distance of the fused nodes from the truth.
double rms_of(const FusedDrive& fused) {
  double sum = 0;
  int count = 0;
  const Graph& graph = fused.model.document.graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (graph.vertex_type(v).tag != VertexSe2::kTag) continue;
    const auto pose = graph.value<VertexSe2>(v);
    sum += (pose.position - truth_at(graph.stamp(v)->seconds()).position).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("source models: a drive without a receiver finds its start and the truth") {
  const FusedDrive fused = fuse(circle(0), stated_noise(), registry_with());
  REQUIRE(fused.minimum.summary.converged());
  CHECK(fused.minimum.summary.final_chi2 == Approx(0).margin(1e-4));
  CHECK(rms_of(fused) < 0.02);
}

TEST_CASE("source models: the stated first pose anchors dead reckoning") {
  PreparedDrive drive = circle(0);
  drive.sensors.clear();
  const Pose2<double> first = truth_at(0);
  drive.first_pose =
      FirstPose{.position = first.position, .heading_rad = first.heading, .sigma_m = 0.5, .sigma_rad = 0.02};
  FusionSettings settings = stated_noise();
  settings.minimization.covariances = "fixes";
  const FusedDrive fused = fuse(drive, settings, registry_with());
  CHECK(rms_of(fused) < 1e-6);
  const Eigen::MatrixXd& covariance = fused.model.document.covariances.front().covariance;
  CHECK(covariance(0, 0) == Approx(0.25).epsilon(1e-6));
  CHECK(covariance(2, 2) == Approx(4e-4).epsilon(1e-6));
}

TEST_CASE("source models: a drive that nothing anchors is refused with the remedy") {
  PreparedDrive drive = circle(0);
  drive.sensors.clear();
  CHECK_THROWS_WITH(fuse(drive, stated_noise(), registry_with()),
                    Contains("no source says where the vehicle is") && Contains("first_pose"));
  drive.first_pose =
      FirstPose{.position = Eigen::Vector2d(1, 2), .heading_rad = {}, .sigma_m = 1, .sigma_rad = 1};
  CHECK_THROWS_WITH(fuse(drive, stated_noise(), registry_with()), Contains("first_pose"));
}

TEST_CASE("source models: a sensor sees frame, vehicle and every source") {
  Seen seen;
  const FusedDrive fused = fuse(circle(0.1), stated_noise(), registry_with(&seen));
  REQUIRE(seen.sources.size() >= 2);
  CHECK(seen.sources[0] == "odometry");
  CHECK(seen.sources[1] == "beacons");
  CHECK(seen.odometry == 1201);
  CHECK(seen.readings == 241);
  CHECK(seen.wheelbase_m == 2.7);
  // WGS84: the semi-major axis is 6378137 m, the distance from the centre at a latitude of 52.5 degrees 6364.9 km
  CHECK(seen.ecef.norm() == Approx(6364900).margin(1500));
}

TEST_CASE("source models: the noise of a sensor is estimated from the drive") {
  FusionSettings settings = stated_noise();
  settings.estimates_noise = true;
  settings.odometry_options = {};
  settings.sources["beacons"].loss = "none";  // a loss has a sigma of its own
  const FusedDrive fused = fuse(circle(2), settings, registry_with());
  const auto& parameters = fused.model.noise.parameters;
  const auto sigma = std::find_if(parameters.begin(), parameters.end(),
                                  [](const NoiseParameter& p) { return p.name() == "beacons.sigma"; });
  REQUIRE(sigma != parameters.end());
  // 241 readings on two axes: 2 m with a relative deviation of about 1 / sqrt(2 * 482)
  CHECK(sigma->value == Approx(2).epsilon(0.12));
  CHECK(fused.model.settings.sources.at("beacons").options.at("sigma") == shortest(sigma->value));
}

TEST_CASE("source models: a loss by the name of the source weighs wild readings down") {
  FusionSettings settings = stated_noise();
  const TypeRegistry registry = registry_with();
  settings.sources["beacons"].loss = "none";
  const double without = rms_of(fuse(circle(0.3, true), settings, registry));
  settings.sources["beacons"].loss = "cauchy:2";
  const FusedDrive fused = fuse(circle(0.3, true), settings, registry);
  CHECK(rms_of(fused) < 0.2);
  CHECK(rms_of(fused) < 0.1 * without);

  const auto rows = evaluation::residuals_by_source(fused.model.document);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].source == "odometry");
  CHECK(rows[0].measurements == 1200);
  CHECK(rows[0].robust == 0);
  CHECK(rows[1].source == "beacons");
  CHECK(rows[1].tag == "EDGE_PRIOR_SE2_XY");
  CHECK(rows[1].measurements == 241);
  CHECK(rows[1].robust == 241);
  // Every twentieth of 241 is wild. A good one has s > 4, which halves the weight, in 0.4 of 100 cases.
  CHECK(rows[1].down_weighted >= 13);
  CHECK(rows[1].down_weighted <= 17);
  CHECK(rows[1].largest == Approx(std::sqrt(2.0) * 100 / 0.5).epsilon(0.02));
}

TEST_CASE("source models: a sensor has the loss of its type unless the drive states one") {
  const auto robust_of = [](const FusionSettings& settings, const std::string& loss) {
    TypeRegistry registry = waymark_test::registry();
    SensorModelType type = positions_type(nullptr);
    if (!loss.empty()) type.loss = loss;
    registry.add_sensor_model(type);
    return evaluation::residuals_by_source(fuse(circle(0.3, true), settings, registry).model.document)[1]
        .robust;
  };
  CHECK(SensorModelType{}.loss == "cauchy:2.4");
  CHECK(rms_of(fuse(circle(0.3, true), stated_noise(), registry_with())) < 0.2);
  CHECK(robust_of(stated_noise(), "") == 241);
  CHECK(robust_of(stated_noise(), "none") == 0);
  FusionSettings settings = stated_noise();
  settings.sources["beacons"].loss = "none";
  CHECK(robust_of(settings, "") == 0);
  CHECK_THROWS_WITH(robust_of(stated_noise(), "cauchi:2"), Contains("cauchi") && Contains("cauchy"));
}

TEST_CASE("source models: a noise parameter that belongs to a word of another option needs it") {
  const auto names_of = [](const Options& options) {
    TypeRegistry registry = waymark_test::registry();
    SensorModelType type = positions_type(nullptr);
    type.options.push_back({"kind", "plain", "", OptionWords{"plain", "other"}, "kind of the errors"});
    type.options[0].prior->where_option = "kind";
    type.options[0].prior->where_word = "other";
    registry.add_sensor_model(type);
    FusionSettings settings = stated_noise();
    settings.odometry_options = {};
    PreparedDrive drive = circle(2);
    drive.sensors[0].options = options;
    const PlacedDrive placed = place_drive(drive, timeline_of(drive), settings, registry);
    std::vector<std::string> names;
    for (const NoiseParameter& parameter :
         estimate_noise(placed, drive.sensors, settings, registry).parameters)
      names.push_back(parameter.name());
    return names;
  };
  const auto with = names_of({{"kind", "other"}});
  CHECK(std::find(with.begin(), with.end(), "beacons.sigma") != with.end());
  const auto without = names_of({});
  CHECK(std::find(without.begin(), without.end(), "beacons.sigma") == without.end());
}

TEST_CASE("source models: an unknown loss of a source is refused") {
  FusionSettings settings = stated_noise();
  settings.sources["beacons"].loss = "cauchi:2";
  CHECK_THROWS_WITH(fuse(circle(0.3), settings, registry_with()), Contains("cauchi") && Contains("cauchy"));
}

TEST_CASE("source models: structured options of a drive.yaml reach the model") {
  const TypeRegistry registry = registry_with();
  const auto parse = [](const std::string& options) {
    return parse_drive_file(
               "odometry: {file: o.csv}\nsensors:\n  - name: positions\n    file: p.csv\n    loss: huber:2\n    options: " +
                   options + "\n",
               "/d/drive.yaml")
        .description;
  };
  DriveDescription drive = parse("{shift: [1.5, -2], sigma: 3}");
  resolve_sensors(drive, registry);
  CHECK(drive.sensors[0].options == Options{{"shift", "[1.5, -2]"}, {"sigma", "3"}});
  drive = parse("{shift: [1.5, far]}");
  CHECK_THROWS_WITH(resolve_sensors(drive, registry),
                    Contains("/d/drive.yaml:3:5:") && Contains("'shift[2]' must be a number, got 'far'"));
}

TEST_CASE("place columns: degrees, UTM and ECEF come out in the frame") {
  const Frame frame{33, true, 389600, 5818400};
  const Projection projection(frame);
  const Eigen::Vector2d place(120.5, -33.25);
  const GeodeticPoint geodetic = projection.to_geodetic(place);
  const Eigen::Vector3d ecef = projection.to_ecef({place, 55});
  LogRequest request;
  request.readings = {{"x", "m", "x", true, ""}, {"y", "m", "y", true, ""}, {"z", "m", "height", false, ""}};
  const auto converted = [&](const char* x, const char* y, const char* z, const Eigen::Vector3d& given) {
    request.columns = {{"x", {"x", x, ""}}, {"y", {"y", y, ""}}, {"z", {"z", z, ""}}};
    check_place_columns(request);
    SensorTable table{{Stamp{0}, Stamp{1}}, {given[0], given[1], given[2], NAN, NAN, NAN}, 3};
    place_in_frame(request, &projection, table);
    CHECK(std::isnan(table.at(1, 0)));
    return Eigen::Vector3d(table.at(0, 0), table.at(0, 1), table.at(0, 2));
  };
  const Eigen::Vector3d expected(place[0], place[1], 55);
  CHECK(
      (converted("lon", "lat", "m", {geodetic.longitude_deg, geodetic.latitude_deg, 55}) - expected).norm() <
      1e-6);
  CHECK((converted("easting", "northing", "m", {389600 + 120.5, 5818400 - 33.25, 55}) - expected).norm() <
        1e-9);
  CHECK((converted("ecef_x", "ecef_y", "ecef_z", ecef) - expected).norm() < 1e-6);
  CHECK((converted("m", "m", "m", expected) - expected).norm() == 0);

  request.columns = {{"x", {"x", "lon", ""}}};
  CHECK_THROWS_WITH(check_place_columns(request), Contains("x (lon) and y (m) are no place"));
  request.columns = {{"x", {"x", "ecef_x", ""}}, {"y", {"y", "ecef_y", ""}}};
  CHECK_THROWS_WITH(check_place_columns(request), Contains("ecef_x, ecef_y and ecef_z go together"));
}

}  // namespace source_models_test
