// Residuals by group, from measurements whose errors are known.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/core/graph/loss.hpp>
#include <waymark/tools/evaluation/document/group_residuals.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace group_residuals_test {

using namespace waymark;
using namespace waymark::evaluation;

namespace {

/// One pose at the origin, and priors whose first error is known.
class Measured {
 public:
  Measured() {
    graph.add_vertex<VertexSe2>(VertexId{7}, {0, 0, 0});
    graph.set_stamp(0, Stamp::from_seconds(100));
    source.source = "receiver";
    source.groups.one = "satellite";
    source.groups.many = "satellites";
    source.groups.signal_name = "C/N0";
    source.groups.signal_unit = "dB-Hz";
  }

  /// @param information of the first component
  void add(const std::string& group, const std::string& family, const std::string& quantity, double error,
           double information, double signal, double elevation_rad, bool robust = true) {
    EdgePriorSe2 prior;
    prior.measured = {-error, 0, 0};
    const EdgePlace edge =
        graph.add_edge(prior, {0}, Eigen::Matrix3d(Eigen::Vector3d(information, 0, 0).asDiagonal()),
                       robust ? std::optional(builtin_loss("cauchy", 1)) : std::nullopt);
    source.groups.add({.edge = edge,
                       .quantity = source.groups.quantity(quantity, "m"),
                       .group = source.groups.group(group, family),
                       .signal = signal,
                       .bearing_rad = 1,
                       .elevation_rad = elevation_rad});
  }

  [[nodiscard]] GroupedResiduals residuals() const {
    return residuals_by_group(graph, std::vector{source}).front();
  }

  Graph graph;
  GroupsOfSource source;
};

}  // namespace

TEST_CASE("group residuals: rms, weights and shares are those of the edges of each group") {
  Measured measured;
  measured.add("G02", "GPS", "range", 3, 1, 40, 0.5);        // w = 3: Cauchy's weight 1 / (1 + 9)
  measured.add("G02", "GPS", "range", -4, 0.0625, 50, 0.7);  // w = 1: 1 / 2, which is not less than half
  measured.add("G02", "GPS", "rate", 2, 1, 50, 0.7);
  measured.add("R01", "GLONASS", "range", 1, 1, 30, 0.2, false);
  const GroupedResiduals of = measured.residuals();
  REQUIRE(of.groups.size() == 2);
  const QuantityResiduals& range = of.groups[0].quantities[0];
  CHECK(range.measurements == 2);
  CHECK(range.rms == Approx(std::sqrt((9 + 16) / 2.0)));
  CHECK(range.whitened_rms == Approx(std::sqrt((9 + 1) / 2.0 / 3)));  // the error has three components
  CHECK(range.robust == 2);
  CHECK(range.down_weighted == 1);
  CHECK(range.share_down_weighted() == Approx(0.5));
  CHECK(range.weight == Approx((0.1 + 0.5) / 2));
  CHECK(of.groups[0].signal == Approx((40 + 50 + 50) / 3.0));
  CHECK(of.groups[0].lowest_rad == Approx(0.5));
  CHECK(of.groups[0].highest_rad == Approx(0.7));
  CHECK(of.groups[0].quantities[1].measurements == 1);
  // Without a loss there is no share.
  CHECK(of.groups[1].quantities[0].robust == 0);
  CHECK(std::isnan(of.groups[1].quantities[0].share_down_weighted()));
  CHECK(of.groups[1].quantities[0].weight == 1);
  CHECK(of.groups[1].quantities[1].measurements == 0);
}

TEST_CASE("group residuals: families stay together, as they came, and names are in order") {
  Measured measured;
  for (const auto& [name, family] :
       std::vector<std::pair<std::string, std::string>>{{"G09", "GPS"}, {"E11", "Galileo"}, {"G02", "GPS"}})
    measured.add(name, family, "range", static_cast<double>(name[2] - '0'), 1, 40, 0.5);
  const GroupedResiduals of = measured.residuals();
  CHECK(of.families() == std::vector<std::string>{"GPS", "Galileo"});
  REQUIRE(of.groups.size() == 3);
  CHECK(of.groups[0].name == "G02");
  CHECK(of.groups[1].name == "G09");
  CHECK(of.groups[2].name == "E11");
  // The single measurements follow the groups.
  REQUIRE(of.measurements.size() == 3);
  CHECK(of.measurements[0].residual == Approx(2));
  CHECK(of.measurements[1].residual == Approx(9));
  CHECK(of.measurements[1].group == 1);
  CHECK(of.measurements[1].weight == Approx(1 / 82.0));
  CHECK(of.measurements[1].stamp == Stamp::from_seconds(100));
}

TEST_CASE("group residuals: tables and JSON tell each group, and each family in short") {
  Measured measured;
  measured.add("G02", "GPS", "range", 3, 1, 40, 0.5);
  measured.add("G05", "GPS", "range", 0, 1, 44, 1.0);
  measured.add("R01", "GLONASS", "range", 0, 1, 30, 0.2, false);
  const GroupedResiduals of = measured.residuals();
  const text::Table table = group_table(of);
  CHECK(table.columns == text::Row{"satellite", "of", "ranges", "rms [m]", "whitened rms",
                                   "down-weighted [%]", "mean C/N0 [dB-Hz]", "elevation [deg]"});
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0] == text::Row{"G02", "GPS", "1", "3", "1.732", "100.0", "40.0", "29 to 29"});
  CHECK(table.rows[2][5] == "no loss");
  const text::Table brief = family_table(of);
  CHECK(brief.columns.front() == "satellites of receiver");
  REQUIRE(brief.rows.size() == 2);
  CHECK(brief.rows[0] == text::Row{"GPS", "2", "2", "2.121", "1.225", "50.0"});
  CHECK(brief.rows[1][0] == "GLONASS");
  const nlohmann::ordered_json json = grouped_residuals_json(std::vector{of});
  CHECK(json[0]["source"] == "receiver");
  CHECK(json[0]["groups"][0]["name"] == "G02");
  CHECK(json[0]["groups"][0]["family"] == "GPS");
  CHECK(json[0]["groups"][0]["quantities"][0]["quantity"] == "range");
  CHECK(json[0]["groups"][0]["quantities"][0]["down_weighted"] == 1);
  CHECK(json[0]["groups"][0]["mean_signal"] == 40.0);
}

}  // namespace group_residuals_test
