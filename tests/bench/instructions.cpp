// Steps of an optimisation, each marked for callgrind: see README.md, "Instructions".
//   waymark_instructions [--modules FOLDER] drive|grid|FILE SOLVER...
// With --modules the plugins are loaded from there instead of those built in.
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include <valgrind/callgrind.h>

#include <waymark/core/registry/plugin_loader.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/normal_equations.hpp>
#include <waymark/formats/graph/graph_document.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::solvers;

namespace {

/// Runs `work` twice, the second time counted, and leaves the count in a file of callgrind's named after it.
template <typename Work>
void count(const std::string& name, std::size_t units, const char* unit, const Work& work) {
  work();
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_TOGGLE_COLLECT;
  work();
  CALLGRIND_TOGGLE_COLLECT;
  CALLGRIND_STOP_INSTRUMENTATION;
  const std::string label = name + " " + std::to_string(units) + " " + unit;
  CALLGRIND_DUMP_STATS_AT(label.c_str());
}

TypeRegistry registry_with_modules(const std::string& folder) {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  register_solvers(registry);
  for (const char* name : {"odometry", "gnss_g1"}) load_plugin(folder + "/" + name + ".so", registry);
  return registry;
}

Graph make_problem(const std::string& name, const TypeRegistry& registry) {
  if (name == "grid") return waymark_test::grid_walk(20'000, static_cast<int>(std::sqrt(20'000.0)));
  if (name == "drive") {
    waymark_test::Drive drive = waymark_test::make_drive(registry, 105'000);
    drive.add_fixes(registry, "g1");
    return std::move(drive.graph);
  }
  std::ifstream file(name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return read_graph(text.str(), name, registry).graph;
}

}  // namespace

int main(int argc, char** argv) {
  const bool with_modules = argc > 3 && std::string_view(argv[1]) == "--modules";
  const int first = with_modules ? 3 : 1;
  if (argc <= first) {
    std::cerr << "usage: waymark_instructions [--modules FOLDER] drive|grid|FILE SOLVER...\n";
    return 2;
  }
  const TypeRegistry registry = with_modules ? registry_with_modules(argv[2]) : waymark_test::full_registry();
  GraphDocument document;
  document.graph = make_problem(argv[first], registry);
  const Graph& graph = document.graph;
  const std::size_t edges = graph.edge_count();
  const std::size_t poses = graph.vertex_count();
  const std::string text = write_graph(document, registry);
  double sum = 0;  // of results, so that nothing is left out

  count("read", edges + poses, "line",
        [&] { sum += read_graph(text, "problem.graph", registry).graph.chi2(); });
  count("gauge", edges, "edge", [&] { sum += static_cast<double>(find_gauge(graph).held.size()); });
  const std::vector<char> held = find_gauge(graph).held;
  Structure structure;
  count("structure", edges, "edge", [&] { structure.build(graph, held); });
  NormalEquations equations(graph, structure);
  count("linearize", edges, "edge", [&] { sum += equations.linearize(graph.values()); });
  count("chi2", edges, "edge", [&] { sum += equations.chi2(graph.values()); });
  for (int i = first + 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto solver = registry.make_linear_solver(name);
    count(name + "_analyze", poses, "pose", [&] { solver->analyze(structure.pattern()); });
    count(name + "_factorize", poses, "pose", [&] {
      if (solver->factorize(equations.hessian()) != FactorStatus::ok) sum = std::nan("");
    });
    Eigen::VectorXd x = equations.gradient();
    const std::span<const double> b(equations.gradient().data(), static_cast<std::size_t>(x.size()));
    count(name + "_solve", poses, "pose", [&] { solver->solve(b, {x.data(), b.size()}); });
    sum += x.sum();
  }
  std::cout << "checksum " << sum << '\n';
  return std::isfinite(sum) ? 0 : 1;
}
