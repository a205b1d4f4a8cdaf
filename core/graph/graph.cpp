#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {
namespace {

constexpr Stamp kNoStamp{std::numeric_limits<std::int64_t>::min()};

}  // namespace

VertexIndex VertexIds::find_in_map(VertexId id) const {
  const auto found = map_.find(id);
  return found == map_.end() ? -1 : found->second;
}

void VertexIds::insert(VertexId id, VertexIndex index) {
  if (in_array(id)) {
    const auto place = static_cast<std::size_t>(to_number(id) - first_);
    if (place >= array_.size()) array_.resize(std::max(place + 1, array_.size() * 2), -1);
    array_[place] = index;
  } else {
    map_.insert_or_assign(id, index);
  }
}

void VertexIds::erase(VertexId id) {
  if (in_array(id)) {
    array_[static_cast<std::size_t>(to_number(id) - first_)] = -1;
    ++erased_;
    follow_ids();
  } else {
    map_.erase(id);
  }
}

// In a sliding window only few of the older ids stay in use: they move to the map.
void VertexIds::follow_ids() {
  constexpr std::size_t kWorthIt = 4096;
  constexpr std::ptrdiff_t kFew = 64;
  if (erased_ < std::max(kWorthIt, array_.size() / 2)) return;
  erased_ = 0;
  const auto half = static_cast<std::ptrdiff_t>(array_.size() / 2);
  const auto used =
      std::count_if(array_.begin(), array_.begin() + half, [](VertexIndex v) { return v >= 0; });
  if (used > kFew) return;
  std::vector<std::pair<VertexId, VertexIndex>> moved(map_.begin(), map_.end());
  for (std::ptrdiff_t place = 0; place < half; ++place) {
    const VertexIndex index = array_[static_cast<std::size_t>(place)];
    if (index >= 0) moved.emplace_back(VertexId{first_ + place}, index);
  }
  array_.erase(array_.begin(), array_.begin() + half);
  first_ += half;
  map_.clear();
  for (const auto& [id, index] : moved) insert(id, index);
}

Graph::Graph(const Graph& other)
    : vertex_types_(other.vertex_types_),
      ids_(other.ids_),
      type_of_(other.type_of_),
      offsets_(other.offsets_),
      values_(other.values_),
      fixed_(other.fixed_),
      stamps_(other.stamps_),
      by_id_(other.by_id_),
      free_id_(other.free_id_),
      structure_version_(other.structure_version_) {
  for (const Batch& batch : other.batches_) batches_.push_back({batch.type, batch.edges->clone()});
}

Graph& Graph::operator=(const Graph& other) {
  if (this != &other) *this = Graph(other);
  return *this;
}

std::size_t Graph::register_type(const VertexType& type) {
  // A vertex usually follows another one of its type.
  if (!type_of_.empty() && vertex_types_[type_of_.back()].tag == type.tag) return type_of_.back();
  for (std::size_t t = 0; t < vertex_types_.size(); ++t) {
    if (vertex_types_[t].tag == type.tag) return t;
  }
  vertex_types_.push_back(type);
  return vertex_types_.size() - 1;
}

VertexIndex Graph::add_vertex(const VertexType& type, VertexId id, std::span<const double> value) {
  if (by_id_.find(id) >= 0) throw UsageError("vertex " + to_string(id) + " exists already");
  if (value.size() != static_cast<std::size_t>(type.value_size)) {
    throw UsageError(type.tag + " " + to_string(id) + ": expected " + std::to_string(type.value_size) +
                     " values, got " + std::to_string(value.size()));
  }
  const auto v = static_cast<VertexIndex>(ids_.size());
  type_of_.push_back(static_cast<std::uint16_t>(register_type(type)));
  ids_.push_back(id);
  offsets_.push_back(static_cast<std::int64_t>(values_.size()));
  values_.insert(values_.end(), value.begin(), value.end());
  fixed_.push_back(0);
  if (!stamps_.empty()) stamps_.push_back(kNoStamp);
  by_id_.insert(id, v);
  constexpr VertexId kLargest{std::numeric_limits<std::int64_t>::max()};
  if (id >= free_id_ && id < kLargest) free_id_ = VertexId{to_number(id) + 1};
  ++structure_version_;
  return v;
}

void Graph::set_value(VertexIndex v, std::span<const double> value) {
  if (value.size() != static_cast<std::size_t>(vertex_type(v).value_size)) {
    throw UsageError(vertex_type(v).tag + " " + to_string(id(v)) + ": wrong number of values");
  }
  std::copy(value.begin(), value.end(), values_.begin() + offsets_[index(v)]);
}

void Graph::set_fixed(VertexIndex v, bool fixed) {
  fixed_[index(v)] = fixed;
  ++structure_version_;
}

void Graph::set_stamp(VertexIndex v, Stamp stamp) {
  if (stamps_.empty()) stamps_.assign(ids_.size(), kNoStamp);
  stamps_[index(v)] = stamp;
}

std::optional<Stamp> Graph::stamp(VertexIndex v) const {
  if (stamps_.empty() || stamps_[index(v)] == kNoStamp) return std::nullopt;
  return stamps_[index(v)];
}

void Graph::set_values(std::vector<double> values) {
  if (values.size() != values_.size()) throw UsageError("set_values: the snapshot is of another graph");
  values_ = std::move(values);
}

Removal Graph::remove_vertices(std::span<const char> gone) {
  if (gone.size() != ids_.size()) throw UsageError("remove_vertices: one mark per vertex is needed");
  Removal removal;
  removal.new_index.reserve(ids_.size());
  std::size_t kept = 0;
  std::int64_t numbers = 0;
  for (std::size_t v = 0; v < ids_.size(); ++v) {
    if (gone[v] != 0) {
      by_id_.erase(ids_[v]);
      removal.new_index.push_back(-1);
      continue;
    }
    const auto now = static_cast<VertexIndex>(kept);
    removal.new_index.push_back(now);
    by_id_.insert(ids_[v], now);
    const std::span<const double> from = value(static_cast<VertexIndex>(v));
    std::copy(from.begin(), from.end(), values_.begin() + numbers);
    offsets_[kept] = numbers;
    numbers += static_cast<std::int64_t>(from.size());
    ids_[kept] = ids_[v];
    type_of_[kept] = type_of_[v];
    fixed_[kept] = fixed_[v];
    if (!stamps_.empty()) stamps_[kept] = stamps_[v];
    ++kept;
  }
  ids_.resize(kept);
  type_of_.resize(kept);
  offsets_.resize(kept);
  fixed_.resize(kept);
  if (!stamps_.empty()) stamps_.resize(kept);
  values_.resize(static_cast<std::size_t>(numbers));
  for (const Batch& batch : batches_) {
    std::vector<char>& gone_edges = removal.gone_edges.emplace_back();
    gone_edges.reserve(batch.edges->size());
    for_each_edge(*batch.edges, [&](std::span<const VertexIndex> vertices) {
      gone_edges.push_back(
          std::any_of(vertices.begin(), vertices.end(), [&](VertexIndex v) { return gone[index(v)] != 0; }));
    });
    batch.edges->remove(gone_edges, removal.new_index);
    removal.kept_edges.push_back(batch.edges->size());
  }
  ++structure_version_;
  return removal;
}

std::size_t Graph::batch_of(const EdgeType& type) {
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    if (batches_[b].type.tag == type.tag) return b;
  }
  batches_.push_back({type, type.make_batch()});
  return batches_.size() - 1;
}

EdgeBatchBase& Graph::batch(const EdgeType& type) {
  return *batches_[batch_of(type)].edges;
}

std::size_t Graph::edge_count() const {
  std::size_t count = 0;
  for (const Batch& batch : batches_) count += batch.edges->size();
  return count;
}

std::vector<const VertexType*> Graph::types_of(std::span<const VertexIndex> vertices) const {
  std::vector<const VertexType*> types;
  for (const VertexIndex v : vertices) types.push_back(&vertex_type(v));
  return types;
}

void Graph::check_type(VertexIndex v, std::string_view tag) const {
  if (vertex_type(v).tag == tag) return;
  throw UsageError("vertex " + to_string(id(v)) + " is a " + vertex_type(v).tag + ", not a " +
                   std::string(tag));
}

void check_sizes(const EdgeType& edge, std::size_t k, const VertexType& vertex) {
  const VertexSizes& compiled = edge.vertex_sizes[k];
  if (compiled == VertexSizes{vertex.value_size, vertex.tangent_size}) return;
  throw UsageError(edge.tag + " was compiled with a " + vertex.tag + " of " + std::to_string(compiled.value) +
                   " numbers and " + std::to_string(compiled.tangent) +
                   " degrees of freedom, and here it has " + std::to_string(vertex.value_size) + " and " +
                   std::to_string(vertex.tangent_size) +
                   ": two types have one tag; rename one of them, or build both with one header");
}

void Graph::check_vertices(const EdgeType& type, std::span<const VertexIndex> vertices) const {
  const auto n = vertices.size();
  if (type.arity != EdgeType::kRuntimeArity && n != static_cast<std::size_t>(type.arity)) {
    throw UsageError(type.tag + ": expected " + std::to_string(type.arity) + " vertices, got " +
                     std::to_string(n));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const VertexIndex v = vertices[k];
    if (v < 0 || index(v) >= ids_.size()) throw UsageError(type.tag + ": a vertex that is not in the graph");
    if (type.arity != EdgeType::kRuntimeArity && vertex_type(v).tag != type.vertex_tags[k]) {
      throw UsageError(type.tag + ": vertex " + to_string(id(v)) + " is a " + vertex_type(v).tag +
                       ", expected a " + type.vertex_tags[k]);
    }
    if (!type.vertex_sizes.empty()) check_sizes(type, k, vertex_type(v));
    for (std::size_t l = 0; l < k; ++l) {
      if (vertices[l] == v) throw UsageError(type.tag + ": vertex " + to_string(id(v)) + " is named twice");
    }
  }
}

/// A caller who fills the upper triangle alone would lose it without a word.
void Graph::check_triangles(const EdgeType& type, const double* information) {
  constexpr double kRounding = 1e-6;  // of an inverse, beside the diagonal
  const int n = type.error_dimension;
  for (int c = 0; c < n; ++c) {
    for (int r = c + 1; r < n; ++r) {
      const double lower = information[c * n + r];
      const double upper = information[r * n + c];
      if (upper == 0 || upper == lower) continue;
      // the product of small numbers would be 0, and that of large ones infinite
      const double size =
          std::sqrt(std::abs(information[c * n + c])) * std::sqrt(std::abs(information[r * n + r]));
      if (!(std::abs(upper - lower) > kRounding * size)) continue;
      throw UsageError(type.tag +
                       ": the information matrix is not symmetric: its lower triangle is read, and row " +
                       std::to_string(r) + ", column " + std::to_string(c) + " is " + shortest(lower) +
                       " there, " + shortest(upper) + " above the diagonal");
    }
  }
}

EdgePlace Graph::add_edge(const EdgeType& type, std::span<const VertexIndex> vertices,
                          std::span<const double> fields, const Eigen::MatrixXd& information) {
  check_vertices(type, vertices);
  if (type.arity != EdgeType::kRuntimeArity) {
    if (fields.size() != static_cast<std::size_t>(type.field_size())) {
      throw UsageError(type.tag + ": expected " + std::to_string(type.field_size()) +
                       " numbers in its fields, got " + std::to_string(fields.size()));
    }
    if (information.rows() != type.error_dimension || information.cols() != type.error_dimension) {
      throw UsageError(type.tag + ": the information matrix must be " + std::to_string(type.error_dimension) +
                       " x " + std::to_string(type.error_dimension));
    }
    check_triangles(type, information.data());
  }
  const std::size_t place = batch_of(type);
  EdgeBatchBase& target = *batches_[place].edges;
  constexpr std::size_t kFew = 4;  // most edges have two vertices, and their list needs no heap
  if (vertices.size() <= kFew) {
    std::array<const VertexType*, kFew> types{};
    for (std::size_t k = 0; k < vertices.size(); ++k) types[k] = &vertex_type(vertices[k]);
    target.append(vertices, std::span(types).first(vertices.size()), fields, information);
  } else {
    target.append(vertices, types_of(vertices), fields, information);
  }
  ++structure_version_;
  return {place, target.size() - 1};
}

double Graph::chi2() const {
  double sum = 0;
  for (const Batch& batch : batches_) sum += batch.edges->chi2(view());
  return sum;
}

}  // namespace waymark
