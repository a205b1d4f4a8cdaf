// Reading a written document gives the same document, number by number.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/types_se2/plugin_kit/gnss_modeling.hpp>

#include "formats/read_helpers.hpp"
#include "support/markdown.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

std::uint64_t bits(double value) {
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

/// The file of examples in the specification, formats/README.md.
std::string specification_example() {
  const auto readme =
      waymark_test::parse_markdown(read_text_file(waymark_test::source_dir() + "/formats/README.md"));
  const auto found = std::find_if(readme.blocks.begin(), readme.blocks.end(),
                                  [](const auto& block) { return block.language == "graph"; });
  REQUIRE(found != readme.blocks.end());
  return found->text;
}

}  // namespace

TEST_CASE("round trip: numbers come back bit by bit") {
  // Guards against digits lost in text: g2o's six turn the northing 5701234.567 into 5701230.
  const double limit = std::numeric_limits<double>::max();
  for (const double x : {5701234.567, 0.1, 1.0 / 3, -0.0, 5e-324, 2.2250738585072009e-308, 1e300, -limit,
                         std::nextafter(1.0, 2.0), 123456789012345680.0}) {
    GraphDocument document;
    document.graph.add_vertex<VertexSe2>(VertexId{7}, {x, -x, x / 3});
    const auto back = read(write(document)).graph;
    INFO(x);
    CHECK(bits(back.value(0)[0]) == bits(x));
    CHECK(bits(back.value(0)[1]) == bits(-x));
    CHECK(bits(back.value(0)[2]) == bits(x / 3));
  }
}

TEST_CASE("round trip: stamps and ids at the ends of their range come back") {
  GraphDocument document;
  const auto least = std::numeric_limits<std::int64_t>::min();
  const auto most = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t id : {least, most, std::int64_t{-1}, std::int64_t{1} << 24}) {
    document.graph.set_stamp(document.graph.add_vertex<VertexSe2>(VertexId{id}, {0, 0, 0}), Stamp{most});
  }
  document.graph.set_stamp(1, Stamp{least + 1});  // least means "none"
  const auto back = read(write(document)).graph;
  CHECK(back.id(0) == VertexId{least});
  CHECK(back.id(1) == VertexId{most});
  CHECK(back.stamp(0)->nanoseconds == most);
  CHECK(back.stamp(1)->nanoseconds == least + 1);
}

TEST_CASE("round trip: writing is a fixed point after the first reading") {
  for (const auto& entry :
       std::filesystem::directory_iterator(waymark_test::source_dir() + "/tests/formats/cases")) {
    if (entry.path().extension() != ".graph" && entry.path().extension() != ".g2o") continue;
    std::string once;
    try {
      once = write(read(read_text_file(entry.path().string())));
    } catch (const InputError&) {
      continue;  // a case of an error
    }
    INFO(entry.path());
    CHECK(write(read(once)) == once);
  }
}

TEST_CASE("round trip: the example of the specification is read and holds every statement") {
  const std::string example = specification_example();
  const GraphDocument document = read(example);
  CHECK(read(write(document)).graph.chi2() == document.graph.chi2());
  // Found by a reader that was written from the specification alone, in another language; the page
  // shows it.
  CHECK(document.graph.chi2() == Approx(109.52636712641265).epsilon(1e-12));
  for (const char* statement : {"GRAPH", "FRAME", "TIME", "PROVENANCE", "LEVER", "TYPE", "STAMP", "FIX",
                                "LOSS", "GNSS", "COVARIANCE", "EDGE_GAUSSIAN_PRIOR"}) {
    INFO(statement);
    CHECK(("\n" + example).find(std::string("\n") + statement + " ") != std::string::npos);
  }
  for (const auto& entry : test_registry().edges()) {
    if (entry.origin != "waymark") continue;  // those of plugins are specified in their READMEs
    INFO(entry.type.tag);
    CHECK(example.find(entry.type.tag + " ") != std::string::npos);
  }
}

TEST_CASE("round trip: text from outside cannot begin a new statement") {
  // Guards against a drive's name of two lines: the second was read as a tag.
  GraphDocument document;
  document.graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  document.provenance = {{"drive", "first\nEDGE_SE2 second\r\n"}, {"empty", ""}};
  const auto back = read(write(document)).provenance;
  REQUIRE(back.size() == 2);
  CHECK(back[0].second == "first EDGE_SE2 second");
  CHECK(back[1].second.empty());
}

TEST_CASE("round trip: a position edge written as EDGE_SE2 has the same chi2") {
  GraphDocument document;
  const auto origin = document.graph.add_vertex<VertexSe2>(VertexId{0}, {3, -2, 0.7});
  const auto pose = document.graph.add_vertex<VertexSe2>(VertexId{1}, {10, 20, -2.5});
  document.graph.set_fixed(origin, true);
  Eigen::Matrix2d omega;
  omega << 4, 1.5, 1.5, 9;
  document.graph.add_edge(EdgeGnssPosition{{11, 18}, {0, 0}}, {origin, pose}, omega);
  const GraphDocument g2o = read(write_as(GraphFormat::g2o, document));
  CHECK(g2o.graph.edge_type(0).tag == "EDGE_SE2");
  CHECK(g2o.graph.chi2() == Approx(document.graph.chi2()).epsilon(1e-14));
}

TEST_CASE("round trip: the standard g2o files come back exactly") {
  const auto folder = waymark_test::shared_data("graphs");
  if (!folder) return;
  for (const char* name : {"intel.g2o", "manhattanOlson3500.g2o", "MIT.g2o"}) {
    const GraphDocument document = read_graph(read_text_file(*folder + "/" + name), name, test_registry());
    const GraphDocument back = read_graph(write_as(GraphFormat::g2o, document), name, test_registry());
    INFO(name);
    CHECK(back.graph.values() == document.graph.values());
    CHECK(back.graph.edge_count() == document.graph.edge_count());
    CHECK(back.graph.chi2() == document.graph.chi2());
  }
}

TEST_CASE("round trip: a word in a message is short and harmless") {
  // Guards against binary files that reprogram the terminal, and against invalid UTF-8 in JSON
  // output.
  CHECK(quote_word("abc") == "'abc'");
  CHECK(quote_word("") == "the end of the line");
  CHECK(quote_word("\x1b[31m\xff") == "'\\x1b[31m\\xff'");
  CHECK(quote_word(std::string(100, 'x')) == "'" + std::string(40, 'x') + "...'");
}

TEST_CASE("round trip: a wide prior is refused before its matrix takes all memory") {
  // Guards against an arity of 100000: std::bad_alloc, reported as an internal error.
  std::string text = "GRAPH 1\nVERTEX_SE2 0 0 0 0\nEDGE_GAUSSIAN_PRIOR 1001 0\n";
  CHECK_THROWS_WITH(read(text), "test.graph:3:21: EDGE_GAUSSIAN_PRIOR: the arity must be 1 to 1000");
}
