#include <waymark/core/registry/detail/graph_statements.hpp>
#include <waymark/formats/graph/graph_text.hpp>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/detail/own_tags.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>
#include <waymark/formats/text/text_file.hpp>

namespace waymark::formats {
namespace {

using waymark::detail::kGraphStatements;

bool is_known(std::string_view tag, const TypeRegistry& registry) {
  const auto is_among = [tag](const auto& tags) {
    return std::find(std::begin(tags), std::end(tags), tag) != std::end(tags);
  };
  return registry.find_vertex(tag) != nullptr || registry.find_edge(tag) != nullptr ||
         is_among(kGraphStatements) || is_among(kToroTags) || is_of_space(tag) || tag == "FIX" ||
         tag == "PARAMS_SE2OFFSET";
}

/// Tells whether a line that begins within a piece of a graph begins with a known tag.
bool has_known_tag(std::string_view piece, const TypeRegistry& registry, const std::string& path) {
  for (std::size_t begin = 0; begin < piece.size();) {
    const std::size_t end = std::min(piece.find('\n', begin), piece.size());
    if (is_known(LineScanner(piece.substr(begin, end - begin), path, 1).word(), registry)) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::string read_graph_text(const std::string& path, const TypeRegistry& registry) {
  std::size_t read = 0;
  return read_text_file(
      path, {.check = [&](std::string_view piece) {
        if (!has_known_tag(piece, registry, path))
          throw InputError(
              fmt::format("{}: no line with a known tag from byte {} to {}; this is no graph, and it may "
                          "never end",
                          path, read + 1, read + piece.size()));
        read += piece.size();
      }});
}

}  // namespace waymark::formats
