// `sources:` of a drive.yaml, the short forms beside it, and what is stated for single sources.
#include <catch2/catch.hpp>

#include <string>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>

#include "support/registry.hpp"

namespace sources_yaml_test {

using namespace waymark;
using namespace waymark::drive;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;
using Catch::Matchers::StartsWith;
using waymark_test::registry;

namespace {

DriveFile parse(const std::string& text) {
  return parse_drive_file(text, "tours/drive.yaml", "");
}

/// The error that lines added to a minimal drive give.
std::string error_of(const std::string& more) {
  try {
    (void)parse("odometry: {file: o.csv}\ngnss: {file: g.csv}\n" + more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The error of a drive that is stated as a whole.
std::string error_of_whole(const std::string& text) {
  try {
    (void)parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("sources yaml: sources are odometries, receivers and sensors, each with its name") {
  const DriveDescription drive = parse(R"(
sources:
  wheels: {kind: odometry, file: w.csv}
  visual: {kind: odometry, file: v.csv, nodes: true}
  front: {kind: gnss, file: f.csv}
  compass: {kind: heading, file: c.csv, options: {sigma_deg: 2}}
)")
                                     .description;
  REQUIRE(drive.odometry.size() == 2);
  CHECK(drive.odometry[0].name == "wheels");
  CHECK_FALSE(drive.odometry[0].gives_nodes);
  CHECK(drive.odometry[1].name == "visual");
  CHECK(drive.odometry[1].gives_nodes);
  REQUIRE(drive.gnss.size() == 1);
  CHECK(drive.gnss[0].name == "front");
  CHECK(drive.gnss[0].file == "tours/f.csv");
  REQUIRE(drive.sensors.size() == 1);
  CHECK(drive.sensors[0].name == "heading");
  CHECK(drive.sensors[0].source == "compass");
  CHECK(drive.sensors[0].options.at("sigma_deg") == "2");
}

TEST_CASE("sources yaml: short forms come before sources, and number themselves unless they have a name") {
  const DriveDescription drive = parse(R"(
gnss: [{file: a.csv}, {file: b.csv}, {file: c.csv, name: roof}]
odometry: {file: o.csv}
sensors: [{name: heading, file: h.csv}, {name: heading, file: i.csv}]
sources: {rear: {kind: gnss, file: r.csv}}
)")
                                     .description;
  CHECK(drive.odometry.front().name == "odometry");
  REQUIRE(drive.gnss.size() == 4);
  const std::vector<std::string> names = {"gnss", "gnss_2", "roof", "rear"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK(drive.gnss[i].name == names[i]);
    CHECK(drive.gnss[i].request.source == static_cast<int>(i));
  }
  REQUIRE(drive.sensors.size() == 2);
  CHECK(drive.sensors[0].source == "heading");
  CHECK(drive.sensors[1].source == "heading_2");
}

TEST_CASE("sources yaml: every receiver has its own antenna, delay, period and withheld fixes") {
  const DriveDescription drive = parse(R"(
odometry: {file: o.csv}
sources:
  front: {kind: gnss, file: f.csv, antenna: [2.6, 0.1], delay: 0.2, period: 0.5, withhold_every: 10}
  rear: {kind: gnss, file: r.csv, withheld: true}
)")
                                     .description;
  const GnssConfig& front = drive.gnss.at(0);
  CHECK(front.antenna_m == Eigen::Vector2d(2.6, 0.1));
  CHECK(front.delay_s == 0.2);
  CHECK(front.period_s == 0.5);
  CHECK(front.withhold_every == 10);
  CHECK_FALSE(front.withheld);
  const GnssConfig& rear = drive.gnss.at(1);
  CHECK(rear.antenna_m == Eigen::Vector2d(0, 0));
  CHECK(rear.delay_s == 0);
  CHECK(rear.period_s == 0);
  CHECK(rear.withhold_every == 0);
  CHECK(rear.withheld);
}

TEST_CASE("sources yaml: what is stated for a source is among the settings of that source") {
  const DriveFile file = parse(R"(
modeling: g3
gate: {max_angle_deg: 3}
sources:
  wheels: {kind: odometry, file: w.csv}
  visual:
    kind: odometry
    file: v.csv
    model: constant_twist
    options: {heading_variance_per_s: 1e-7}
    calibration: {gyro_bias: constant}
  front:
    kind: gnss
    file: f.csv
    modeling: {name: g2, loss: "cauchy:1", options: {weight: 1e6}}
    calibration: {time_offset: constant}
    gate: {max_displacement_m: 20}
  rear: {kind: gnss, file: r.csv, common: front}
  roof: {kind: gnss, file: t.csv, modeling: g1}
)");
  const auto& sources = file.settings.sources;
  CHECK_FALSE(sources.contains("wheels"));
  const SourceSettings& visual = sources.at("visual");
  CHECK(visual.model == "constant_twist");
  CHECK(visual.options == Options{{"heading_variance_per_s", "1e-7"}});
  CHECK(visual.calibration == Options{{"gyro_bias", "constant"}});
  const SourceSettings& front = sources.at("front");
  CHECK(front.model == "g2");
  CHECK(front.loss == "cauchy:1");
  CHECK(front.options == Options{{"weight", "1e6"}});
  CHECK(front.calibration == Options{{"time_offset", "constant"}});
  CHECK(front.gate->enabled == true);
  CHECK(front.gate->max_displacement_m == 20);
  CHECK(front.gate->max_angle_rad == Approx(3 * kDegree));  // the rest is as for the drive
  CHECK(sources.at("rear").common == "front");
  CHECK(sources.at("roof").model == "g1");
  CHECK(file.settings.modeling == "g3");
  CHECK(file.settings.odometry_options.empty());
  CHECK(file.settings.gate.max_displacement_m == GateOptions().max_displacement_m);
}

TEST_CASE("sources yaml: what one of several odometries states is not stated for the others") {
  for (const char* text :
       {"odometry: [{file: a.csv, options: {heading_variance_per_s: 1e-7}}, {file: b.csv}]\n",
        "sources:\n"
        "  odometry: {kind: odometry, file: a.csv, options: {heading_variance_per_s: 1e-7}}\n"
        "  odometry_2: {kind: odometry, file: b.csv}\n"}) {
    const DriveFile file = parse(std::string(text) + "gnss: {file: g.csv}\n");
    INFO(text);
    CHECK(for_relative(file.settings, "odometry").odometry_options ==
          Options{{"heading_variance_per_s", "1e-7"}});
    CHECK(for_relative(file.settings, "odometry_2").odometry_options.empty());
  }
}

TEST_CASE("sources yaml: a receiver that is named odometry leaves the odometry model alone") {
  const DriveFile file = parse(
      "sources:\n  wheels: {kind: odometry, file: w.csv}\n"
      "  odometry: {kind: gnss, file: g.csv, modeling: g1}\n");
  CHECK(file.settings.odometry_model == FusionSettings().odometry_model);
  CHECK(for_absolute(file.settings, "odometry", registry()).modeling == "g1");
}

TEST_CASE("sources yaml: errors of sources have their place") {
  CHECK_THAT(error_of("sources:\n  front: {file: f.csv}\n"),
             StartsWith("tours/drive.yaml:4:10: sources.front: 'kind' is missing"));
  CHECK(error_of("sources:\n  front: {kind: gnss, file: f.csv, antena: [1, 0]}\n") ==
        "tours/drive.yaml:4:36: unknown key 'antena' in sources.front; did you mean 'antenna'?");
  CHECK_THAT(error_of("sources:\n  wheels: {kind: odometry, file: w.csv, antenna: [1, 0]}\n"),
             StartsWith("tours/drive.yaml:4:41: unknown key 'antenna' in sources.wheels"));
  CHECK(error_of("sources:\n  my front: {kind: gnss, file: f.csv}\n") ==
        "tours/drive.yaml:4:13: the name of a source has letters, digits, '_' and '-', got 'my front'");
  CHECK(error_of("sources:\n  gnss: {kind: gnss, file: f.csv}\n") ==
        "tours/drive.yaml:4:9: there is a source 'gnss' already (tours/drive.yaml:2:7); give them different "
        "names");
  CHECK_THAT(error_of("sources:\n  front: {kind: gnss, file: f.csv, name: other}\n"),
             StartsWith("tours/drive.yaml:4:36: unknown key 'name' in sources.front; known: file, "));
  CHECK(
      error_of("sources:\n  front: {kind: gnss, file: f.csv, withhold_every: 1}\n") ==
      "tours/drive.yaml:4:52: sources.front.withhold_every: expected 0 (none) or a whole number from 2, got "
      "'1'");
  CHECK_THAT(error_of("sources:\n  front: {kind: gnss, file: f.csv}\n  front: {kind: gnss, file: f.csv}\n"),
             StartsWith("tours/drive.yaml:5:"));
  CHECK_THAT(error_of_whole("odometry: {file: o.csv}\ngnss: {file: g.csv, kind: gnss}\n"),
             StartsWith("tours/drive.yaml:2:21: unknown key 'kind' in gnss; known: file, "));
  CHECK(error_of_whole("sources: {front: {kind: gnss, file: f.csv}}\n") ==
        "tours/drive.yaml:1:1: 'odometry' is missing");
  CHECK_THAT(error_of_whole("odometry: [{file: a.csv, nodes: true}, {file: b.csv, nodes: true}]\n"
                            "gnss: {file: g.csv}\n"),
             StartsWith("tours/drive.yaml:1:") && Contains("nodes come from one"));
}

TEST_CASE("sources yaml: a further sensor is no receiver and no odometry") {
  CHECK_THAT(error_of("sensors: {name: gnss, file: f.csv}\n"), StartsWith("tours/drive.yaml:3:"));
  CHECK_THAT(error_of("sensors: {name: odometry, file: f.csv}\n"), StartsWith("tours/drive.yaml:3:"));
}

TEST_CASE("settings of sources: own options of a receiver go before those of the drive") {
  FusionSettings settings;
  settings.calibration = Options{{"time_offset", "constant"}};
  settings.modeling_options = {{"white_sigma", "2"}, {"multipath_sigma", "4"}};
  settings.loss = "cauchy:1";
  settings.sources["front"].options = {{"white_sigma", "0.5"}};
  settings.sources["rear"].calibration = {{"time_offset", "off"}};
  settings.sources["rear"].loss = "huber:2";
  const FusionSettings front = for_absolute(settings, "front", registry());
  CHECK(front.modeling_options ==
        Options{{"white_sigma", "0.5"}, {"multipath_sigma", "4"}, {"time_offset", "constant"}});
  CHECK(front.loss == "cauchy:1");
  const FusionSettings rear = for_absolute(settings, "rear", registry());
  CHECK(rear.modeling_options ==
        Options{{"white_sigma", "2"}, {"multipath_sigma", "4"}, {"time_offset", "off"}});
  CHECK(rear.loss == "huber:2");
  const FusionSettings other = for_absolute(settings, "other", registry());
  CHECK(other.modeling_options ==
        Options{{"white_sigma", "2"}, {"multipath_sigma", "4"}, {"time_offset", "constant"}});
}

TEST_CASE("settings of sources: options of another modeling or model do not leak") {
  FusionSettings settings;
  settings.modeling_options = {{"white_sigma", "2"}};
  settings.odometry_options = {{"heading_variance_per_s", "1e-7"}};
  settings.sources["front"] = {.model = "g2", .options = {{"weight", "1e6"}}};
  settings.sources["visual"] = {.model = "another", .options = {{"scale", "3"}}};
  settings.sources["wheels"] = {.model = settings.odometry_model,
                                .options = {{"heading_variance_per_m", "1e-9"}}};
  const FusionSettings front = for_absolute(settings, "front", registry());
  CHECK(front.modeling == "g2");
  CHECK(front.modeling_options == Options{{"weight", "1e6"}});
  const FusionSettings visual = for_relative(settings, "visual");
  CHECK(visual.odometry_model == "another");
  CHECK(visual.odometry_options == Options{{"scale", "3"}});
  CHECK(for_relative(settings, "wheels").odometry_options ==
        Options{{"heading_variance_per_s", "1e-7"}, {"heading_variance_per_m", "1e-9"}});
}

TEST_CASE("settings of sources: a receiver with a complete modeling has no gate beside one without") {
  FusionSettings settings;
  settings.modeling = "g1";
  settings.sources["front"].model = "correlated";
  settings.sources["rear"].gate = GateOptions{.enabled = false};
  const FusionSettings decision = decided(settings, registry());
  CHECK(for_absolute(decision, "front", registry()).gate.enabled == false);
  CHECK(for_absolute(decision, "rear", registry()).gate.enabled == false);
  CHECK(for_absolute(decision, "other", registry()).gate.enabled == true);
}

TEST_CASE("settings of sources: members of a group have the settings of its first, and a ring is refused") {
  FusionSettings settings;
  settings.sources["front"].common = "rear";
  settings.sources["roof"].common = "front";
  settings.sources["rear"].options = {{"white_sigma", "0.5"}};
  CHECK(group_of(settings, "rear") == "rear");
  CHECK(group_of(settings, "front") == "rear");
  CHECK(group_of(settings, "roof") == "rear");
  CHECK(group_of(settings, "other") == "other");
  CHECK(for_absolute(settings, "roof", registry()).modeling_options.at("white_sigma") == "0.5");
  settings.sources["rear"].common = "roof";
  CHECK_THROWS_MATCHES(group_of(settings, "front"), UsageError,
                       Message("sources: the groups of 'front' name each other in a ring (common)"));
}

}  // namespace sources_yaml_test
