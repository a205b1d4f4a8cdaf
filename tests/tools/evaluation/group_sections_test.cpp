// The sections of a report about measurements by group, from made residuals.
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include <waymark/tools/report/drive/group_sections.hpp>

namespace group_sections_test {

using namespace waymark;
using namespace waymark::evaluation;
using namespace waymark::report;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A drive of so many seconds from 1000 s on, without poses.
struct Drive {
  explicit Drive(double seconds) {
    evaluation.epochs.resize(2);
    evaluation.epochs[0].stamp = Stamp::from_seconds(1000);
    evaluation.epochs[1].stamp = Stamp::from_seconds(1000 + seconds);
    document.fixes.resize(1);
    document.fixes[0].stamp = Stamp::from_seconds(1000);
  }

  [[nodiscard]] drawing::Section section(const GroupedResiduals& groups) const {
    ReportedDrive drive{
        .name = "", .label = "", .document = document, .evaluation = evaluation, .truth = truth};
    drive.groups = std::span(&groups, 1);
    const std::vector<drawing::Section> sections = group_sections(drive);
    REQUIRE(sections.size() == 1);
    return sections.front();
  }

  formats::GraphDocument document;
  Evaluation evaluation;
  std::vector<TruthPose> truth;
};

GroupedResiduals receiver(const std::vector<std::pair<std::string, std::string>>& satellites) {
  GroupedResiduals groups{.source = "receiver",
                          .one = "satellite",
                          .many = "satellites",
                          .signal_name = "C/N0",
                          .signal_unit = "dB-Hz",
                          .quantities = {{"pseudorange", "m"}},
                          .groups = {},
                          .measurements = {}};
  for (const auto& [name, family] : satellites)
    groups.groups.push_back(
        {.name = name, .family = family, .quantities = std::vector<QuantityResiduals>(1)});
  return groups;
}

GroupedMeasurement measured(double t, std::size_t group, double residual, double weight, double bearing_deg,
                            double elevation_deg) {
  return {.stamp = Stamp::from_seconds(1000 + t),
          .quantity = 0,
          .group = group,
          .residual = residual,
          .weight = weight,
          .signal = 40 + static_cast<double>(group),
          .bearing_rad = bearing_deg * kDegree,
          .elevation_rad = elevation_deg * kDegree};
}

std::map<std::string, drawing::Figure> figures_by_id(const drawing::Section& section) {
  drawing::Page page;
  page.sections = {section};
  std::map<std::string, drawing::Figure> figures;
  for (const drawing::Figure* figure : drawing::figures_of(page)) figures[figure->id] = *figure;
  return figures;
}

}  // namespace

TEST_CASE("group sections: each system has its figures, and a line pauses where its satellite does") {
  GroupedResiduals groups = receiver({{"G02", "GPS"}, {"G05", "GPS"}, {"R01", "GLONASS"}});
  for (const double t : {0.0, 1.0, 2.0, 60.0, 61.0})
    groups.measurements.push_back(measured(t, 0, t, 1, 0, 30));
  groups.measurements.push_back(measured(5, 1, -3, 0.3, 90, 45));
  groups.measurements.push_back(measured(7, 2, 9, 0.1, 180, 60));
  const auto figures = figures_by_id(Drive(100).section(groups));
  REQUIRE(figures.contains("pseudorange-gps"));
  REQUIRE(figures.contains("pseudorange-glonass"));
  REQUIRE(figures.contains("c-n0-gps"));
  const drawing::Figure& gps = figures.at("pseudorange-gps");
  REQUIRE(gps.series.size() == 2);
  CHECK(gps.series[0].name == "G02");
  REQUIRE(gps.series[0].x.size() == 6);  // five, and the pause
  CHECK(gps.series[0].y[2] == 2);
  CHECK(std::isnan(gps.series[0].y[3]));
  CHECK(gps.series[0].y[4] == 60);
  CHECK(gps.y.unit == "m");
  CHECK(figures.at("c-n0-gps").series[1].y == std::vector<double>{41});
}

TEST_CASE("group sections: the sky has north at the top, the zenith in the middle, and classes of weight") {
  GroupedResiduals groups = receiver({{"G02", "GPS"}, {"G05", "GPS"}, {"R01", "GLONASS"}});
  groups.measurements = {measured(0, 0, 0, 1, 0, 30), measured(5, 1, -3, 0.3, 90, 45),
                         measured(7, 2, 9, 0.1, 180, 90), measured(8, 2, 9, 0.1, 270, -1)};
  const auto figures = figures_by_id(Drive(100).section(groups));
  const drawing::Figure& sky = figures.at("sky-pseudorange");
  REQUIRE(sky.series.size() == 4);  // the rings, and three classes
  CHECK(sky.series[1].x[0] == Approx(0).margin(1e-9));
  CHECK(sky.series[1].y[0] == Approx(60));
  CHECK(sky.series[2].x[0] == Approx(45));
  CHECK(sky.series[2].y[0] == Approx(0).margin(1e-9));
  CHECK(sky.series[2].notes[0] == "G05, weight 0.30");
  REQUIRE(sky.series[3].x.size() == 1);  // below the horizon there is no sky
  CHECK(std::hypot(sky.series[3].x[0], sky.series[3].y[0]) == Approx(0).margin(1e-9));
}

TEST_CASE("group sections: of a long log few points are drawn, the largest residuals among them") {
  std::vector<std::pair<std::string, std::string>> satellites;
  for (int s = 10; s < 60; ++s) satellites.emplace_back("G" + std::to_string(s), "GPS");
  GroupedResiduals groups = receiver(satellites);
  constexpr int kEpochs = 20'000;
  for (std::size_t s = 0; s < satellites.size(); ++s)
    for (int i = 0; i < kEpochs; ++i)
      groups.measurements.push_back(
          measured(0.2 * i, s, i == 7777 ? 500 : std::sin(i), 0.6, 7.0 * static_cast<double>(s), 40));
  const drawing::Section section = Drive(0.2 * kEpochs).section(groups);
  const auto figures = figures_by_id(section);
  std::size_t points = 0;
  for (const auto& [id, figure] : figures)
    if (id != "sky-pseudorange")
      for (const drawing::Series& series : figure.series) points += series.x.size();
  CHECK(points < kMostGroupPoints + kMostGroupPoints / 10);
  CHECK(points > kMostGroupPoints / 2);
  for (const drawing::Series& series : figures.at("pseudorange-gps").series)
    CHECK(*std::max_element(series.y.begin(), series.y.end()) == 500);
  drawing::Page page;
  page.title = "long";
  page.sections = {section};
  CHECK(drawing::page_html(page).size() < 3'000'000);
}

}  // namespace group_sections_test
