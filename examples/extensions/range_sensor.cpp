// A further sensor: ranges to radio anchors (UWB). It has an edge type of its own, structured options and a
// noise that can be estimated; with enough anchors it needs no GNSS.
#include <map>

#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

using namespace waymark;

/// Distance from the antenna on the vehicle to an anchor.
struct EdgeAnchorRange {
  static constexpr std::string_view kTag = "EDGE_ANCHOR_RANGE";
  static constexpr int kErrorDimension = 1;
  static constexpr std::string_view kForm = "range";
  using Vertices = VertexList<VertexSe2>;
  static constexpr auto fields() {
    return std::array{field<&EdgeAnchorRange::measured>("measured"),
                      field<&EdgeAnchorRange::anchor>("anchor"), field<&EdgeAnchorRange::antenna>("antenna")};
  }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose) const {
    using std::sqrt;
    const Vector2<T> antenna_there = pose.position + rotate(pose.heading, constant_vector<T>(antenna));
    const Vector2<T> way = antenna_there - constant_vector<T>(anchor);
    // The square of a micrometre keeps the root differentiable at the anchor.
    return Eigen::Matrix<T, 1, 1>(sqrt(T(way.squaredNorm() + T(1e-12))) - T(measured));
  }
  double measured = 0;            // m on the grid
  Eigen::Vector2d anchor{0, 0};   // frame
  Eigen::Vector2d antenna{0, 0};  // body
};

class Ranges final : public SensorModel {
 public:
  explicit Ranges(const CheckedOptions& options)
      : mount_(read_mount(options)),
        sigma_(options.number("sigma")),
        geodetic_(options.word("places") == "wgs84") {
    for (const auto& [id, anchor] : options.value("anchors").entries())
      anchors_[id] = {anchor.at("x").number(), anchor.at("y").number()};
  }

  void extend(const SensorInput& input, Graph& graph) override {
    for (std::size_t row = 0; row < input.readings.size(); ++row) {
      const auto place = find_place(input.nodes, input.readings.stamps[row]);
      if (!place) continue;  // not within the drive
      const std::string id = shortest(number_of_reading(input.readings, row, 0, "anchor", 1e9));
      const auto anchor = anchors_.find(id);
      if (anchor == anchors_.end())
        fail_reading(input.readings, row, "anchor", "no anchor '" + id + "' in the options");
      const double range = number_of_reading(input.readings, row, 1, "range", kLargestLength_m);
      const Eigen::Vector2d antenna = place->ahead.position + rotate(place->ahead.heading, mount_.position);
      const double scale = grid_scale_at(input, input.readings.stamps[row]);
      const EdgePlace edge =
          graph.add_edge(EdgeAnchorRange{scale * range, in_frame(anchor->second, input.context), antenna},
                         {place->pose}, Eigen::Matrix<double, 1, 1>(1 / (sigma_ * sigma_)));
      if (input.groups == nullptr) continue;
      input.groups->one = "anchor";  // the report of a run has a section by anchor
      input.groups->many = "anchors";
      input.groups->add({.edge = edge,
                         .quantity = input.groups->quantity("range", "m"),
                         .group = input.groups->group(id, "")});
    }
  }

 private:
  /// x and y of the options are metres in the frame, or longitude and latitude.
  [[nodiscard]] Eigen::Vector2d in_frame(const Eigen::Vector2d& place, const DriveContext& context) const {
    if (!geodetic_) return place;
    return context.require_geodesy()
        .to_grid({.latitude_deg = place.y(), .longitude_deg = place.x()})
        .position;
  }

  std::map<std::string, Eigen::Vector2d> anchors_;
  Pose2<double> mount_;
  double sigma_;
  bool geodetic_;
};

static std::vector<OptionInfo> options() {
  const auto coordinate = [](const char* name) {
    return OptionInfo{.name = name, .allowed = OptionRange{}, .text = "coordinate", .required = true};
  };
  std::vector<OptionInfo> all = {
      {.name = "anchors",
       .value = "{}",
       .allowed = mapping_of({.allowed = OptionRecord{{coordinate("x"), coordinate("y")}}}),
       .text = "the anchors by their ids in the log"},
      {.name = "places",
       .value = "frame",
       .allowed = OptionWords{"frame", "wgs84"},
       .text = "'frame': x and y of the anchors are metres in the frame; 'wgs84': longitude and latitude"},
      {.name = "sigma",
       .value = "0.1",
       .unit = "m",
       .allowed = OptionRange{1e-4, 100},
       .text = "standard deviation of a range",
       .prior = NoisePrior{.mean = 0.1, .deviation = 1}}};
  for (const OptionInfo& option : mount_options()) all.push_back(option);
  return all;
}

static std::vector<SensorColumn> columns() {
  return {{"anchor", "1", "", true, "id of the anchor, a whole number"},
          {"range", "m", "", true, "measured distance"}};
}

static void register_types(TypeRegistry& registry) {
  registry.add_edge<EdgeAnchorRange>();
  registry.add_sensor_model({"ranges", "distances to radio anchors", columns(), options(),
                             [](const CheckedOptions& given) { return std::make_unique<Ranges>(given); }});
}
WAYMARK_PLUGIN(range_sensor, "1.0.0", register_types);
