#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/text/detail/text_builder.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/graph/robust.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

struct LossRequest {
  std::string tag;  // empty: edges of all types
  Loss loss;
};

void require_edge(const TypeRegistry& registry, const std::string& tag, const std::string& option) {
  if (registry.find_edge(tag) != nullptr) return;
  std::vector<std::string_view> tags;
  for (const auto& [type, origin] : registry.edges()) tags.push_back(type.tag);
  throw UsageError(option + ": unknown edge type '" + tag + "'" + suggestion(tag, tags));
}

// Reads [TAG=]NAME:SCALE.
LossRequest parse_loss(const std::string& text, const TypeRegistry& registry) {
  LossRequest request;
  const auto equals = text.find('=');
  if (equals != std::string::npos) {
    request.tag = text.substr(0, equals);
    require_edge(registry, request.tag, "--loss");
  }
  request.loss =
      drive::named_loss(equals == std::string::npos ? text : text.substr(equals + 1), "--loss", registry);
  return request;
}

TrustRule trust_rule(const RobustChoice& choice) {
  if (choice.trusted == "odometry") return &odometry_edges;
  if (choice.trusted == "none") return [](const Graph&) { return std::vector<EdgePlace>(); };
  return trust_each([tag = choice.trusted](const Graph& graph, EdgePlace place) {
    return graph.edge_type(place.batch).tag == tag;
  });
}

void describe(const Graph& graph, EdgePlace place, formats::TextBuilder& lines,
              nlohmann::ordered_json& list) {
  const EdgeBatchBase& batch = graph.batch(place.batch);
  const EdgeType& type = graph.edge_type(place.batch);
  const auto vertices = batch.vertices(place.edge);
  nlohmann::ordered_json ids = nlohmann::ordered_json::array();
  lines.word(type.tag);
  if (type.arity == EdgeType::kRuntimeArity) lines.integer(static_cast<std::int64_t>(vertices.size()));
  for (const VertexIndex v : vertices) {
    lines.integer(to_number(graph.id(v)));
    ids.push_back(to_number(graph.id(v)));
  }
  std::vector<double> fields;
  batch.fields(place.edge, fields);
  for (const double value : fields) lines.number(value);
  const Eigen::MatrixXd information = batch.information(place.edge);
  for (Eigen::Index row = 0; row < information.rows(); ++row) {
    for (Eigen::Index column = row; column < information.cols(); ++column) {
      lines.number(information(row, column));
    }
  }
  lines.end_line();
  list.push_back({{"type", type.tag}, {"vertices", std::move(ids)}});
}

/// Returns tag and ids.
std::string name_of(const Graph& graph, EdgePlace place) {
  std::string name = graph.edge_type(place.batch).tag;
  for (const VertexIndex v : graph.batch(place.batch).vertices(place.edge))
    name += " " + to_string(graph.id(v));
  return name;
}

}  // namespace

void add_robust_options(CLI::App& command, RobustChoice& choice) {
  const OptionHeading heading(command, "Outliers");
  command
      .add_option("--loss", choice.losses, "Robust loss of all edges that are not trusted, or of one type")
      ->type_name("[TAG=]LOSS:SCALE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--robust", choice.method,
                  "Look for outliers by graduated non-convexity, and leave them out of the result")
      ->check(one_of("method", {"none", "gnc"}))
      ->capture_default_str();
  command
      .add_option("--trusted", choice.trusted,
                  "Edges that have no loss and are no outliers: odometry (a chain along the ids, unless the "
                  "others contradict it), none, or all edges of a TAG")
      ->type_name("odometry|none|TAG")
      ->capture_default_str();
  command
      .add_option("--outliers", choice.outliers,
                  "File for the outliers, one edge per line ('-': standard output)")
      ->type_name("FILE");
}

void check_robust(const RobustChoice& choice, const TypeRegistry& registry) {
  for (const std::string& text : choice.losses) {
    const LossRequest request = parse_loss(text, registry);
    if (choice.method == "gnc" && (!request.tag.empty() || choice.losses.size() > 1)) {
      throw UsageError("--robust gnc takes one loss for all edges: --loss NAME:SCALE");
    }
  }
  if (choice.trusted != "odometry" && choice.trusted != "none") {
    require_edge(registry, choice.trusted, "--trusted");
  }
  if (choice.outliers.empty()) return;
  if (choice.method == "none") throw UsageError("--outliers needs --robust gnc, which looks for them");
  require_output_place(choice.outliers);
}

void attach_losses(Graph& graph, const RobustChoice& choice, const TypeRegistry& registry) {
  if (choice.method != "none" || choice.losses.empty()) return;
  const std::vector<EdgePlace> trusted = trust_rule(choice)(graph);
  for (const std::string& text : choice.losses) {
    const LossRequest request = parse_loss(text, registry);
    for (std::size_t b = 0; b < graph.batch_count(); ++b) {
      if (!request.tag.empty() && graph.edge_type(b).tag != request.tag) continue;
      for (std::size_t e = 0; e < graph.batch(b).size(); ++e) {
        if (!std::binary_search(trusted.begin(), trusted.end(), EdgePlace{b, e}))
          graph.batch(b).set_loss(e, request.loss);
      }
    }
  }
}

namespace {

/// Adds a note for each edge, and one for all if they are many.
/// @param one holds the name of the edge @param many their number and the name of the first one
void add_each(const Graph& graph, const std::vector<EdgePlace>& edges, fmt::format_string<std::string> one,
              fmt::format_string<std::size_t, std::string> many, std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 3;
  if (edges.size() > kMost) {
    notes.push_back(fmt::format(many, edges.size(), name_of(graph, edges.front())));
    return;
  }
  for (const EdgePlace place : edges) notes.push_back(fmt::format(one, name_of(graph, place)));
}

/// Tells whether edges join vertices of one type, as odometry does.
bool joins_like_vertices(const Graph& graph) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const std::vector<std::string>& tags = graph.edge_type(b).vertex_tags;
    if (graph.batch(b).size() > 0 && tags.size() == 2 && tags[0] == tags[1]) return true;
  }
  return false;
}

}  // namespace

Minimizer graduating_minimizer(const RobustChoice& choice, const TypeRegistry& registry,
                               std::optional<Graduated>& found) {
  GraduationOptions options;
  if (!choice.losses.empty()) options.loss = parse_loss(choice.losses.front(), registry).loss;
  options.trusted = trust_rule(choice);
  const bool by_ids = choice.trusted == "odometry";
  options.doubts_trusted = by_ids;  // a guess, where a tag is the user's word
  return [options, by_ids, &found](Graph& graph, Algorithm& algorithm, LinearSolver& solver,
                                   const OptimizerOptions& optimizer) mutable {
    options.optimizer = optimizer;
    found.emplace();
    found->result = graduate(graph, algorithm, solver, options);
    found->outlier_lines = formats::collect_text([&](const formats::TextSink& sink) {
      formats::TextBuilder lines(sink);
      for (const EdgePlace place : found->result.outliers) {
        describe(graph, place, lines, found->outlier_edges);
      }
      lines.finish();
    });
    add_each(
        graph, found->result.distrusted,
        "{} contradicts the other edges and is left out, although it is trusted",
        "{} edges contradict the others and are left out, although they are trusted: {} and others (--outliers lists them)",
        found->notes);
    if (by_ids && found->result.trusted == 0 && joins_like_vertices(graph))
      found->notes.push_back(
          "no edge is trusted as odometry, because no chain of edges follows the ids of the vertices; what is found "
          "without it is less sure: give ids in the order of the drive, or the edges of the drive a type of their "
          "own that --trusted TAG names");
    if (const auto& edges = found->result.contradicted; !edges.empty())
      found->notes.push_back(fmt::format(
          "{} trusted edges contradict the other edges, and the result with them: {}{}; --trusted none doubts them",
          edges.size(), name_of(graph, edges.front()), edges.size() > 1 ? " and others" : ""));
    add_each(
        graph, found->result.unconfirmed,
        "{} alone joins two parts of the graph, and others that would join them elsewhere are left out: nothing "
        "confirms where these parts are to each other",
        "{} edges each alone join two parts of the graph, and others that would join them elsewhere are left out: "
        "nothing confirms where these parts are to each other. If no edge of this graph is false, edges "
        "such as {} claim too much: their information is too large",
        found->notes);
    graph = without_edges(graph, found->result.outliers);
    return found->result.summary;
  };
}

std::string graduation_text(const GraduationResult& r) {
  return fmt::format(
      "outliers    {} of {} edges that are not trusted (gnc: {} rounds, {} splits, {} iterations, {:.3f} "
      "s)\n",
      r.outliers.size(), r.candidates, r.rounds, r.passes, r.iterations, r.seconds);
}

nlohmann::ordered_json graduation_json(const Graduated& graduated) {
  const GraduationResult& r = graduated.result;
  return {{"candidates", r.candidates},
          {"outliers", r.outliers.size()},
          {"rounds", r.rounds},
          {"splits", r.passes},
          {"iterations", r.iterations},
          {"seconds", r.seconds},
          {"outlier_edges", graduated.outlier_edges}};
}

}  // namespace waymark::program
