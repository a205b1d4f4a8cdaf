// The output of --json against the tables of tools/program/JSON.md: every key printed is documented with its
// type, every key documented is printed.
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/material.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"

namespace json_schema_test {

namespace {

using Json = nlohmann::json;

struct Key {
  std::string type;  ///< "number or null", "list of text", "map of SYSTEM", ...
  bool optional = false;
};
using Table = std::map<std::string, Key>;  ///< by path: "records[].chi2"

/// The tables of the document by the heading above them.
std::map<std::string, Table> read_tables(const std::string& markdown) {
  static const std::regex heading("#+ (\\S+)");
  static const std::regex row("\\| `([^`]+)` \\| ([^|]+?)(, optional)? \\|.*");
  std::map<std::string, Table> tables;
  std::string name;
  std::istringstream lines(markdown);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, heading)) name = match[1];
    if (std::regex_match(line, match, row)) tables[name][match[1]] = {match[2], match[3].matched};
  }
  return tables;
}

class Schema {
 public:
  Schema() : tables_(read_tables(read_text(waymark_test::source_dir() + "/tools/program/JSON.md"))) {}

  /// The error in a document that names its own kind; empty: none.
  [[nodiscard]] std::string problems_of(const Json& document) {
    problems_.clear();
    kind_ = document.value("schema", "no schema");
    if (document.value("version", 0) != 1) problems_ += "version is not 1\n";
    if (tables_.contains(kind_)) {
      Json content = document;
      content.erase("schema");
      content.erase("version");
      compare(content, kind_, "");
    } else {
      problems_ += "no table for " + kind_ + "\n";
    }
    return problems_;
  }

 private:
  /// An object against the rows of a table that begin with the prefix.
  void compare(const Json& object, const std::string& table, const std::string& prefix) {
    const Table& rows = tables_.at(table);
    for (const auto& [name, value] : object.items()) {
      const auto row = rows.find(prefix + name);
      if (row == rows.end()) {
        problems_ += table + ": " + prefix + name + " is not documented\n";
      } else {
        compare(value, row->second.type, table, row->first);
      }
    }
    for (const auto& [path, key] : rows) {
      const bool direct = path.rfind(prefix, 0) == 0 && path.find('.', prefix.size()) == std::string::npos;
      if (direct && !key.optional && !object.contains(path.substr(prefix.size())))
        problems_ += table + ": " + path + " is missing\n";
    }
  }

  /// A value against the type of its row.
  void compare(const Json& value, std::string type, const std::string& table, const std::string& path) {
    // "list of number or null": its elements may be null.
    constexpr std::string_view kNullOr = "null or ";
    constexpr std::string_view kOrNull = " or null";
    if (type.starts_with(kNullOr)) {
      if (value.is_null()) return;
      type.erase(0, kNullOr.size());
    }
    if (type.starts_with("list of ") || type.starts_with("map of ")) {
      const bool list = type.starts_with("list");
      if (list != value.is_array() || list == value.is_object()) return wrong(value, type, table, path);
      for (const auto& [name, element] : value.items())
        compare(element, type.substr(type.find(" of ") + 4), table, path + (list ? "[]" : "." + name));
    } else if (type.ends_with(kOrNull)) {
      if (!value.is_null()) compare(value, type.substr(0, type.size() - kOrNull.size()), table, path);
    } else if (type == "list") {
      if (!value.is_array()) return wrong(value, type, table, path);
      for (const Json& element : value) compare(element, table, path + "[].");
    } else if (type == "object") {
      if (!value.is_object()) return wrong(value, type, table, path);
      compare(value, table, path + ".");
    } else if (tables_.contains(type)) {
      if (!value.is_object()) return wrong(value, type, table, path);
      compare(value, type, "");
    } else {
      const bool right = (type == "text" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
                         (type == "integer" && value.is_number_integer()) ||
                         (type == "number" && value.is_number());
      if (!right) wrong(value, type, table, path);
    }
  }

  void wrong(const Json& value, const std::string& type, const std::string& table, const std::string& path) {
    problems_ += table + ": " + path + " is no " + type + ": " + value.dump().substr(0, 60) + "\n";
  }

  std::map<std::string, Table> tables_;
  std::string kind_;
  std::string problems_;
};

}  // namespace

TEST_CASE("json: json of every subcommand is as tools/program/JSON.md documents it") {
  const std::string folder = fresh_folder();
  const std::string drive = write_drive(folder);
  const std::string graph = folder + "a.graph";
  const std::string fused = folder + "b.graph";
  const std::string square = write_text(folder + "square.graph", square_graph());
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"inspect", {"inspect", folder + "gnss.csv", folder + "odometry.csv"}},
      {"init", {"init", folder + "gnss.csv", folder + "odometry.csv", "-o", folder + "new.yaml"}},
      {"init", {"init", "-o", folder + "template.yaml"}},
      {"sync", {"sync", bundled_drive()}},
      {"convert", {"convert", drive, "-o", graph}},
      {"convert", {"convert", square, "-o", folder + "a.g2o", "--profile", "ceres"}},
      {"optimize", {"optimize", graph, "-o", fused, "--covariance", "fixes"}},
      {"optimize", {"optimize", square, "-o", folder + "c.graph", "--robust", "gnc"}},
      {"metrics", {"evaluate", fused, "--truth", drive}},
      {"metrics", {"evaluate", fused}},
      {"metrics", {"run", drive, "-o", folder + "out", "--outage", "5/20", "--causal"}},
      {"metrics", {"compare", folder + "out", "-o", folder + "compared"}},
      {"fleet", {"fleet", drive, "-o", folder + "fleet"}},
      {"fleet", {"fleet", "status", folder + "fleet"}},
      {"fleet-comparison", {"fleet", "compare", folder + "fleet", folder + "fleet", "-o", folder + "changes"}},
      {"view", {"view", folder + "out"}},
      {"live", {"live", drive, "-o", "json:" + folder + "live.jsonl"}},
      {"doctor", {"doctor", drive}},
      {"bench", {"bench", square, "--repeat", "1"}},
      {"info", {"info"}},
      {"plugins", {"info", "--plugins"}},
      {"check", {"check", fused}},
      {"check", {"check", square}},
      {"derivatives", {"check", "--derivatives"}},
      {"drive", {"simulate", "--preset", "rural", "--duration", "60", "-o", folder + "simulated"}},
      {"sources", {"simulate", "--preset", "two-odometries", "--duration", "60", "-o", folder + "several"}},
      {"metrics", {"run", folder + "several/drive.yaml", "-o", folder + "fused", "--noise", "stated"}},
      {"drive", {"inspect", drive}},
      {"presets", {"simulate", "--list"}},
      {"reproduction", {"reproduce", drive, "-o", folder + "paper"}}};
  Schema schema;
  std::set<std::string> commands;
  for (const auto& [kind, words] : cases) {
    std::vector<std::string> arguments = words;
    arguments.emplace_back("--json");
    const RunResult result = run(arguments);
    INFO(kind << ": " << words[0] << "\n" << result.err);
    REQUIRE(result.code == 0);
    const Json document = Json::parse(result.out, nullptr, false);
    REQUIRE(document.is_object());
    CHECK(document.value("schema", "") == "waymark-" + kind);
    CHECK(schema.problems_of(document) == "");
    commands.insert(words[0]);
  }
  // A subcommand that is added must be documented and tried here.
  const std::string help = run({"--help"}).out;
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.rfind("  ", 0) == 0) {
    const std::string command = line.substr(2, line.find(' ', 2) - 2);
    const bool prints_text_for_programs = command == "help" || command == "completion";
    INFO(command);
    if (!command.empty() && !prints_text_for_programs) CHECK(commands.contains(command));
  }
}

TEST_CASE("json: a failure leaves stdout empty and keeps its text on stderr, with --json too") {
  const RunResult result = run({"check", "missing.graph", "--json"});
  CHECK(result.code == 3);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "waymark: error: missing.graph"));
}

}  // namespace json_schema_test
