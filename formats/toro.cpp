#include <array>

#include <waymark/core/error.hpp>
#include <waymark/formats/graph_records.hpp>
#include <waymark/formats/line_scanner.hpp>
#include <waymark/formats/toro.hpp>

namespace waymark {
namespace {

constexpr std::string_view kVertex = "VERTEX2";
constexpr std::string_view kEdge = "EDGE2";

template <typename Visit>
void for_each_line(std::string_view text, const std::string& name, Visit visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    LineScanner line(text.substr(0, end), name, number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const std::string_view tag = line.word();
    if (!tag.empty() && tag.front() != '#') visit(line, tag);
  }
}

void read_vertex(LineScanner& line, const VertexType& type, Graph& graph) {
  const VertexId id = line.integer({kVertex, "id"});
  if (graph.find(id)) line.fail("VERTEX2: vertex " + std::to_string(id) + " is defined a second time");
  std::array<double, 3> pose{};
  for (std::size_t k = 0; k < 3; ++k) pose[k] = line.number({kVertex, "pose", static_cast<int>(k)});
  line.end(kVertex);
  graph.add_vertex(type, id, pose);
}

VertexIndex read_end(LineScanner& line, const Graph& graph) {
  const VertexId id = line.integer({kEdge, "vertex"});
  const auto found = graph.find(id);
  if (!found) line.fail("EDGE2: vertex " + std::to_string(id) + " is not defined");
  return *found;
}

void read_edge(LineScanner& line, const EdgeType& type, Graph& graph) {
  const VertexIndex from = read_end(line, graph);
  const std::array<VertexIndex, 2> vertices = {from, read_end(line, graph)};
  std::array<double, 3> measured{};
  for (std::size_t k = 0; k < 3; ++k) measured[k] = line.number({kEdge, "measured", static_cast<int>(k)});
  // Row and column of TORO's six numbers.
  constexpr std::array<std::array<int, 2>, 6> kOrder = {{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}};
  Eigen::MatrixXd information(3, 3);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [row, column] = kOrder[k];
    information(row, column) = information(column, row) =
        line.number({kEdge, "information", static_cast<int>(k)});
  }
  line.end(kEdge);
  if (!is_positive_semidefinite(information)) {
    line.fail("EDGE2: the information matrix is indefinite (an eigenvalue below -1e-9 of the largest)");
  }
  try {
    graph.add_edge(type, vertices, measured, information);
  } catch (const UsageError& error) {
    line.fail(error.what());
  }
}

}  // namespace

GraphDocument read_toro(std::string_view text, const std::string& name, const TypeRegistry& registry) {
  const VertexType* vertex = registry.find_vertex("VERTEX_SE2");
  const EdgeType* edge = registry.find_edge("EDGE_SE2");
  if (vertex == nullptr || edge == nullptr) {
    throw UsageError("TORO files need the registered types VERTEX_SE2 and EDGE_SE2");
  }
  GraphDocument document;
  for_each_line(text, name, [&](LineScanner& line, std::string_view tag) {
    if (tag == kVertex) read_vertex(line, *vertex, document.graph);
  });
  for_each_line(text, name, [&](LineScanner& line, std::string_view tag) {
    if (tag == kEdge) return read_edge(line, *edge, document.graph);
    if (tag != kVertex) line.fail("unknown tag " + quote_word(tag) + "; a TORO file has VERTEX2 and EDGE2");
  });
  if (document.graph.vertex_count() == 0) throw InputError(name + ": no vertices in it");
  return document;
}

}  // namespace waymark
