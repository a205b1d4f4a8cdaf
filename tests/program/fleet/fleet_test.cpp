// `waymark fleet`: many drives as a user runs them: failures, resumption, Ctrl-C, the merged table, shares of a cluster.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <sqlite3.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <waymark/core/base/detail/address_sanitizer.hpp>

#include "program/support/help.hpp"
#include "program/support/material.hpp"
#include "program/support/page_checks.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace fleet_test {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Writes drives called a, b, c, ... whose fixes differ. Returns their folder.
std::string write_drives(const std::string& folder, int count) {
  for (int i = 0; i < count; ++i) {
    const std::string name = folder + "drives/" + std::string(1, static_cast<char>('a' + i)) + "/";
    fs::create_directories(name);
    DriveRecipe recipe;
    recipe.fix_error_m = [i](int second) { return 0.3 * (i + 1) * ((second * 7) % 9 - 4); };
    recipe.more_yaml = i % 2 == 0 ? "environment: rural\n" : "environment: urban\n";
    (void)write_drive(name, recipe);
  }
  return folder + "drives";
}

/// The cells of a CSV by row and column. Quotes keep commas together.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& file) {
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') {
        quoted = !quoted;
      } else if (c == ',' && !quoted) {
        all.emplace_back();
      } else {
        all.back() += c;
      }
    }
    return all;
  };
  const std::vector<std::string> lines = lines_of(read_text(file));
  REQUIRE(!lines.empty());
  const std::vector<std::string> columns = cells(lines.front());
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> row = cells(lines[i]);
    REQUIRE(row.size() == columns.size());
    rows.emplace_back();
    for (std::size_t c = 0; c < columns.size(); ++c) rows.back()[columns[c]] = row[c];
  }
  return rows;
}

/// The answer of SQLite itself, cells and rows joined by ',' and ';'.
std::string query(const std::string& file, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK);
  std::string answer;
  const auto add = [](void* text, int count, char** cells, char**) {
    for (int i = 0; i < count; ++i)
      *static_cast<std::string*>(text) +=
          std::string(cells[i] != nullptr ? cells[i] : "NULL") + (i + 1 < count ? "," : ";");
    return 0;
  };
  char* error = nullptr;
  sqlite3_exec(database, sql.c_str(), add, &answer, &error);
  INFO((error != nullptr ? error : ""));
  CHECK(error == nullptr);
  sqlite3_free(error);
  sqlite3_close(database);
  return answer;
}

/// The files that must have the same bytes wherever, and however often, drives were run.
std::map<std::string, std::string> merged(const std::string& folder) {
  std::map<std::string, std::string> bytes;
  for (const char* name : {"fleet.csv", "fleet.sqlite", "fleet.html"})
    bytes[name] = read_text(folder + "/" + name);
  return bytes;
}

/// Processes whose command line holds a text.
int processes_with(const std::string& text) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::string words = read_text(entry.path().string() + "/cmdline");
    std::replace(words.begin(), words.end(), '\0', ' ');
    if (words.find(" run ") != std::string::npos && words.find(text) != std::string::npos) ++count;
  }
  return count;
}

RunResult bash(const std::string& script, const std::string& folder) {
  return run({"-c", script, waymark_test::program_path()}, {.folder = folder, .program = "/bin/bash"});
}

}  // namespace

TEST_CASE("fleet: the merged table has the numbers that run writes, as CSV and in SQLite") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 3);
  const RunResult result = run({"fleet", drives, "-o", folder + "out", "-m", "g1,g2", "--label", "trial"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  REQUIRE(run({"run", drives + "/b/drive.yaml", "-o", folder + "alone", "-m", "g1,g2", "-q"}).code == 0);
  const Json alone = Json::parse(read_text(folder + "alone/metrics.json"));
  const auto rows = rows_of(folder + "out/fleet.csv");
  REQUIRE(rows.size() == 6);
  const auto& row = rows[3];
  CHECK(row.at("drive") == "b");
  CHECK(row.at("modeling") == "g2");
  CHECK(row.at("state") == "done");
  CHECK(row.at("environment") == "urban");
  CHECK(row.at("label") == "trial");
  const Json& truth = alone.at("evaluations").at(1).at("truth");
  CHECK(std::stod(row.at("rmse_m")) == truth.at("fused").at("position").at("rmse_m").get<double>());
  CHECK(std::stod(row.at("gnss_rmse_m")) == truth.at("gnss").at("position").at("rmse_m").get<double>());
  CHECK(std::stod(row.at("nees_mean")) == truth.at("consistency").at("nees_mean").get<double>());
  CHECK(std::stod(row.at("fixes")) == alone.at("evaluations").at(1).at("fixes").at("total").get<double>());

  const std::string database = folder + "out/fleet.sqlite";
  CHECK(query(database, "PRAGMA integrity_check") == "ok;");
  CHECK(query(database, "SELECT drive, modeling FROM drives ORDER BY drive, modeling") ==
        "a,g1;a,g2;b,g1;b,g2;c,g1;c,g2;");
  CHECK(query(database, "SELECT count(*) FROM drives WHERE environment = 'rural'") == "4;");
  const std::string stored =
      query(database, "SELECT printf('%.17g', rmse_m) FROM drives WHERE drive = 'b' AND modeling = 'g2'");
  CHECK(std::stod(stored) == Approx(std::stod(row.at("rmse_m"))).epsilon(1e-14));  // it prints 16 digits
  CHECK(query(database, "SELECT value FROM fleet WHERE key = 'options'") == "--modeling=g1 --modeling=g2;");

  const std::string page = read_text(folder + "out/fleet.html");
  CHECK(page_flaws(page) == std::vector<std::string>{});
  const std::vector<std::string> worst = table_row(page, "The drives with the largest errors", "c");
  REQUIRE(worst.size() > 3);
  CHECK(std::stod(worst[3]) == Approx(std::stod(rows[4].at("rmse_m"))).margin(0.0005001));
  CHECK(exists(folder + "out/drives/c/g1.html"));
  CHECK(contains(page, "href=\"drives/c/g1.html\""));
}

TEST_CASE("fleet: a drive that fails is reported with its reason, and the rest goes on") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 3);
  fs::rename(drives + "/b/gnss.csv", folder + "gnss.csv");
  const std::vector<std::string> command = {"fleet", drives, "-o", folder + "out", "-m", "g1"};
  const RunResult result = run(command);
  CHECK(result.code == 3);
  CHECK(contains(result.err, "warning: drive b failed: " + drives + "/b/drive.yaml:"));
  const auto rows = rows_of(folder + "out/fleet.csv");
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].at("state") == "done");
  CHECK(rows[1].at("state") == "failed");
  CHECK(contains(rows[1].at("reason"), "gnss.csv: cannot read"));
  CHECK(rows[1].at("rmse_m").empty());
  CHECK(rows[2].at("state") == "done");
  CHECK(table_row(read_text(folder + "out/fleet.html"), "Reasons", "b").size() == 4);

  // It stays failed until it is asked for, and only it is run again.
  fs::rename(folder + "gnss.csv", drives + "/b/gnss.csv");
  CHECK(run(command).code == 3);
  const auto before = fs::last_write_time(folder + "out/records/a.json");
  std::vector<std::string> again = command;
  again.emplace_back("--retry-failed");
  CHECK(run(again).code == 0);
  CHECK(rows_of(folder + "out/fleet.csv")[1].at("state") == "done");
  CHECK(fs::last_write_time(folder + "out/records/a.json") == before);
}

TEST_CASE(
    "fleet: a drive that hangs is killed at the time limit, the rest goes on, and it can be run again") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 3);
  fs::rename(drives + "/b/gnss.csv", folder + "gnss.csv");
  REQUIRE(::mkfifo((drives + "/b/gnss.csv").c_str(), 0600) == 0);  // nobody ever writes to it
  const std::vector<std::string> command = {"fleet", drives, "-o", folder + "out", "-m", "g1"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.begin(), command.begin(), command.end());
    return run(words);
  };
  const RunResult result = with({"--time-limit", "10s"});
  const std::string reason = "killed, because it reached its time limit of 10 s (--time-limit)";
  CHECK(result.code == 3);
  CHECK(contains(result.err, "warning: drive b failed: " + reason));
  const auto rows = rows_of(folder + "out/fleet.csv");
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].at("state") == "done");
  CHECK(rows[1].at("state") == "failed");
  CHECK(rows[1].at("reason") == reason);
  CHECK(rows[2].at("state") == "done");
  CHECK(processes_with(folder) == 0);

  fs::remove(drives + "/b/gnss.csv");
  fs::rename(folder + "gnss.csv", drives + "/b/gnss.csv");
  CHECK(with({"--time-limit", "1h", "--retry-failed"}).code == 0);
  CHECK(rows_of(folder + "out/fleet.csv")[1].at("state") == "done");
  for (const char* wrong : {"0", "-5", "1d", "soon"}) {
    INFO(wrong);
    CHECK(with({"--time-limit", wrong}).code == 2);
  }
}

TEST_CASE("fleet: a drive without a minimum keeps its numbers and says so") {
  const std::string folder = fresh_folder();
  const RunResult result =
      run({"fleet", write_drives(folder, 1), "-o", folder + "out", "-m", "g1", "--max-iterations", "0"});
  CHECK(result.code == 4);
  const auto rows = rows_of(folder + "out/fleet.csv");
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].at("state") == "not converged");
  CHECK(contains(rows[0].at("reason"), "g1: "));
  CHECK(!rows[0].at("rmse_m").empty());
}

TEST_CASE("fleet: killed in the middle and resumed, the merged table has the same bytes") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 6);
  REQUIRE(run({"fleet", drives, "-o", folder + "whole", "-j", "2"}).code == 0);
  const RunResult killed = bash(
      "\"$0\" fleet drives -o out -j 2 2>/dev/null & fleet=$!\n"
      "until [ $(ls out/records 2>/dev/null | wc -l) -ge 2 ]; do sleep 0.02; done\n"
      "kill -9 $fleet; wait $fleet; echo $?; ls out/records | wc -l",
      folder);
  const std::vector<std::string> lines = lines_of(killed.out);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] == "137");
  CHECK(std::stoi(lines[1]) < 6);  // it was in the middle
  CHECK_FALSE(exists(folder + "out/fleet.csv"));
  for (int i = 0; i < 100 && processes_with(folder + "out") > 0; ++i)
    (void)run({"-c", "sleep 0.02"}, {.program = "/bin/bash"});
  CHECK(processes_with(folder + "out") == 0);  // its children died with it
  const auto before = fs::last_write_time(folder + "out/records/a.json");

  const RunResult resumed = run({"fleet", drives, "-o", folder + "out", "-j", "2"});
  CHECK(resumed.code == 0);
  CHECK(contains(resumed.err, " drives had ended before"));
  CHECK(fs::last_write_time(folder + "out/records/a.json") == before);
  CHECK(merged(folder + "out") == merged(folder + "whole"));
  CHECK(fs::is_empty(folder + "out/running"));
  CHECK(rows_of(folder + "out/costs.csv").size() == 6);
}

TEST_CASE("fleet: Ctrl-C keeps what has ended, kills the others and says how to go on") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 6);
  const RunResult result =
      run({"fleet", drives, "-o", folder + "out", "-j", "1", "-v"}, {.interrupt_at = "b done"});
  CHECK(result.code == 130);
  CHECK(
      contains(result.err, "interrupted: what has ended is kept; the same command goes on with the others"));
  CHECK(contains(result.out, "not ended "));
  CHECK(processes_with(folder + "out") == 0);
  CHECK(fs::is_empty(folder + "out/running"));
  const std::size_t ended = names_in(folder + "out/records").size();
  CHECK(ended >= 2);
  CHECK(ended < 6);
  CHECK(names_in(folder + "out/drives").size() == ended);
  CHECK(run({"fleet", drives, "-o", folder + "out"}).code == 0);
  CHECK(rows_of(folder + "out/fleet.csv").size() == 6);
}

TEST_CASE("fleet: a folder belongs to one fleet, whose options are checked before the first drive") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 2);
  const std::string out = folder + "out";
  check_refused(run({"fleet", drives, "-o", out, "-m", "g9"}), 2, "g9");
  CHECK_FALSE(exists(out + "/records"));
  check_refused(run({"fleet", drives}), 2, "--out is required");
  check_refused(run({"fleet", folder + "nothing", "-o", out}), 3, "there is no such file or folder");
  check_refused(run({"fleet", "status", drives}), 3, "is no folder of a fleet");
  check_refused(run({"fleet", "merge"}), 2, "type: waymark fleet merge DIR");
  REQUIRE(run({"fleet", drives, "-o", out, "-m", "g1", "-q"}).code == 0);
  check_refused(run({"fleet", drives, "-o", out, "-m", "g2"}), 2,
                "holds a fleet with other results: its options are: --modeling=g1; now: --modeling=g2");
  // A drive.yaml that changed is another drive; a list names drives too.
  write_text(drives + "/a/drive.yaml", read_text(drives + "/a/drive.yaml") + "# changed\n");
  write_text(folder + "list", drives + "/a/drive.yaml\n\n" + drives + "/b/drive.yaml\n");
  const RunResult again = run({"fleet", "@" + folder + "list", "-o", out, "-m", "g1"});
  CHECK(again.code == 0);
  CHECK(contains(again.err, "note: 1 drives were run again, because their drive.yaml changed"));
}

TEST_CASE("fleet: shares of a cluster give the bytes of one machine, and status counts them") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 5);
  fs::remove(drives + "/d/gnss.csv");
  REQUIRE(run({"fleet", drives, "-o", folder + "whole", "-m", "g1"}).code == 3);
  // A stand-in for sbatch that only shows what it was given.
  fs::create_directory(folder + "bin");
  write_text(folder + "bin/sbatch", "#!/bin/sh\necho \"$@\" > \"$0.words\"\necho 4711\n");
  fs::permissions(folder + "bin/sbatch", fs::perms::owner_all);
  const RunResult submitted =
      bash("PATH=$PWD/bin:$PATH \"$0\" fleet drives -o out -m g1 --slurm --per-task 2", folder);
  INFO(submitted.err);
  CHECK(submitted.code == 0);
  CHECK(contains(submitted.err, "submitted job 4711 of 3 tasks"));
  CHECK(read_text(folder + "bin/sbatch.words") == "--parsable " + folder + "out/slurm/fleet.sbatch\n");
  CHECK(contains(read_text(folder + "out/slurm/fleet.sbatch"), "#SBATCH --array=0-2\n"));

  const auto status = [&] { return Json::parse(run({"fleet", "status", folder + "out", "--json"}).out); };
  CHECK(status().at("not_ended") == 5);
  check_refused(run({"fleet", "merge", folder + "out"}), 3, "no drive of this fleet has ended yet");
  // The script is what Slurm would run, in any order.
  for (const char* task : {"2", "0"})
    CHECK(bash(std::string("SLURM_ARRAY_TASK_ID=") + task + " sh out/slurm/fleet.sbatch", folder).code == 0);
  CHECK(status().at("done") == 3);
  CHECK(status().at("not_ended") == 2);
  CHECK(contains(run({"fleet", "merge", folder + "out"}).err, "2 of 5 drives have not ended"));
  CHECK(bash("SLURM_ARRAY_TASK_ID=1 sh out/slurm/fleet.sbatch", folder).code == 0);
  CHECK(status().at("failures").at(0).at("drive") == "d");
  CHECK(run({"fleet", "merge", folder + "out"}).code == 3);
  CHECK(merged(folder + "out") == merged(folder + "whole"));

  const RunResult missing = bash("PATH=/nowhere \"$0\" fleet drives -o other --slurm", folder);
  CHECK(missing.code == 5);
  CHECK(contains(missing.err, "the job was not submitted: "));
  CHECK(contains(missing.err, "submit " + folder + "other/slurm/fleet.sbatch yourself"));
}

TEST_CASE("fleet: a drive that needs more than its share of the memory is run alone") {
  if (waymark::detail::kAddressSanitized)
    return waymark_test::skip("AddressSanitizer knows no limit of memory");
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 2);
  // A share of 3 MB is too small; all of it together is enough.
  const RunResult result =
      run({"fleet", drives, "-o", folder + "out", "-j", "8", "--memory", "24", "-m", "g1"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(rows_of(folder + "out/fleet.csv").size() == 2);
  const RunResult none = run({"fleet", drives, "-o", folder + "none", "--memory", "3", "-m", "g1"});
  CHECK(none.code == 3);
  CHECK(rows_of(folder + "none/fleet.csv").at(0).at("state") == "failed");
}

TEST_CASE("fleet: two fleets are compared drive by drive, by the rule that is told") {
  const std::string folder = fresh_folder();
  const std::string drives = write_drives(folder, 4);
  REQUIRE(run({"fleet", drives, "-o", folder + "old", "-m", "g1", "--label", "old", "-q"}).code == 0);
  fs::remove(drives + "/d/gnss.csv");
  // Worse by construction: half of the fixes of one drive are missing, all others are the same.
  const std::vector<std::string> fixes = lines_of(read_text(drives + "/c/gnss.csv"));
  std::string fewer = fixes[0] + "\n";
  for (std::size_t i = 1; i < fixes.size(); i += 4) fewer += fixes[i] + "\n";
  write_text(drives + "/c/gnss.csv", fewer);
  REQUIRE(run({"fleet", drives, "-o", folder + "new", "-m", "g1", "--label", "new", "-q"}).code == 3);
  const RunResult result =
      run({"fleet", "compare", folder + "old", folder + "new", "-o", folder + "changes", "--json"});
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json.at("old") == "old");
  const Json& pairs = json.at("drives");
  REQUIRE(pairs.size() == 4);
  CHECK(pairs[0].at("change") == "same");
  CHECK(pairs[0].at("old_error_m") == pairs[0].at("new_error_m"));
  const double before = pairs[2].at("old_error_m");
  const double now = pairs[2].at("new_error_m");
  const bool differs = std::abs(now - before) > 0.02 && std::abs(now - before) > 0.05 * before;
  CHECK(differs);
  CHECK(pairs[2].at("change") == (now > before ? "worse" : "better"));
  CHECK(pairs[3].at("change") == "lost");
  CHECK(json.at("fleet") == "worse");
  const std::string page = read_text(folder + "changes/regression.html");
  CHECK(page_flaws(page) == std::vector<std::string>{});
  CHECK(contains(page, "grew by more than 5 % and by more than 0.02 m"));
  CHECK(table_row(page, "Got worse", "d").at(3) == "lost");
  CHECK(rows_of(folder + "changes/regression.csv").size() == 4);
  check_refused(run({"fleet", "compare", folder + "old", "-o", folder + "x"}), 2,
                "type: waymark fleet compare OLD NEW");
}

}  // namespace fleet_test
