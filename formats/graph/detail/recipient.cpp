#include <waymark/formats/graph/detail/recipient.hpp>

#include <algorithm>
#include <array>

namespace waymark::formats {
namespace {

constexpr std::array<std::string_view, 10> kG2oTags = {"VERTEX_SE2",
                                                       "VERTEX_XY",
                                                       "EDGE_SE2",
                                                       "EDGE_SE2_XY",
                                                       "EDGE_PRIOR_SE2",
                                                       "EDGE_PRIOR_XY",
                                                       "EDGE_PRIOR_SE2_XY",
                                                       "EDGE_SE2_OFFSET",
                                                       "EDGE_BEARING_SE2_XY",
                                                       "EDGE_SE2_POINTXY_OFFSET"};
constexpr std::array<std::string_view, 2> kPoseTags = {"VERTEX_SE2", "EDGE_SE2"};

constexpr std::array kG2o = {GraphFormat::g2o};
constexpr std::array kToro = {GraphFormat::toro};
constexpr std::array kCovariance = {GraphFormat::covariance};
constexpr std::array kGtsam = {GraphFormat::g2o, GraphFormat::covariance, GraphFormat::toro};

constexpr VertexId kMostInt{std::numeric_limits<std::int32_t>::max()};
constexpr VertexId kLeastInt{std::numeric_limits<std::int32_t>::min()};
// The highest byte of a key is the letter of a GTSAM symbol.
constexpr VertexId kMostKey{(std::int64_t{1} << 56) - 1};

constexpr Recipient kAnyG2o = {
    .name = "g2o", .reader = "the g2o format", .formats = kG2o, .tags = kG2oTags, .fixing = Fixing::stated};
constexpr Recipient kAnyToro = {
    .name = "toro", .reader = "the TORO format", .formats = kToro, .tags = kPoseTags};
constexpr Recipient kAnyCovariance = {
    .name = "covariance", .reader = "GTSAM's covariance format", .formats = kCovariance, .tags = kPoseTags};

constexpr std::array<Recipient, 4> kProfiles = {{
    // OptimizableGraph::load: ids are int, and a negative id means "no vertex".
    // EdgeSE2PointXYOffset::computeError takes the point into the frame of the body, not
    // of the sensor.
    {.name = "g2o",
     .reader = "g2o",
     .formats = kG2o,
     .tags = kG2oTags,
     .fixing = Fixing::stated,
     .least_id = VertexId{0},
     .most_id = kMostInt,
     .applies_point_offset = false},
    // load2D of its dataset: keys are unsigned. It skips unknown tags, which include FIX and all
    // edges to VERTEX_XY. It takes a zero on the diagonal as a sign of another order and throws.
    {.name = "gtsam",
     .reader = "GTSAM's load2D",
     .formats = kGtsam,
     .tags = kPoseTags,
     .least_id = VertexId{0},
     .most_id = kMostKey,
     .zero_information = false},
    // Its pose_graph_2d knows two tags and stops at any other. It holds the vertex with
    // the lowest id.
    {.name = "ceres",
     .reader = "Ceres' pose_graph_2d",
     .formats = kG2o,
     .tags = kPoseTags,
     .fixing = Fixing::lowest_id,
     .least_id = kLeastInt,
     .most_id = kMostInt,
     .evaluates_as_example = true},
    // Its posegraph2 and posegraph drop a second edge from one vertex to another. The tree of all
    // poses has one root, the vertex with the lowest id, which is held.
    {.name = "toro",
     .reader = "TORO",
     .formats = kToro,
     .tags = kPoseTags,
     .fixing = Fixing::lowest_id,
     .least_id = kLeastInt,
     .most_id = kMostInt,
     .parallel_edges = false,
     .separate_parts = false},
}};

}  // namespace

const Recipient& any_reader(GraphFormat format) {
  if (format == GraphFormat::toro) return kAnyToro;
  return format == GraphFormat::covariance ? kAnyCovariance : kAnyG2o;
}

std::span<const Recipient> profiles() {
  return kProfiles;
}

const Recipient* find_profile(std::string_view name) {
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(),
                                  [&](const Recipient& profile) { return profile.name == name; });
  return found == kProfiles.end() ? nullptr : &*found;
}

}  // namespace waymark::formats
