// Statements about the sources of a drive: SOURCE and STATES, and the antenna of every fix.
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>

#include "formats/read_helpers.hpp"

namespace sources_test {

using namespace waymark;
using namespace waymark::formats;

namespace {

/// Two poses; a fix of each of two receivers.
GraphDocument two_fixes() {
  GraphDocument document;
  for (std::int64_t id = 1; id <= 2; ++id) {
    const VertexIndex pose = document.graph.add_vertex<VertexSe2>(VertexId{id}, {0, 0, 0});
    document.graph.set_stamp(pose, Stamp::from_seconds(static_cast<double>(id)));
    Fix fix;
    fix.stamp = *document.graph.stamp(pose);
    fix.vertex = VertexId{id};
    fix.source = static_cast<int>(id) - 1;
    document.fixes.push_back(fix);
  }
  return document;
}

GraphDocument several_sources() {
  GraphDocument document = two_fixes();
  document.sources = {
      {"wheels", "odometry", {0, 0}, {}},
      {"front", "gnss", {2.6, 0.1}, {{VertexId{1}, VertexId{1}}}},
      {"rear", "gnss", {-0.8, 1.0 / 3}, {{VertexId{2}, VertexId{2}}, {VertexId{5}, VertexId{9}}}},
      {"compass", "heading", {0, 0}, {}}};
  return document;
}

std::string error_of_header(const std::string& lines) {
  try {
    (void)read("GRAPH 1\n" + lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("sources: names, kinds, antennas and states come back number by number") {
  const GraphDocument document = several_sources();
  const GraphDocument back = read(write(document));
  REQUIRE(back.sources.size() == document.sources.size());
  for (std::size_t i = 0; i < back.sources.size(); ++i) {
    CHECK(back.sources[i].name == document.sources[i].name);
    CHECK(back.sources[i].kind == document.sources[i].kind);
    CHECK(back.sources[i].antenna_m == document.sources[i].antenna_m);
    CHECK(back.sources[i].vertices == document.sources[i].vertices);
  }
  CHECK(write(back) == write(document));
}

TEST_CASE("sources: every fix that is read has the antenna of its receiver") {
  const GraphDocument back = read(write(several_sources()));
  REQUIRE(back.fixes.size() == 2);
  CHECK(back.fixes[0].antenna_m == Eigen::Vector2d(2.6, 0.1));
  CHECK(back.fixes[1].antenna_m == Eigen::Vector2d(-0.8, 1.0 / 3));
}

TEST_CASE("sources: in a file without sources every fix has the lever arm") {
  GraphDocument document = two_fixes();
  document.antenna_m = {1.5, -0.25};
  const std::string text = write(document);
  CHECK(text.find("LEVER antenna 1.5 -0.25") != std::string::npos);
  CHECK(text.find("SOURCE") == std::string::npos);
  for (const Fix& fix : read(text).fixes) CHECK(fix.antenna_m == Eigen::Vector2d(1.5, -0.25));
}

TEST_CASE("sources: a vertex belongs to the source whose states contain it") {
  const GraphDocument document = several_sources();
  CHECK(source_of(VertexId{1}, document) == "front");
  CHECK(source_of(VertexId{5}, document) == "rear");
  CHECK(source_of(VertexId{9}, document) == "rear");
  CHECK(source_of(VertexId{10}, document).empty());
  REQUIRE(receivers_of(document).size() == 2);
  CHECK(receivers_of(document)[1].name == "rear");
}

TEST_CASE("sources: wrong statements are refused with their place") {
  using Catch::Matchers::StartsWith;
  CHECK_THAT(error_of_header("SOURCE front\n"), StartsWith("test.graph:2:"));
  CHECK_THAT(error_of_header("SOURCE front gnss 1\n"), StartsWith("test.graph:2:"));
  CHECK_THAT(error_of_header("SOURCE front gnss 1 2 3\n"), StartsWith("test.graph:2:"));
  CHECK_THAT(error_of_header("SOURCE front gnss 1 2\nSOURCE front gnss 1 2\n"), StartsWith("test.graph:3:"));
  CHECK_THAT(error_of_header("STATES front 1 2\n"), StartsWith("test.graph:2:"));
  CHECK_THAT(error_of_header("SOURCE front gnss 1 2\nSTATES front 3 2\n"), StartsWith("test.graph:3:"));
}

}  // namespace sources_test
