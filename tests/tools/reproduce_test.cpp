// `waymark reproduce`: on a real drive, and what it refuses.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tools/material.hpp"
#include "tools/program.hpp"

using Json = nlohmann::json;

TEST_CASE("reproduce on the bundled drive: one minimum for all, every file, nothing on stderr in a pipe") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"reproduce", bundled_drive(), "-o", folder + "out", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  CHECK(read_text(folder + "out/reproduction.json") == result.out);
  CHECK(names_in(folder + "out") ==
        std::vector<std::string>{"REPRODUCTION.md", "convergence_literal.csv", "convergence_ours.csv",
                                 "drives_overview.csv", "drives_truth.csv", "reproduction.json", "runs.csv"});

  const Json json = Json::parse(result.out);
  CHECK(json.at("schema") == "waymark-reproduction");
  const Json& drive = json.at("drives").at(0);
  CHECK(drive.at("simulated") == false);
  CHECK(drive.at("dataset").is_null());
  int ours = 0;
  for (const Json& setting : drive.at("runs")) {
    INFO(setting.dump());
    CHECK_FALSE(setting.contains("failure"));
    const std::string name = setting.at("setting");
    if (!name.starts_with("ours_") || name == "ours_g2_no_rejection") continue;
    ++ours;  // all modelings, algorithms and starts
    CHECK(setting.at("converged") == true);
    CHECK(setting.at("from_minimum_m") < 0.01);
  }
  CHECK(ours > 20);
  CHECK(drive.at("gnss").at("max_m") > 15);  // the study gives 19.3 m for the raw fixes

  const std::string report = read_text(folder + "out/REPRODUCTION.md");
  CHECK(contains(report, "Berlin, Potsdamer Platz"));
  CHECK(contains(report, "| ours_g2 |"));
}

TEST_CASE("reproduce keeps fixes out of a drive without truth, and runs the same twice") {
  const std::string folder = fresh_folder();
  DriveRecipe recipe;
  recipe.seconds = 300;
  recipe.with_truth = false;
  recipe.fix_error_m = [](int second) { return 0.3 * (second % 3 - 1); };
  const std::string drive = write_drive(folder, recipe);
  const RunResult first = run({"reproduce", drive, "-o", folder + "a"});
  INFO(first.err);
  REQUIRE(first.code == 0);
  CHECK(contains(first.out, "outages of 60 s"));
  CHECK(contains(first.out, "dead reckoning"));
  REQUIRE(run({"reproduce", drive, "-o", folder + "b"}).code == 0);
  CHECK(read_text(folder + "a/reproduction.json") == read_text(folder + "b/reproduction.json"));
}

TEST_CASE("reproduce refuses what it cannot do before any work") {
  const std::string folder = fresh_folder();
  const std::string out = folder + "out";
  const RunResult number = run({"reproduce", "-o", out, "--drives", "1,9"});
  CHECK(number.code == 2);
  CHECK(contains(number.err, "the paper's drives are 1 to 8, got 9"));
  const RunResult both = run({"reproduce", bundled_drive(), "-o", out, "--seed", "3"});
  CHECK(both.code == 2);
  CHECK(contains(both.err, "--drives and --seed are for the simulated drives"));
  CHECK(run({"reproduce", bundled_drive(), folder + "missing.yaml", "-o", out}).code == 3);
  CHECK_FALSE(exists(out));
  CHECK(run({"reproduce", bundled_drive(), "-o", bundled_drive() + "/x"}).code == 5);
}
