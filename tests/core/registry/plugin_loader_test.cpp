// Plugins as modules: the same graph as built in; everything that can be wrong with a file is said before its
// code runs.
#include <cfenv>
#include <fstream>
#include <functional>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/plugin_loader.hpp>
#include <waymark/formats/graph/graph_document.hpp>

#include "support/paths.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"

namespace plugin_loader_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::solvers;
using namespace waymark_test;
using Catch::Contains;

namespace {

std::string module_file(const std::string& name) {
  return waymark_test::plugin_dir() + "/" + name + ".so";
}

/// Core, SE(2) and solvers only: everything else must come from modules.
TypeRegistry bare_registry() {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  register_solvers(registry);
  return registry;
}

std::string graph_text(const TypeRegistry& registry, const char* modeling) {
  Drive drive = make_drive(registry, 300, {0.5, 0.1});
  drive.add_fixes(registry, modeling);
  GraphDocument document;
  document.graph = std::move(drive.graph);
  return write_graph(document, registry);
}

int entered = 0;

LossValue half(double squared, double) {
  return {0.5 * squared, 0.5, 0};
}

PluginDescriptor sound_descriptor() {
  return describe_plugin("sample", "1.0");
}

void count_entry(TypeRegistry&) {
  ++entered;
}

}  // namespace

TEST_CASE("plugins: loaded as modules they give the same graph text as built in") {
  TypeRegistry loaded = bare_registry();
  for (const char* name : {"odometry", "gnss_g1", "gnss_g2", "gnss_g3"})
    load_plugin(module_file(name), loaded);
  const TypeRegistry built_in = full_registry();
  for (const char* modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    CHECK(graph_text(loaded, modeling) == graph_text(built_in, modeling));
  }
  for (const auto& [type, origin] : loaded.gnss_modelings()) CHECK(origin == "gnss_" + type.name);
}

TEST_CASE("plugins: loading leaves the floating-point environment as it was") {
  struct Upward {
    Upward() { std::fesetround(FE_UPWARD); }
    ~Upward() { std::fesetround(FE_TONEAREST); }  // also if loading throws
  };
  TypeRegistry registry = bare_registry();
  int rounding = 0;
  {
    const Upward upward;
    load_plugin(module_file("gnss_g1"), registry);
    rounding = std::fegetround();
  }
  CHECK(rounding == FE_UPWARD);
}

TEST_CASE("plugins: a file that is absent or no library is named") {
  TypeRegistry registry = bare_registry();
  CHECK_THROWS_AS(load_plugin("/nowhere/at_all.so", registry), UsageError);
  CHECK_THROWS_WITH(load_plugin("/nowhere/at_all.so", registry), Contains("at_all.so"));
  const std::string text = (scratch_dir() / "text.so").string();
  std::ofstream(text) << "not a library\n";
  CHECK_THROWS_WITH(load_plugin(text, registry), Contains("text.so"));
  // A bare name means a file here, not one of the system's library folders.
  CHECK_THROWS_AS(load_plugin("libm.so.6", registry), UsageError);
}

TEST_CASE(
    "plugins: a second registration of a name is refused, naming both origins, and leaves nothing behind") {
  TypeRegistry registry = full_registry();
  const std::size_t modelings = registry.gnss_modelings().size();
  CHECK_THROWS_WITH(load_plugin(module_file("gnss_g1"), registry),
                    Contains("plugin 'gnss_g1'") && Contains("gnss_g1.so") && Contains("(built in)") &&
                        Contains("load only one"));
  CHECK(registry.gnss_modelings().size() == modelings);

  TypeRegistry own = bare_registry();
  own.set_origin("somebody");
  own.add_gnss_modeling({"g1", "another", {}, {}});
  CHECK_THROWS_WITH(
      load_plugin(module_file("gnss_g1"), own),
      Contains("of gnss_g1") && Contains("already registered by somebody") && Contains("rename"));
}

TEST_CASE("plugins: a registration that fails half-way leaves no types behind") {
  const PluginEntry throws_error = [](TypeRegistry& extended) {
    extended.add_loss({"half", &half, ""});
    throw UsageError("out of paper");
  };
  TypeRegistry registry = bare_registry();
  CHECK_THROWS_WITH(enter_plugin(sound_descriptor(), throws_error, "sample.so", registry),
                    Contains("sample.so") && Contains("plugin 'sample'") && Contains("out of paper"));
  const PluginEntry throws_number = [](TypeRegistry& extended) {
    extended.add_loss({"half", &half, ""});
    throw 42;
  };
  CHECK_THROWS_WITH(enter_plugin(sound_descriptor(), throws_number, "sample.so", registry),
                    Contains("sample.so") && Contains("plugin 'sample'") && Contains("no std::exception"));
  CHECK(registry.find_loss("half") == nullptr);
  CHECK(registry.plugins().empty());
}

TEST_CASE("plugins: every difference of build is named with both values, and no code of the plugin runs") {
  struct Case {
    std::function<void(PluginDescriptor&)> spoil;
    const char* said;
  };
  const Case cases[] = {
      {[](PluginDescriptor& d) { d.magic = 1; }, "no waymark plugin"},
      {[](PluginDescriptor& d) { ++d.abi; }, "ABI"},
      {[](PluginDescriptor& d) { d.traits.compiler = 3 - d.traits.compiler; }, "compiler family"},
      {[](PluginDescriptor& d) { ++d.traits.standard_library; }, "standard library"},
      {[](PluginDescriptor& d) { ++d.traits.eigen_version; }, "Eigen version"},
      {[](PluginDescriptor& d) { d.traits.eigen_max_align *= 2; }, "alignment"},
      {[](PluginDescriptor& d) { d.traits.fast_math = 1; }, "-ffast-math"},
      {[](PluginDescriptor& d) { d.traits.debug_stl = 1; }, "_GLIBCXX_DEBUG"},
      {[](PluginDescriptor& d) { ++d.traits.layout; }, "size of types"},
  };
  entered = 0;
  TypeRegistry registry = bare_registry();
  for (const Case& wrong : cases) {
    PluginDescriptor descriptor = sound_descriptor();
    wrong.spoil(descriptor);
    INFO(wrong.said);
    CHECK_THROWS_WITH(enter_plugin(descriptor, count_entry, "dir/sample.so", registry),
                      Contains("dir/sample.so: ") && Contains(wrong.said));
  }
  CHECK(entered == 0);
  enter_plugin(sound_descriptor(), count_entry, "dir/sample.so", registry);
  CHECK(entered == 1);
}

TEST_CASE("registry: all tags and names are found again and belong to somebody") {
  const TypeRegistry registry = full_registry();
  for (const auto& [type, origin] : registry.edges()) {
    CHECK(registry.find_edge(type.tag) == &type);
    CHECK_FALSE(origin.empty());
    for (const std::string& tag : type.vertex_tags) CHECK(registry.find_vertex(tag) != nullptr);
  }
  CHECK(registry.find_edge("EDGE_NOBODY") == nullptr);
  CHECK(registry.find_vertex("VERTEX_NOBODY") == nullptr);
  CHECK(registry.find_loss("nobody") == nullptr);
}

namespace {

/// A point with a third number, under the tag of the registered one.
struct OtherXy : VertexXy {
  static constexpr int kValueSize = 3;
  static constexpr int kTangentSize = 3;
};

}  // namespace

TEST_CASE("registry: an edge that was compiled with another vertex type of the same tag is refused") {
  EdgeType edge = make_edge_type<EdgeSe2Xy>();
  REQUIRE(edge.vertex_sizes == std::vector<VertexSizes>{{3, 3}, {2, 2}});
  edge.tag = "EDGE_OTHER";
  edge.vertex_sizes[1] = {OtherXy::kValueSize, OtherXy::kTangentSize};
  const std::string told =
      "EDGE_OTHER was compiled with a VERTEX_XY of 3 numbers and 3 degrees of freedom, and here "
      "it has 2 and 2: two types have one tag; rename one of them, or build both with one header";
  TypeRegistry registry = bare_registry();
  CHECK_THROWS_WITH(registry.add_edge(edge), told);
  TypeRegistry edge_first;
  edge_first.add_edge(edge);
  CHECK_THROWS_WITH(edge_first.add_vertex(make_vertex_type<VertexXy>()), told);
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  graph.add_vertex<VertexXy>(VertexId{1}, {1, 0});
  const std::array<VertexIndex, 2> vertices = {0, 1};
  const std::array<double, 2> fields = {1, 0};
  CHECK_THROWS_WITH(graph.add_edge(edge, vertices, fields, Eigen::Matrix2d::Identity()), told);
}

TEST_CASE("registry: what a .graph file could not tell again, and what cannot be called, is refused") {
  TypeRegistry registry = bare_registry();
  const auto with = [](auto change) {
    EdgeType edge = make_edge_type<EdgeSe2Xy>();
    edge.tag = "EDGE_OWN";
    change(edge);
    return edge;
  };
  CHECK_THROWS_WITH(registry.add_edge(with([](EdgeType& e) { e.tag = "FIX"; })),
                    Contains("statement of .graph files"));
  CHECK_THROWS_WITH(registry.add_edge(with([](EdgeType& e) { e.form = "a\nb"; })),
                    Contains("control character"));
  CHECK_THROWS_WITH(registry.add_edge(with([](EdgeType& e) { e.fields[0].name = "my z,:"; })),
                    Contains("no word"));
  CHECK_THROWS_WITH(registry.add_edge(with([](EdgeType& e) { e.fields.push_back(e.fields[0]); })),
                    Contains("two of its fields"));
  CHECK_THROWS_WITH(registry.add_loss({"mine", nullptr, ""}), Contains("has no function"));
  CHECK_THROWS_WITH(registry.add_log_reader({"mine", ""}), Contains("has no reader"));
  CHECK_NOTHROW(registry.add_edge(with([](EdgeType&) {})));
}

}  // namespace plugin_loader_test
