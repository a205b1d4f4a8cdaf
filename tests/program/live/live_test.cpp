// `waymark live`: replays, streams, recordings, signals, and what goes wrong with them.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "../support/material.hpp"
#include "../support/program.hpp"
#include "support/paths.hpp"

namespace live_program_test {

using Json = nlohmann::json;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<Json> objects_of(const std::string& text, const std::string& kind) {
  std::vector<Json> objects;
  for (const std::string& line : lines_of(text)) {
    const Json object = Json::parse(line, nullptr, false);
    REQUIRE(object.is_object());
    if (object.at("kind") == kind) objects.push_back(object);
  }
  return objects;
}

/// Runs a script of the shell in a folder; "$WAYMARK" is the program.
RunResult script(const std::string& folder, const std::string& text) {
  const std::string file = write_text(folder + "script.sh", "set -u\n" + text);
  RunOptions options;
  options.program = "/bin/bash";
  options.folder = folder;
  return run({file, waymark_test::program_path()}, options);
}

/// A drive whose logs are named pipes, beside the logs of a simulated one.
std::string piped_drive(const std::string& folder) {
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "60", "-o", folder + "d"}).code == 0);
  return write_text(folder + "live.yaml",
                    "folder: .\n"
                    "odometry: {file: odometry.pipe, format: csv}\n"
                    "gnss: {file: gnss.pipe, format: gpsd_json}\n");
}

}  // namespace

TEST_CASE("live: a replay says the same at any speed") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "60", "-o", folder + "d"}).code == 0);
  const std::string drive = folder + "d/drive.yaml";
  REQUIRE(run({"live", drive, "-o", "json:" + folder + "max.jsonl"}).code == 0);
  REQUIRE(run({"live", drive, "-o", "json:" + folder + "paced.jsonl", "--speed", "50"}).code == 0);
  const std::string lines = read_text(folder + "max.jsonl");
  CHECK(read_text(folder + "paced.jsonl") == lines);
  CHECK(objects_of(lines, "frame").size() == 1);
  const std::vector<Json> poses = objects_of(lines, "pose");
  CHECK(poses.size() > 1100);  // from the alignment on
  CHECK(poses.back().at("state") == "tracking");
  CHECK(objects_of(lines, "settled").size() > 1300);
  for (const Json& pose : poses) {
    REQUIRE(pose.at("covariance").size() == 6);
    CHECK(pose.at("covariance")[0].get<double>() > 0);
  }
}

TEST_CASE("live: a replay of two odometries and a receiver says the same at twenty times real time") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "two-odometries", "--duration", "60", "-o", folder + "d"}).code == 0);
  const std::string drive = folder + "d/drive.yaml";
  const RunResult result = run({"live", drive, "-o", "json:" + folder + "max.jsonl", "--json"});
  REQUIRE(result.code == 0);
  const Json summary = Json::parse(result.out, nullptr, false);
  CHECK(summary.at("taken").at("wheels").get<int>() > 1000);
  CHECK(summary.at("taken").at("visual").get<int>() > 100);
  CHECK(summary.at("failures") == 0);
  REQUIRE(run({"live", drive, "-o", "json:" + folder + "paced.jsonl", "--speed", "20"}).code == 0);
  CHECK(read_text(folder + "paced.jsonl") == read_text(folder + "max.jsonl"));
}

TEST_CASE("live: the report has the way, the radius and the histogram of latencies") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "60", "-o", folder + "d"}).code == 0);
  REQUIRE(run({"live", folder + "d/drive.yaml", "-o", "json:" + folder + "a.jsonl", "--report", folder + "r"})
              .code == 0);
  CHECK(contains(read_text(folder + "r/report.html"), "99.9 %"));
  CHECK(!read_text(folder + "r/figures/report-way.svg").empty());
  CHECK(!read_text(folder + "r/figures/report-radius.svg").empty());
  // The shares of each histogram are all of it.
  double sum = 0;
  const std::vector<std::string> rows = lines_of(read_text(folder + "r/figures/report-latency.csv"));
  for (const std::string& row : rows)
    if (row.rfind("solve,", 0) == 0) sum += std::stod(row.substr(row.find(',', row.find(',') + 1) + 1));
  CHECK(sum == Approx(100).margin(0.1));
}

TEST_CASE("live: sentences of NMEA have right checksums and the places of the poses") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "urban", "--duration", "40", "-o", folder + "d"}).code == 0);
  REQUIRE(run({"live", folder + "d/drive.yaml", "-o", "nmea:" + folder + "a.nmea?rate=1", "-o",
               "csv:" + folder + "a.csv?rate=1", "--talker", "II"})
              .code == 0);
  const std::vector<std::string> table = lines_of(read_text(folder + "a.csv"));
  const std::vector<std::string> sentences = lines_of(read_text(folder + "a.nmea"));
  REQUIRE(sentences.size() == 3 * (table.size() - 1));
  for (const std::string& sentence : sentences) {
    const std::size_t star = sentence.find('*');
    REQUIRE(star != std::string::npos);
    unsigned sum = 0;
    for (std::size_t i = 1; i < star; ++i) sum ^= static_cast<unsigned char>(sentence[i]);
    CHECK(std::stoul(sentence.substr(star + 1, 2), nullptr, 16) == sum);
    CHECK(sentence.substr(0, 3) == "$II");
  }
  // The reader of logs finds the same places, to the 0.1 mm that seven decimals of a minute hold.
  const RunResult seen = run({"inspect", folder + "a.nmea", "--json"});
  REQUIRE(seen.code == 0);
  CHECK(contains(seen.out, "\"format\": \"nmea\""));
}

TEST_CASE("live: pipes, a recording, and its repetition to the bit") {
  const std::string folder = fresh_folder();
  (void)piped_drive(folder);
  const RunResult result =
      script(folder,
             "mkfifo odometry.pipe gnss.pipe\n"
             "$1 live live.yaml -o json:live.jsonl --record take 2> log & pid=$!\n"
             "exec 3> odometry.pipe 4> gnss.pipe\n"
             // alternately, in pieces that end anywhere
             "for part in 1 2 3 4 5 6; do\n"
             "  split -n $part/6 d/odometry.csv >&3; split -n $part/6 d/gnss.json >&4; sleep 0.1\n"
             "done\n"
             "sleep 0.5; kill -TERM $pid; wait $pid; echo code $?\n"
             "$1 live live.yaml -o json:again.jsonl --play take\n"
             "cmp live.jsonl again.jsonl && echo same\n");
  CHECK(contains(result.out, "code 0"));
  CHECK(contains(result.out, "same"));
  CHECK(objects_of(read_text(folder + "live.jsonl"), "pose").size() > 1000);
}

TEST_CASE("live: a state file is kept, survives a kill, and begins the next run warm") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "90", "-o", folder + "d"}).code == 0);
  const RunResult result =
      script(folder,
             "$1 live d/drive.yaml -o json:a.jsonl --state state.json --speed 60 2> log & pid=$!\n"
             "sleep 1.2; kill -9 $pid; wait $pid 2> /dev/null; ls\n");
  CHECK(contains(result.out, "state.json"));
  const Json state = Json::parse(read_text(folder + "state.json"), nullptr, false);
  REQUIRE(state.is_object());
  CHECK(state.at("schema") == "waymark-live-state");
  CHECK(!state.at("states").empty());
  // From this state on the same drive: the vehicle is elsewhere now, so only its calibration is used.
  const RunResult next =
      run({"live", folder + "d/drive.yaml", "-o", "json:-", "--state", folder + "state.json"});
  CHECK(next.code == 0);
  check_refused(
      run({"live", folder + "d/drive.yaml", "--state", write_text(folder + "bad.json", "{\"schema\":1}")}), 3,
      "bad.json");
}

TEST_CASE("live: a disk that is full ends the recording, not the run") {
  const std::string folder = fresh_folder();
  (void)piped_drive(folder);
  const RunResult result =
      script(folder,
             "mkfifo odometry.pipe gnss.pipe\n"
             "$1 live live.yaml -o json:live.jsonl --record /dev/full 2> log & pid=$!\n"
             "cat d/odometry.csv > odometry.pipe & cat d/gnss.json > gnss.pipe; wait $!\n"
             "sleep 1.5; kill -HUP $pid; sleep 0.2; kill -TERM $pid; wait $pid; echo code $?; cat log\n");
  CHECK(contains(result.out, "code 0"));
  CHECK(contains(result.out, "the recording ends here"));
  CHECK(contains(result.out, "solutions"));
}

TEST_CASE("live: clients of TCP come and go, and a slow one holds nothing up") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "40", "-o", folder + "d"}).code == 0);
  const RunResult result =
      script(folder,
             "$1 live d/drive.yaml -o nmea:tcp://localhost:47811?rate=5 --speed 20 2> log & pid=$!\n"
             "sleep 0.6; exec 3<> /dev/tcp/localhost/47811; timeout 0.5 cat <&3 > heard; exec 3>&-\n"
             "exec 4<> /dev/tcp/localhost/47811\n"  // never reads
             "wait $pid; echo code $?; head -c 6 heard\n");
  CHECK(contains(result.out, "code 0"));
  CHECK(contains(result.out, "$GN"));
}

TEST_CASE("live: what cannot be is refused with its remedy") {
  const std::string folder = fresh_folder();
  const std::string drive = bundled_drive();
  check_refused(run({"live", drive, "-o", "xml:-"}), 2, "known are json, nmea, csv, mcap");
  check_refused(run({"live", drive, "-o", "json:gopher://x"}), 2, "unknown scheme 'gopher'");
  check_refused(run({"live", drive, "-o", "json:tcp://host"}), 2, "the port is missing");
  check_refused(run({"live", drive, "-o", "nmea:-", "--talker", "x"}), 2, "a talker has two capital letters");
  check_refused(run({"live", drive, "--speed", "fast"}), 2, "--speed fast");
  check_refused(run({"live", drive, "--noise-from", folder}), 3, "summary.json");
  check_refused(run({"live", drive, "--play", drive}), 3, "no recording");
  check_refused(run({"live", write_text(folder + "live.yaml",
                                        "odometry: {file: \"tcp://localhost:1\"}\n"
                                        "gnss: {file: \"gpsd://localhost\"}\n")}),
                3, "the format of a live source must be stated");
  check_refused(run({"live", drive, "-o", "json:" + folder + "no/such/place"}), 5, "cannot write");
}

TEST_CASE("live: a replay uses the sensors of the drive, and ends if one of its files is missing") {
  const std::string folder = fresh_folder();
  REQUIRE(
      run({"simulate", "--preset", "mixed", "--duration", "60", "--seed", "3", "-o", folder + "d"}).code ==
      0);
  const std::string yaml = read_text(folder + "d/drive.yaml");
  // the heading of the truth in place of a compass; it needs the frame, which comes with the first fix
  const auto with_compass = [&](const std::string& file) {
    return write_text(folder + "d/" + file + ".yaml",
                      yaml + "\nsensors: {name: heading, file: " + file +
                          ", columns: {time: time_s, heading: heading_rad}}\n");
  };
  const RunResult used = run({"live", with_compass("truth.csv"), "-o", "csv:" + folder + "a.csv"});
  INFO(used.err);
  REQUIRE(used.code == 0);
  CHECK(contains(used.err + used.out, " heading"));
  CHECK_FALSE(contains(used.err + used.out, " 0 heading"));
  check_refused(run({"live", with_compass("absent.csv"), "-o", "csv:-"}), 3, "absent.csv: no such file");
}

TEST_CASE("run --window: a live run loses little beside the batch run, and less with a longer lag") {
  const std::string folder = fresh_folder();
  REQUIRE(
      run({"simulate", "--preset", "mixed", "--duration", "240", "--seed", "3", "-o", folder + "d"}).code ==
      0);
  const std::string drive = folder + "d/drive.yaml";
  const RunResult result =
      run({"run", drive, "-o", folder + "out", "--noise", "stated", "--window", "1,30,1000"});
  REQUIRE(result.code == 0);
  CHECK(contains(result.out, "RMSE at the lag [m]"));
  const std::vector<std::string> rows = lines_of(read_text(folder + "out/correlated.windows.csv"));
  REQUIRE(rows.size() == 4);
  std::vector<std::vector<double>> table;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    table.emplace_back();
    std::istringstream cells(rows[i]);
    for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(std::stod(cell));
    REQUIRE(table.back().size() == 9);  // no height, so no error in space
    CHECK(table.back()[1] > 5000);      // poses, at 25 Hz
  }
  // What comes later helps.
  const double live_rmse = table[2][2];
  const double lag_rmse = table[2][6];
  CHECK(lag_rmse < table[0][6]);
  CHECK(lag_rmse < live_rmse);
  check_refused(run({"run", drive, "-o", folder + "out", "--window", "0"}), 2, "--window");
}

TEST_CASE("live: a file of MCAP holds the lines of JSON, topic by topic") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "40", "-o", folder + "d"}).code == 0);
  REQUIRE(run({"live", folder + "d/drive.yaml", "-o", "json:" + folder + "a.jsonl", "-o",
               "mcap:" + folder + "a.mcap"})
              .code == 0);
  // A reader from the specification: magic, records of opcode and length, magic.
  const std::string bytes = read_text(folder + "a.mcap");
  const std::string magic("\x89MCAP0\r\n", 8);
  REQUIRE(bytes.size() > 16);
  CHECK(bytes.substr(0, 8) == magic);
  CHECK(bytes.substr(bytes.size() - 8) == magic);
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  const auto text = [&](std::size_t& at) {
    const std::size_t size = number(at, 4);
    at += 4 + size;
    return bytes.substr(at - size, size);
  };
  std::map<std::uint64_t, std::string> topics;
  std::map<std::string, std::vector<std::string>> messages;
  std::vector<int> opcodes;
  std::set<std::uint64_t> schemas;
  for (std::size_t at = 8; at < bytes.size() - 8;) {
    const int opcode = static_cast<unsigned char>(bytes[at]);
    const std::size_t size = number(at + 1, 8);
    std::size_t content = at + 9;
    REQUIRE(content + size <= bytes.size() - 8);
    opcodes.push_back(opcode);
    if (opcode == 3) {
      schemas.insert(number(content, 2));
      content += 2;
      (void)text(content);
      CHECK(text(content) == "jsonschema");
      CHECK(Json::parse(text(content), nullptr, false).is_object());
    } else if (opcode == 4) {
      const std::uint64_t id = number(content, 2);
      CHECK(schemas.contains(number(content + 2, 2)));
      content += 4;
      topics[id] = text(content);
      CHECK(text(content) == "json");
    } else if (opcode == 5) {
      std::vector<std::string>& of = messages[topics.at(number(content, 2))];
      CHECK(number(content + 2, 4) == of.size());  // the sequence
      of.push_back(bytes.substr(content + 22, size - 22));
    }
    at += 9 + size;
  }
  CHECK(opcodes.front() == 1);
  CHECK(opcodes[opcodes.size() - 2] == 15);
  CHECK(opcodes.back() == 2);
  std::map<std::string, std::vector<std::string>> lines;
  for (const std::string& line : lines_of(read_text(folder + "a.jsonl")))
    lines["/" + Json::parse(line).at("kind").get<std::string>()].push_back(line);
  for (const auto& [topic, of] : lines) CHECK(messages[topic] == of);
  CHECK(messages["/location"].size() == lines["/pose"].size());
  CHECK(Json::parse(messages["/location"].back()).at("latitude").is_number());
}

TEST_CASE("live: every key of its lines is documented") {
  const std::string folder = fresh_folder();
  REQUIRE(run({"simulate", "--preset", "rural", "--duration", "40", "-o", folder + "d"}).code == 0);
  REQUIRE(run({"live", folder + "d/drive.yaml", "-o", "json:" + folder + "a.jsonl", "--window", "20"}).code ==
          0);
  const std::string page = read_text(waymark_test::source_dir() + "/tools/program/JSON.md");
  const std::string table =
      page.substr(page.find("### LIVE"), page.find("## waymark-convert") - page.find("### LIVE"));
  std::set<std::string> keys;
  for (const std::string& line : lines_of(read_text(folder + "a.jsonl"))) {
    const Json object = Json::parse(line, nullptr, false);
    for (const auto& [key, value] : object.items()) keys.insert(key);
  }
  for (const std::string& key : keys) CHECK(contains(table, "| `" + key + "` |"));
  CHECK(keys.size() > 20);
}

}  // namespace live_program_test
