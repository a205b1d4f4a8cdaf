#include <waymark/plugins/landmarks/landmarks.hpp>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <waymark/core/drive/kept_vertex.hpp>
#include <waymark/core/graph/scalar_state.hpp>
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::landmarks {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

enum Column : std::size_t { kId, kX, kY, kRange, kBearing, kSigma, kSigmaBearing, kMapX, kMapY };

std::vector<SensorColumn> columns() {
  return {{"id", "1", "", true, "id of the landmark, a whole number"},
          {"x", "m", "", false, "position seen from the sensor, forward"},
          {"y", "m", "", false, "position seen from the sensor, to the left"},
          {"range", "m", "", false, "distance from the sensor, instead of x and y"},
          {"bearing", "rad", "ccw", false, "direction from straight ahead, with range"},
          {"sigma", "m", "", false, "standard deviation of x and y, or of the range"},
          {"sigma_bearing", "rad", "", false, "standard deviation of the bearing"},
          {"map_x", "m", "x", false, "known position of the landmark in the frame: x"},
          {"map_y", "m", "y", false, "known position of the landmark in the frame: y"}};
}

std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all = {
      {"sigma", "0.2", "m", OptionRange{1e-6, 1e4},
       "sigma of x and y, or of the range, if the row states none"},
      {"sigma_bearing_deg", "0.5", "deg", OptionRange{1e-4, 180}, "sigma of bearings that state none"},
      {"map_sigma", "0.1", "m", OptionRange{0, 1e3},
       "sigma of the places in the map, x and y; 0: the map is exact",
       NoisePrior{.mean = 0.1, .deviation = 1.5}}};
  for (const OptionInfo& option : mount_options()) all.push_back(option);
  return all;
}

/// Maps the ids of the landmarks of a drive to their vertices.
class Landmarks {
 public:
  explicit Landmarks(double map_sigma_m) : map_sigma_m_(map_sigma_m) {}

  /// Returns the vertex of a landmark. Its first sight creates the vertex: at the place in the map, or
  /// else free at the place where it was seen.
  VertexIndex vertex(std::int64_t id, const Eigen::Vector2d& seen_at, Graph& graph) {
    return vertices_[id].in_or(graph, [&] {
      const auto known = map_.find(id);
      const Eigen::Vector2d place = known == map_.end() ? seen_at : known->second;
      const VertexIndex made = graph.add_vertex<VertexXy>(graph.free_id(), {place[0], place[1]});
      if (known != map_.end()) hold_at_map(made, place, graph);
      return made;
    });
  }

  /// Takes the places that these readings state. A landmark that was seen before moves to its place.
  void read_map(const SensorTable& readings, Graph& graph) {
    for (std::size_t row = 0; row < readings.size(); ++row) {
      const Eigen::Vector2d place(readings.at(row, kMapX), readings.at(row, kMapY));
      const bool has_x = !std::isnan(place[0]);
      const bool has_y = !std::isnan(place[1]);
      if (!has_x && !has_y) continue;
      if (has_x != has_y)
        fail_reading(readings, row, has_x ? "map_y" : "map_x", "map_x and map_y go together");
      (void)number_of_reading(readings, row, kMapX, "map_x", kLargestLength_m);
      (void)number_of_reading(readings, row, kMapY, "map_y", kLargestLength_m);
      const std::int64_t id = id_of(readings, row);
      const auto [entry, is_new] = map_.try_emplace(id, place);
      if (!is_new && entry->second != place)
        fail_reading(readings, row, "map_x", "another row has this landmark at another place");
      const VertexIndex seen = is_new ? vertices_[id].in(graph) : -1;
      if (seen < 0) continue;
      graph.set_value(seen, std::array{place[0], place[1]});
      hold_at_map(seen, place, graph);
    }
  }

  static std::int64_t id_of(const SensorTable& readings, std::size_t row) {
    constexpr double kLargest = 9e15;  // a double holds whole numbers exactly up to here
    const double id = readings.at(row, kId);
    if (id != std::floor(id) || std::abs(id) > kLargest)
      fail_reading(readings, row, "id", "expected a whole number, got " + shortest(id));
    return static_cast<std::int64_t>(id);
  }

 private:
  /// One error of the map counts once, however often its landmark is seen.
  void hold_at_map(VertexIndex landmark, const Eigen::Vector2d& place, Graph& graph) const {
    if (map_sigma_m_ > 0) {
      add_prior(graph, landmark, std::array{place[0], place[1]}, map_sigma_m_);
    } else {
      graph.set_fixed(landmark, true);
    }
  }

  double map_sigma_m_;
  std::map<std::int64_t, KeptVertex> vertices_;
  std::map<std::int64_t, Eigen::Vector2d> map_;
};

class LandmarkSensor final : public SensorModel {
 public:
  explicit LandmarkSensor(const CheckedOptions& options)
      : sigma_(options.number("sigma")),
        sigma_bearing_(kDegree * options.number("sigma_bearing_deg")),
        mount_(read_mount(options)),
        landmarks_(options.number("map_sigma")) {}

  void extend(const SensorInput& input, Graph& graph) override {
    landmarks_.read_map(input.readings, graph);
    for (std::size_t row = 0; row < input.readings.size(); ++row) {
      const std::int64_t id = Landmarks::id_of(input.readings, row);
      const bool polar = is_polar(input.readings, row);
      const double sigma = sigma_of_reading(input.readings, row, kSigma, "sigma", sigma_);
      const double sigma_bearing =
          sigma_of_reading(input.readings, row, kSigmaBearing, "sigma_bearing", sigma_bearing_);
      const auto place = find_place(input.nodes, input.readings.stamps[row]);
      if (!place) continue;
      const double scale = grid_scale_at(input, input.readings.stamps[row]);
      if (polar) {
        add_polar(input.readings, row, scale, *place, {sigma, sigma_bearing}, id, graph);
      } else {
        add_cartesian(input.readings, row, scale, *place, sigma, id, graph);
      }
    }
  }

 private:
  /// Tells whether a row gives range and bearing, and not x and y.
  static bool is_polar(const SensorTable& readings, std::size_t row) {
    const auto has = [&](Column column) { return !std::isnan(readings.at(row, column)); };
    if (!has(kRange) && !has(kBearing)) {
      if (!has(kX)) fail_reading(readings, row, "x", "no value: give x and y, or range and bearing");
      if (!has(kY)) fail_reading(readings, row, "y", "no value: x and y go together");
      return false;
    }
    if (has(kX) || has(kY))
      fail_reading(readings, row, "range", "give x and y, or range and bearing, not both");
    if (!has(kRange)) fail_reading(readings, row, "range", "no value: range and bearing go together");
    if (!has(kBearing)) fail_reading(readings, row, "bearing", "no value: range and bearing go together");
    if (!(number_of_reading(readings, row, kRange, "range", kLargestLength_m) > 0))
      fail_reading(readings, row, "range", "must be above 0, got " + shortest(readings.at(row, kRange)));
    return true;
  }

  void add_polar(const SensorTable& readings, std::size_t row, double scale, const ReadingPlace& place,
                 const Eigen::Vector2d& sigmas, std::int64_t id, Graph& graph) {
    const Pose2<double> sensor = compose(place.ahead, mount_);
    EdgeSe2XyRangeBearing edge;
    edge.measured = {scale * readings.at(row, kRange),
                     wrap_angle(number_of_reading(readings, row, kBearing, "bearing", kLargestAngle_rad) +
                                sensor.heading)};
    edge.sensor = sensor.position;
    const Eigen::Vector2d along(edge.measured[0], 0);
    const Eigen::Vector2d seen = sensor.position + rotate(edge.measured[1], along);
    graph.add_edge(edge, {place.pose, landmarks_.vertex(id, in_frame(graph, place.pose, seen), graph)},
                   sigmas.cwiseAbs2().cwiseInverse().asDiagonal());
  }

  void add_cartesian(const SensorTable& readings, std::size_t row, double scale, const ReadingPlace& place,
                     double sigma, std::int64_t id, Graph& graph) {
    const Pose2<double> sensor = compose(place.ahead, mount_);
    const Eigen::Vector2d z(scale * number_of_reading(readings, row, kX, "x", kLargestLength_m),
                            scale * number_of_reading(readings, row, kY, "y", kLargestLength_m));
    const Eigen::Vector2d seen = sensor.position + rotate(sensor.heading, z);
    graph.add_edge(EdgeSe2Xy{seen},
                   {place.pose, landmarks_.vertex(id, in_frame(graph, place.pose, seen), graph)},
                   Eigen::Matrix2d::Identity() / (sigma * sigma));
  }

  static Eigen::Vector2d in_frame(const Graph& graph, VertexIndex pose, const Eigen::Vector2d& seen) {
    const auto value = graph.value(pose);
    return Eigen::Vector2d(value[0], value[1]) + rotate(value[2], seen);
  }

  double sigma_ = 0;
  double sigma_bearing_ = 0;
  Pose2<double> mount_;
  Landmarks landmarks_;
};

void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeSe2XyRangeBearing>();
  registry.add_sensor_model(
      {"landmarks", "landmarks by id, seen as x and y or as range and bearing", columns(), options(),
       [](const CheckedOptions& options) { return std::make_unique<LandmarkSensor>(options); }});
}

}  // namespace
}  // namespace waymark::plugins::landmarks

WAYMARK_PLUGIN(landmarks, "0.1.0", waymark::plugins::landmarks::register_types);
