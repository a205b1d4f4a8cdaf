/// Helpers that the format tests share.
#pragma once

#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/formats/graph/detail/foreign_graph.hpp>
#include <waymark/formats/graph/graph_document.hpp>

/// Returns the types that the program knows: core, SE(2) and the built-in plugins.
[[nodiscard]] const waymark::TypeRegistry& test_registry();

[[nodiscard]] inline waymark::formats::GraphDocument read(const std::string& text) {
  return waymark::formats::read_graph(text, "test.graph", test_registry());
}

[[nodiscard]] inline std::string write(const waymark::formats::GraphDocument& document) {
  return waymark::formats::write_graph(document, test_registry());
}

/// Returns the text of a format that is not our own, for any reader of it.
[[nodiscard]] inline std::string write_as(waymark::formats::GraphFormat format,
                                          const waymark::formats::GraphDocument& document) {
  return waymark::formats::collect_text([&](const waymark::formats::TextSink& sink) {
    waymark::formats::ForeignGraph(document, "test.graph", waymark::formats::any_reader(format), format)
        .write(sink);
  });
}
