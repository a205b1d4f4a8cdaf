// Every pair in cases/: NAME.graph or NAME.g2o is read; the output must be NAME.expected, byte
// by byte. A new case needs the two files only (README.md). ctest runs each pair as a test of its
// own.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/detail/foreign_graph.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "formats/read_helpers.hpp"
#include "support/paths.hpp"

namespace {

namespace fs = std::filesystem;
using namespace waymark;
using namespace waymark::formats;

const fs::path kCases = fs::path(waymark_test::source_dir()) / "tests/formats/cases";

bool has_part(const fs::path& input, const std::string& part) {
  return input.filename().string().find("." + part + ".") != std::string::npos;
}

/// The format that "X.toro.graph" is read as.
GraphFormat input_format(const fs::path& input) {
  if (has_part(input, "toro")) return GraphFormat::toro;
  return has_part(input, "covariance") ? GraphFormat::covariance : GraphFormat::graph;
}

/// "X.to_g2o.graph": the file that a reader of that format or profile gets, and its
/// notes.
std::string written(const GraphDocument& document, const fs::path& input) {
  const auto write = [&](const Recipient& recipient, GraphFormat format) {
    const ForeignGraph foreign(document, input.filename().string(), recipient, format);
    std::string text = collect_text([&](const TextSink& sink) { foreign.write(sink); });
    for (const std::string& change : foreign.changes()) text += "changed: " + change + "\n";
    if (const std::string left_out = foreign.left_out(); !left_out.empty()) {
      text += "left out: " + left_out + "\n";
    }
    return text;
  };
  for (const GraphFormat format : {GraphFormat::g2o, GraphFormat::toro, GraphFormat::covariance}) {
    if (has_part(input, "to_" + std::string(to_string(format)))) return write(any_reader(format), format);
  }
  for (const Recipient& profile : profiles()) {
    if (has_part(input, "for_" + std::string(profile.name))) return write(profile, profile.formats.front());
  }
  return write_graph(document, test_registry());
}

/// "X.lenient.graph" is read leniently; without a part that says otherwise the canonical .graph is
/// written.
std::string outcome(const fs::path& input) {
  const std::string name = input.filename().string();
  try {
    ReadReport report;
    const GraphDocument document = read_graph_as(input_format(input), read_text_file(input.string()), name,
                                                 test_registry(), has_part(input, "lenient"), &report);
    std::string text = written(document, input);
    if (report.edges_only) text += "edges only, " + std::to_string(report.apart) + " apart\n";
    if (report.skipped > 0) text += "skipped " + std::to_string(report.skipped) + "\n";
    for (const std::string& example : report.examples) text += example + "\n";
    return text;
  } catch (const InputError& error) {
    return std::string("input error: ") + error.what() + "\n";
  } catch (const UsageError& error) {
    return std::string("usage error: ") + error.what() + "\n";
  }
}

fs::path expected_file(const fs::path& input) {
  const std::string name = input.filename().string();
  return kCases / (name.substr(0, name.find('.')) + ".expected");
}

std::vector<fs::path> chosen_cases() {
  if (const char* one = std::getenv("WAYMARK_FORMAT_CASE")) return {fs::path(one)};
  std::vector<fs::path> cases;
  for (const auto& entry : fs::directory_iterator(kCases)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".graph" || extension == ".g2o") cases.push_back(entry.path());
  }
  std::sort(cases.begin(), cases.end());
  return cases;
}

}  // namespace

TEST_CASE("format cases: every pair of files gives what is expected", "[.pairs]") {
  for (const fs::path& input : chosen_cases()) {
    DYNAMIC_SECTION(input.filename().string()) {
      const std::string found = outcome(input);
      if (std::getenv("WAYMARK_WRITE_EXPECTED") != nullptr) {
        write_file_atomically(expected_file(input).string(), found);
      }
      CHECK(found == read_text_file(expected_file(input).string()));
    }
  }
}

TEST_CASE("format cases: every file with an expectation is a case") {
  // Guards against a mistyped name, whose expectation would never be looked at.
  std::vector<fs::path> expectations;
  for (const fs::path& input : chosen_cases()) expectations.push_back(expected_file(input));
  for (const auto& entry : fs::directory_iterator(kCases)) {
    if (entry.path().extension() != ".expected") continue;
    INFO(entry.path());
    CHECK(std::count(expectations.begin(), expectations.end(), entry.path()) == 1);
  }
}
