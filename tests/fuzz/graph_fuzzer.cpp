// A graph file of one format. The first byte: bit 0 reads leniently; the rest is the file.
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/finite_check.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/types_se2/register.hpp>

#include "invariants.hpp"
#include "targets.hpp"

namespace waymark_fuzz {
namespace {

using namespace waymark;
using formats::GraphFormat;

TypeRegistry graph_registry() {
  TypeRegistry registry;
  register_core_types(registry);
  register_se2_types(registry);
  plugins::register_builtin_plugins(registry);
  return registry;
}

/// What is written in our own format must be read again as the same.
void check_round_trip(const formats::GraphDocument& document, const TypeRegistry& registry) {
  const std::string once = formats::write_graph(document, registry);
  const std::string twice = formats::write_graph(formats::read_graph(once, "again", registry), registry);
  if (once != twice) broken("what was written is read as another graph:\n" + once + "\n" + twice);
}

/// Other formats may refuse a graph; what they write has only finite numbers, and is read again.
void check_other_formats(const formats::GraphDocument& document, const TypeRegistry& registry) {
  for (const GraphFormat format : {GraphFormat::g2o, GraphFormat::toro, GraphFormat::covariance}) {
    std::string text;
    try {
      formats::write_graph_as(format, document, "fuzz", [&](std::string_view piece) { text += piece; });
    } catch (const InputError&) {
      continue;
    } catch (const OutputError&) {
      continue;
    }
    if (text.find("inf") != std::string::npos || text.find("nan") != std::string::npos)
      broken("not finite: " + text);
    try {
      (void)formats::read_graph_as(format, text, "again", registry);
    } catch (const InputError& error) {
      // a covariance as small as that has no finite inverse, and an edge may measure nothing
      const std::string_view why = error.what();
      if (why.find("not positive definite") == std::string_view::npos &&
          why.find("matrix is zero") == std::string_view::npos &&
          why.find("indefinite") == std::string_view::npos)
        broken(std::string("what was written as ") + std::string(to_string(format)) +
               " is refused: " + error.what() + "\n" + text);
    }
  }
}

}  // namespace

void fuzz_graph(std::string_view name, const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return;
  static const TypeRegistry registry = graph_registry();
  const std::string text(reinterpret_cast<const char*>(bytes) + 1, size - 1);
  try {
    formats::ReadReport report;
    const formats::GraphDocument document = formats::read_graph_as(
        *formats::graph_format_from_string(name), text, "fuzz", registry, (bytes[0] & 1U) != 0, &report);
    for (const double value : document.graph.values())
      if (!std::isfinite(value)) broken("a value that is not finite was read");
    (void)find_not_finite(document.graph);
    check_round_trip(document, registry);
    check_other_formats(document, registry);
  } catch (const InputError&) {
    // refused
  }
}

}  // namespace waymark_fuzz
