// `waymark reproduce`: a real drive, and its refusals.
#include <map>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/page_checks.hpp"
#include "program/support/program.hpp"

namespace reproduce_test {

using Json = nlohmann::json;

TEST_CASE("reproduce: on the bundled drive: one minimum for all, every file, nothing on stderr in a pipe") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"reproduce", bundled_drive(), "-o", folder + "out", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  CHECK(read_text(folder + "out/reproduction.json") == result.out);
  CHECK(names_in(folder + "out") ==
        std::vector<std::string>{"REPRODUCTION.md", "convergence_literal.csv", "convergence_ours.csv",
                                 "drives_overview.csv", "drives_truth.csv", "figures", "reproduction.html",
                                 "reproduction.json", "runs.csv"});

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
  CHECK(contains(report, "| waymark |"));

  const std::string html = read_text(folder + "out/reproduction.html");
  CHECK(page_flaws(html) == std::vector<std::string>{});
  CHECK(contains(html, "does\u00a0not\u00a0hold"));
  std::ostringstream raw;
  raw << "raw GNSS," << drive.at("gnss").at("max_m").dump() << ",";
  CHECK(contains(read_text(folder + "out/figures/reproduction-error-max.csv"), raw.str()));
}

TEST_CASE("reproduce: keeps fixes out of a drive without truth, and runs the same twice") {
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

TEST_CASE("reproduce: the default model of reproduce is what run does") {
  const std::string folder = fresh_folder();
  const RunResult study = run({"reproduce", bundled_drive(), "-o", folder + "a", "--ablation", "--json"});
  INFO(study.err);
  REQUIRE(study.code == 0);
  const RunResult plain = run({"run", bundled_drive(), "-o", folder + "b", "--json"});
  REQUIRE(plain.code == 0);
  const Json runs = Json::parse(study.out).at("drives").at(0).at("runs");
  CHECK(runs.at(0).at("setting") == "waymark");
  CHECK(runs.at(0).at("noise").contains("multipath_sigma"));
  const Json metrics = Json::parse(read_text(folder + "b/metrics.json"));
  const std::string rmse = runs.at(0).at("fused").at("rmse_m").dump();
  CHECK(contains(metrics.dump(), "\"rmse_m\":" + rmse));
  CHECK(names_in(folder + "a") == std::vector<std::string>{"ABLATION.md", "ablation.html", "ablation.json",
                                                           "ablation_coverage.csv", "ablation_error.csv",
                                                           "ablation_max.csv", "ablation_nees.csv", "figures",
                                                           "runs.csv"});
  CHECK(page_flaws(read_text(folder + "a/ablation.html")) == std::vector<std::string>{});
  CHECK(contains(read_text(folder + "a/figures/ablation-ablation-error.csv"), ",default,1,1\n"));
}

TEST_CASE("reproduce: the ablation's remedies for outliers find wild fixes, and squared errors do not") {
  const std::string folder = fresh_folder();
  DriveRecipe recipe;
  recipe.seconds = 300;
  int wild = 0;
  for (int second = 0; second < recipe.seconds; ++second) wild += second % 20 == 7;
  recipe.fix_error_m = [](int second) { return second % 20 == 7 ? 60.0 : 0.3 * (second % 3 - 1); };
  const RunResult result =
      run({"reproduce", write_drive(folder, recipe), "-o", folder + "out", "--ablation", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json.at("schema") == "waymark-ablation");
  std::map<std::string, Json> of;
  for (const Json& setting : json.at("drives").at(0).at("runs")) {
    INFO(setting.dump());
    CHECK_FALSE(setting.contains("failure"));
    of[setting.at("setting")] = setting;
  }
  const auto rmse = [&](const std::string& name) {
    return of.at(name).at("fused").at("rmse_m").get<double>();
  };
  CHECK(of.at("white/gnc").at("rejected") == wild);
  CHECK(of.at("white/squared").at("rejected") == 0);
  for (const char* name : {"white/gnc", "white/cauchy", "white/geman_mcclure", "white/tukey", "waymark"}) {
    INFO(name);
    CHECK(rmse(name) < rmse("white/squared"));
  }
  // The mean of 60 m over one fix in twenty is 3 m; a loss or a verdict leaves next to nothing of it.
  CHECK(rmse("white/squared") > 1);
  CHECK(rmse("white/gnc") < 0.5);
}

TEST_CASE("reproduce: --consistency: white noise is many times too sure, drives and seeds are stated") {
  const std::string folder = fresh_folder();
  const RunResult result = run({"reproduce", "--consistency", "4", "-o", folder + "out", "--json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json.at("schema") == "waymark-consistency");
  REQUIRE(json.at("drives").size() == 4);
  double white = 0;
  double standard = 0;
  for (const Json& drive : json.at("drives")) {
    CHECK(drive.at("simulated") == true);
    standard += drive.at("runs").at(0).at("consistency").at("nees_mean").get<double>();
    white += drive.at("runs").at(1).at("consistency").at("nees_mean").get<double>();
  }
  CHECK(white > 10 * standard);
  CHECK(json.at("drives").at(3).at("group") == "mixed");
  CHECK(contains(read_text(folder + "out/CONSISTENCY.md"), "SIMULATED drives: seeds 1000 to 1003"));
  CHECK(contains(read_text(folder + "out/consistency.csv"), "together,default,4,4,"));
  CHECK(page_flaws(read_text(folder + "out/consistency.html")) == std::vector<std::string>{});
  const Json& first = json.at("drives").at(0).at("runs").at(0).at("consistency").at("nees_mean");
  CHECK(contains(read_text(folder + "out/figures/consistency-nees-default.csv"),
                 "drives,1," + first.dump() + ","));
}

TEST_CASE("reproduce: refuses what it cannot do before any work") {
  const std::string folder = fresh_folder();
  const std::string out = folder + "out";
  const RunResult number = run({"reproduce", "-o", out, "--drives", "1,9"});
  CHECK(number.code == 2);
  CHECK(contains(number.err, "the paper's drives are 1 to 8, got 9"));
  const RunResult both = run({"reproduce", bundled_drive(), "-o", out, "--seed", "3"});
  CHECK(both.code == 2);
  CHECK(contains(both.err, "--drives and --seed are for the simulated drives"));
  CHECK(run({"reproduce", bundled_drive(), folder + "missing.yaml", "-o", out}).code == 3);
  const RunResult drawn = run({"reproduce", bundled_drive(), "-o", out, "--consistency", "4"});
  CHECK(drawn.code == 2);
  CHECK(contains(drawn.err, "--consistency simulates its own drives"));
  CHECK(run({"reproduce", "-o", out, "--consistency", "0"}).code == 2);
  CHECK(run({"reproduce", "-o", out, "--consistency", "4", "--ablation"}).code == 2);
  CHECK_FALSE(exists(out));
  CHECK(run({"reproduce", bundled_drive(), "-o", bundled_drive() + "/x"}).code == 5);
}

}  // namespace reproduce_test
