// Every registered type through text and back: nothing is lost, not one bit.
#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/formats/graph/graph_document.hpp>

#include "support/registry.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

/// Numbers that are hard on text: no short decimal form, large, tiny, subnormal, negative zero.
double hard_number(std::mt19937_64& random) {
  static const double kHard[] = {
      0.1 + 0.2, 1.0 / 3, 5701234.567,          -1e-300, 5e-324, 1.7976931348623157e308,
      -0.0,      1e22,    123456789012345680.0, 0.1};
  if (random() % 4 == 0) return kHard[random() % std::size(kHard)];
  // Any finite bit pattern of ordinary size.
  const double mantissa = std::bit_cast<double>((random() >> 12) | 0x3FF0000000000000ULL) - 1.5;
  return std::ldexp(mantissa, static_cast<int>(random() % 60) - 30);
}

std::vector<double> hard_numbers(std::size_t n, std::mt19937_64& random) {
  std::vector<double> result(n);
  for (double& x : result) x = hard_number(random);
  return result;
}

/// Positive semi-definite with entries that have no short decimal form; some axes without
/// information.
Eigen::MatrixXd hard_information(Eigen::Index n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return unit(random); });
  Eigen::MatrixXd information = root * root.transpose();
  information =
      Eigen::MatrixXd(0.5 * (information + information.transpose())) + Eigen::MatrixXd::Identity(n, n);
  if (random() % 2 == 0) {
    information.row(n - 1).setZero();
    information.col(n - 1).setZero();
  }
  return information;
}

/// Several vertices of every type, several edges of every type, fixed vertices, stamps, losses.
GraphDocument document_of_everything(const TypeRegistry& registry) {
  std::mt19937_64 random(21);
  GraphDocument document;
  Graph& graph = document.graph;
  std::int64_t id = -5;
  for (int copy = 0; copy < 3; ++copy) {
    for (const auto& [type, origin] : registry.vertices()) {
      const auto v = graph.add_vertex(type, VertexId{id},
                                      hard_numbers(static_cast<std::size_t>(type.value_size), random));
      id = id * 3 % 1'000'000'007 + 101;
      if (copy == 1) graph.set_fixed(v, true);
      if (copy == 2) graph.set_stamp(v, Stamp{static_cast<std::int64_t>(random() >> 2)});
    }
  }
  const auto vertex_of = [&](const std::string& tag, const std::vector<VertexIndex>& taken) {
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
      if (graph.vertex_type(v).tag == tag && std::find(taken.begin(), taken.end(), v) == taken.end())
        return v;
    }
    FAIL("no vertex " << tag);
    return VertexIndex{-1};
  };
  for (const auto& [type, origin] : registry.edges()) {
    for (int copy = 0; copy < 4; ++copy) {
      std::vector<VertexIndex> vertices;
      std::size_t numbers = static_cast<std::size_t>(type.field_size());
      Eigen::Index dimension = type.error_dimension;
      if (type.arity == EdgeType::kRuntimeArity) {
        for (VertexIndex v = 0; v <= copy; ++v) {
          vertices.push_back(v);
          dimension += graph.vertex_type(v).tangent_size;
          numbers +=
              static_cast<std::size_t>(graph.vertex_type(v).value_size + graph.vertex_type(v).tangent_size);
        }
      }
      for (const std::string& tag : type.vertex_tags) vertices.push_back(vertex_of(tag, vertices));
      graph.add_edge(type, vertices, hard_numbers(numbers, random), hard_information(dimension, random));
    }
  }
  std::size_t b = 0;
  for (const auto& [loss, origin] : registry.losses()) {
    graph.batch(b++ % graph.batch_count()).set_loss(1, Loss{loss.name, loss.evaluate, 0.1 + 0.2});
  }
  return document;
}

void check_bits(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]));
  }
}

}  // namespace

TEST_CASE("every type: text, document, text gives the same text") {
  const TypeRegistry registry = waymark_test::full_registry();
  const std::string once = write_graph(document_of_everything(registry), registry);
  CHECK(write_graph(read_graph(once, "memory", registry), registry) == once);
}

TEST_CASE("every type: all values, fields and information matrices come back bit by bit") {
  const TypeRegistry registry = waymark_test::full_registry();
  const GraphDocument document = document_of_everything(registry);
  const Graph& graph = document.graph;
  const GraphDocument again_document = read_graph(write_graph(document, registry), "memory", registry);
  const Graph& again = again_document.graph;
  check_bits(again.values(), graph.values());
  REQUIRE(again.vertex_count() == graph.vertex_count());
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    CHECK(again.id(v) == graph.id(v));
    CHECK(again.vertex_type(v).tag == graph.vertex_type(v).tag);
    CHECK(again.fixed(v) == graph.fixed(v));
    CHECK(again.stamp(v) == graph.stamp(v));
  }
  REQUIRE(again.batch_count() == graph.batch_count());
  REQUIRE(graph.batch_count() == registry.edges().size());
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    INFO(graph.edge_type(b).tag);
    CHECK(again.edge_type(b).tag == graph.edge_type(b).tag);
    REQUIRE(again.batch(b).size() == graph.batch(b).size());
    for (std::size_t e = 0; e < graph.batch(b).size(); ++e) {
      std::vector<double> expected;
      std::vector<double> got;
      graph.batch(b).fields(e, expected);
      again.batch(b).fields(e, got);
      check_bits(got, expected);
      CHECK(again.batch(b).information(e) == graph.batch(b).information(e));
      const Loss* loss = graph.batch(b).loss(e);
      const Loss* loss_again = again.batch(b).loss(e);
      REQUIRE((loss == nullptr) == (loss_again == nullptr));
      if (loss != nullptr) CHECK(*loss == *loss_again);
    }
  }
}

TEST_CASE("every edge type: its schema stands in the text, and a text with another schema is refused") {
  const TypeRegistry registry = waymark_test::full_registry();
  const std::string text = write_graph(document_of_everything(registry), registry);
  for (const auto& [type, origin] : registry.edges()) {
    const std::string line = "TYPE " + type.tag + " " + describe_schema(type) + "\n";
    INFO(line);
    REQUIRE(text.find(line) != std::string::npos);
    std::string changed = text;
    changed.replace(changed.find(line), line.size(), "TYPE " + type.tag + " vertices=* fields=other:1\n");
    CHECK_THROWS_WITH(read_graph(changed, "changed.graph", registry),
                      Catch::Contains(type.tag) && Catch::Contains("fields=other:1"));
  }
}
