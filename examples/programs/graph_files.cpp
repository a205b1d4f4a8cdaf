// A graph file in, its optimum out: in our own format, and for g2o.
//   example_graph_files IN.graph OUT.graph OUT.g2o        without arguments: a small graph, in the current folder
#include <cstdio>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/solvers/register.hpp>
#include <waymark/types_se2/register.hpp>

using namespace waymark;

namespace {

constexpr const char* kTriangle =
    "GRAPH 1\n"
    "VERTEX_SE2 1 0 0 0\n"
    "VERTEX_SE2 2 1.1 0.1 2.0\n"
    "VERTEX_SE2 3 0.4 0.9 -2.2\n"
    "FIX 1\n"
    "EDGE_SE2 1 2 1 0 2.0943951 100 0 0 100 0 1000\n"
    "EDGE_SE2 2 3 1 0 2.0943951 100 0 0 100 0 1000\n"
    "EDGE_SE2 3 1 1.03 0 2.0943951 100 0 0 100 0 1000\n";

}  // namespace

int main(int count, char** words) {
  const bool given = count == 4;
  const std::string in = given ? words[1] : "triangle.graph";
  const std::string out = given ? words[2] : "triangle.optimum.graph";
  const std::string g2o = given ? words[3] : "triangle.optimum.g2o";
  TypeRegistry registry;  // the types that files may hold, and what optimises them
  register_core_types(registry);
  register_se2_types(registry);
  solvers::register_solvers(registry);
  try {
    if (!given) formats::write_file_atomically(in, kTriangle);
    formats::GraphDocument document = formats::read_graph(formats::read_text_file(in), in, registry);
    const MultiStartSummary summary = optimize(document.graph, registry);
    std::printf("%s", summary.full().c_str());
    document.provenance.emplace_back("optimized", "example_graph_files");
    formats::write_file_atomically(out, formats::write_graph(document, registry));
    formats::write_file_atomically(g2o, [&](const formats::TextSink& sink) {
      formats::write_graph_as(formats::GraphFormat::g2o, document, in, sink);
    });

    // What was written reads back as the same minimum.
    for (const std::string& file : {out, g2o}) {
      const formats::GraphDocument again = formats::read_graph(formats::read_text_file(file), file, registry);
      std::printf("%s: chi2 %.6g\n", file.c_str(), again.graph.chi2());
      if (again.graph.values() != document.graph.values()) return 1;
    }
    return summary.converged() ? 0 : 1;
  } catch (const Error& error) {  // what is wrong, with file, line and column
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
