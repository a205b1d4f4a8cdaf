/// What the format tests share.
#pragma once

#include <string>

#include <waymark/core/registry.hpp>
#include <waymark/formats/foreign_graph.hpp>
#include <waymark/formats/graph_document.hpp>

/// Core, SE(2) and the built-in plugins: the types that the program knows.
[[nodiscard]] const waymark::TypeRegistry& test_registry();

[[nodiscard]] inline waymark::GraphDocument read(const std::string& text) {
  return waymark::read_graph(text, "test.graph", test_registry());
}

[[nodiscard]] inline std::string write(const waymark::GraphDocument& document) {
  return waymark::write_graph(document, test_registry());
}

/// The text of a format that is not our own, for any reader of it.
[[nodiscard]] inline std::string write_as(waymark::GraphFormat format,
                                          const waymark::GraphDocument& document) {
  return waymark::collect_text([&](const waymark::TextSink& sink) {
    waymark::ForeignGraph(document, "test.graph", waymark::any_reader(format), format).write(sink);
  });
}
