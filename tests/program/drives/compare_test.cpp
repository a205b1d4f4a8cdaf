// `waymark compare`: the page has the numbers of the runs' own files.
#include <filesystem>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/page_checks.hpp"
#include "program/support/program.hpp"

namespace compare_test {

using Json = nlohmann::json;

namespace {

/// A drive with fixes up to 2 m off, run with two modelings.
std::string run_of(const std::string& folder, const std::string& name,
                   std::vector<std::string> options = {}) {
  DriveRecipe recipe;
  recipe.fix_error_m = [](int second) { return 0.5 * ((second * 7) % 9 - 4); };
  const std::string drive = write_drive(folder, recipe);
  std::vector<std::string> arguments = {"run", drive, "-o", folder + name, "-m", "g1,g2", "-q"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  REQUIRE(run(arguments).code == 0);
  return folder + name;
}

void put(const std::string& folder, const std::string& file, const std::string& text) {
  std::filesystem::create_directory(folder);
  write_text(folder + "/" + file, text);
}

double position(const Json& metrics, std::size_t evaluation, const std::string& system,
                const std::string& metric) {
  return metrics.at("evaluations").at(evaluation).at("truth").at(system).at("position").at(metric);
}

}  // namespace

TEST_CASE("compare: the page has the metrics of every run, and raw GNSS once") {
  const std::string folder = fresh_folder();
  const std::string first = run_of(folder, "plain");
  const std::string second = run_of(folder, "gateless", {"--no-gate"});
  const RunResult result = run({"compare", first, second, "-o", folder + "out"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  const std::string html = read_text(folder + "out/comparison.html");
  CHECK(page_flaws(html) == std::vector<std::string>{});

  const std::string caption = "Position errors against truth";
  const std::vector<std::string> columns = table_columns(html, caption);
  REQUIRE(columns.size() > 6);
  const Json plain = Json::parse(read_text(first + "/metrics.json"));
  const Json gateless = Json::parse(read_text(second + "/metrics.json"));
  struct Case {
    const char* row;
    const Json& metrics;
    std::size_t evaluation;
    const char* system;
  };
  for (const Case& c : {Case{"raw GNSS", plain, 0, "gnss"}, Case{"plain g1", plain, 0, "fused"},
                        Case{"plain g2", plain, 1, "fused"}, Case{"gateless g1", gateless, 0, "fused"},
                        Case{"gateless g2", gateless, 1, "fused"}}) {
    const std::vector<std::string> row = table_row(html, caption, c.row);
    INFO(c.row);
    REQUIRE(row.size() == columns.size());
    const std::pair<const char*, const char*> metrics[] = {{"Max [m]", "max_m"},
                                                           {"Acc [m]", "accuracy_m"},
                                                           {"Prec [m]", "precision_m"},
                                                           {"RMSE [m]", "rmse_m"},
                                                           {"CEP95 [m]", "cep95_m"}};
    for (const auto& [column, key] : metrics) {
      const auto place = std::find(columns.begin(), columns.end(), column);
      REQUIRE(place != columns.end());
      const double shown = std::stod(row[static_cast<std::size_t>(place - columns.begin())]);
      CHECK(shown == Approx(position(c.metrics, c.evaluation, c.system, key)).margin(0.0005001));
    }
  }
  CHECK(table_row(html, caption, "raw GNSS (gateless g1)").empty());
}

TEST_CASE("compare: names what is best and what differs") {
  const std::string folder = fresh_folder();
  const std::string plain = run_of(folder, "plain");
  const std::string gateless = run_of(folder, "gateless", {"--no-gate"});
  REQUIRE(run({"compare", plain, gateless, "-o", folder + "out", "-q"}).code == 0);
  const std::string html = read_text(folder + "out/comparison.html");
  const std::vector<std::string> gate = table_row(html, "Settings that differ", "gate");
  REQUIRE(gate.size() == 5);
  CHECK(gate[1] == gate[2]);
  CHECK(gate[3] == "off");
  CHECK(table_row(html, "Settings that differ", "input gnss.csv").empty());  // the same in all
  // Raw fixes scatter more than any fused track does.
  CHECK(table_row(html, "Position errors against truth", "raw GNSS").back().find("Prec") ==
        std::string::npos);
}

TEST_CASE("compare: --json has the schema of run, and its own output can be compared again") {
  const std::string folder = fresh_folder();
  const std::string one = run_of(folder, "one");
  const RunResult result = run({"compare", one, "-o", folder + "out", "--json"});
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  const Json original = Json::parse(read_text(one + "/metrics.json"));
  CHECK(json.at("schema") == "waymark-metrics");
  CHECK(json.at("drive") == original.at("drive"));
  CHECK(json.at("evaluations") == original.at("evaluations"));  // one folder: labels as they were
  CHECK(read_text(folder + "out/metrics.json") == result.out);
  const RunResult again = run({"compare", folder + "out", "-o", folder + "again", "--json"});
  REQUIRE(again.code == 0);
  CHECK(Json::parse(again.out).at("evaluations") == json.at("evaluations"));
}

TEST_CASE("compare: writes figures with their numbers, which are those of the metrics") {
  const std::string folder = fresh_folder();
  const std::string one = run_of(folder, "one");
  REQUIRE(run({"compare", one, "-o", folder + "out", "-q"}).code == 0);
  const Json metrics = Json::parse(read_text(one + "/metrics.json"));
  std::istringstream csv(read_text(folder + "out/figures/comparison-error-rmse.csv"));
  std::string line;
  std::getline(csv, line);
  CHECK(line == "series,RMSE [m],run");
  std::getline(csv, line);
  CHECK(line.rfind("raw GNSS,", 0) == 0);
  CHECK(std::stod(line.substr(9)) == position(metrics, 0, "gnss", "rmse_m"));
  std::getline(csv, line);
  CHECK(line.ends_with(",g1"));
  CHECK(std::stod(line.substr(6)) == position(metrics, 0, "fused", "rmse_m"));
}

TEST_CASE("compare: shows errors epoch by epoch where a run has them") {
  const std::string folder = fresh_folder();
  const std::string one = run_of(folder, "one");
  std::filesystem::remove(one + "/g1.epochs.csv");
  std::filesystem::remove(one + "/g2.epochs.csv");
  REQUIRE(run({"compare", one, "-o", folder + "without", "-q"}).code == 0);
  CHECK_FALSE(contains(read_text(folder + "without/comparison.html"), "id=\"distribution-1\""));

  const std::string heading =
      "stamp_ns,status,reason,gnss_east_m,gnss_north_m,fused_east_m,fused_north_m,nees\n";
  write_text(one + "/g1.epochs.csv", heading +
                                         "1000000000,accepted,,3,4,0.6,0.8,2\n"
                                         "2000000000,rejected,\"angle, too large\",0,2,0,0.5,\n"
                                         "3000000000,accepted,,,,,,\n");
  REQUIRE(run({"compare", one, "-o", folder + "with", "-q"}).code == 0);
  CHECK(page_flaws(read_text(folder + "with/comparison.html")) == std::vector<std::string>{});
  CHECK(contains(read_text(folder + "with/figures/comparison-course-1.csv"),
                 "raw GNSS,0,5,0\nraw GNSS,1,2,1\n"));
  CHECK(contains(read_text(folder + "with/figures/comparison-distribution-1.csv"), "g1,0.5,50\ng1,1,100\n"));
}

TEST_CASE("compare: says that drives are mixed, and takes runs without truth") {
  const std::string folder = fresh_folder();
  const std::string one = run_of(folder, "one");
  DriveRecipe recipe;
  recipe.with_truth = false;
  std::string yaml = read_text(write_drive(folder, recipe));
  yaml.replace(yaml.find("name:"), yaml.find('\n', yaml.find("name:")) - yaml.find("name:"),
               "name: Elsewhere");
  const std::string drive = write_text(folder + "elsewhere.yaml", yaml);
  REQUIRE(run({"run", drive, "-o", folder + "two", "-m", "g1", "-q"}).code == 0);
  const RunResult result = run({"compare", one, folder + "two", "-o", folder + "out"});
  REQUIRE(result.code == 0);
  CHECK(contains(result.err, "note: the runs are of 2 drives"));
  const std::string html = read_text(folder + "out/comparison.html");
  CHECK(page_flaws(html) == std::vector<std::string>{});
  CHECK(contains(html, "Errors are comparable only within one drive"));

  const RunResult blind = run({"compare", folder + "two", "-o", folder + "blind"});
  CHECK(blind.code == 0);
  CHECK(contains(blind.err, "note: no run has a truth or withheld fixes"));
  CHECK(page_flaws(read_text(folder + "blind/comparison.html")) == std::vector<std::string>{});
}

TEST_CASE("compare: refuses what is no run, with place and remedy") {
  const std::string folder = fresh_folder();
  const std::string metrics = R"({"schema": "waymark-metrics", "version": 1, "drive": "", "provenance": {},
 "evaluations": [{"label": "g1", "frame": {"utm_zone": -1)";
  put(folder + "broken", "metrics.json", metrics);
  put(folder + "zone", "metrics.json", metrics + "}}]}");
  put(folder + "other", "metrics.json", R"({"schema": "waymark-inspection"})");
  put(folder + "newer", "metrics.json", R"({"schema": "waymark-metrics", "version": 2})");
  put(folder + "list", "metrics.json", "[]");
  put(folder + "none", "metrics.json",
      R"({"schema": "waymark-metrics", "version": 1, "drive": "", "provenance": {}, "evaluations": []})");
  put(folder + "empty", "readme.txt", "");
  struct Case {
    std::vector<std::string> arguments;
    int code;
    const char* message;
  };
  const std::vector<Case> cases = {
      {{"-o", "out"}, 2, "runs is required"},
      {{"empty"}, 2, "--out is required"},
      {{"empty", "-o", "out"},
       3,
       "empty: has no metrics.json; name a folder that `waymark run DRIVE -o DIR`"},
      {{"nowhere", "-o", "out"}, 3, "nowhere: is no folder; name a folder that "},
      {{"empty/readme.txt", "-o", "out"}, 3, "empty/readme.txt: is no folder; "},
      {{"broken", "-o", "out"}, 3, "broken/metrics.json:2:58: is no JSON: "},
      {{"zone", "-o", "out"},
       3,
       "zone/metrics.json: evaluations[0].frame.utm_zone: expected a whole number, at least 0, got -1"},
      {{"other", "-o", "out"},
       3,
       "other/metrics.json: schema: expected \"waymark-metrics\", got \"waymark-inspection\""},
      {{"newer", "-o", "out"}, 3, "newer/metrics.json: version: expected version 1, got 2"},
      {{"list", "-o", "out"}, 3, "list/metrics.json: expected an object with 'schema', got []"},
      {{"none", "./none/", "-o", "out"}, 2, "./none/: is named twice"},
      {{"none", "-o", "out"}, 3, "none/metrics.json: has no evaluation in it"},
  };
  for (Case c : cases) {
    c.arguments.insert(c.arguments.begin(), "compare");
    check_refused(run(c.arguments, {.folder = folder}), c.code, c.message);
    CHECK_FALSE(exists(folder + "out"));
  }
}

TEST_CASE("compare: refuses a table of epochs that is broken, by line") {
  const std::string folder = fresh_folder();
  const std::string one = run_of(folder, "one");
  const std::string heading = "stamp_ns,gnss_east_m,gnss_north_m,fused_east_m,fused_north_m,nees\n";
  struct Case {
    std::string text;
    const char* message;
  };
  for (const Case& c :
       {Case{"stamp_ns\n1\n", "g1.epochs.csv:1: has no column 'nees'"},
        Case{heading + "1,2\n", "g1.epochs.csv:2: expected 6 fields, as in the heading, got 2"},
        Case{heading + "1,east,3,4,5,6\n",
             "g1.epochs.csv:2: expected a number for 'gnss_east_m', got 'east'"}}) {
    write_text(one + "/g1.epochs.csv", c.text);
    const RunResult result = run({"compare", one, "-o", folder + "out"});
    INFO(result.err);
    CHECK(result.code == 3);
    CHECK(contains(result.err, c.message));
  }
}

}  // namespace compare_test
