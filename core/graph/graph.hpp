/// The graph: vertices with their values, and batches of edges over them.
///
/// All values are in one flat array, so copying it is a snapshot. A vertex is identified by
/// its index in insertion order. Nothing depends on hash or pointer order, so equal input
/// gives equal bits.
///
/// Ownership: a graph owns its vertices and edges; a copy is deep and shares nothing. Lifetime: a
/// span of values, a ValueView and a reference to a vertex type are valid until a vertex is added
/// or removed. A reference to a batch is valid until the graph is assigned, moved or destroyed.
/// Indices and EdgePlace are valid until vertices are removed. Threads: any number may read a
/// graph; a thread that writes must be the only one. Precondition: every VertexIndex, EdgePlace or
/// batch number belongs to this graph. Only add_edge() checks this.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace WAYMARK_EXPORT waymark {

/// Maps ids to indices. Ids from 0 up are looked up in an array, all others in a hash map (which is
/// never iterated). The array follows the ids in use, so it does not grow with the life of a sliding
/// window.
class VertexIds {
 public:
  [[nodiscard]] VertexIndex find(VertexId id) const {  ///< -1: absent
    if (!in_array(id)) return find_in_map(id);
    const auto place = static_cast<std::size_t>(to_number(id) - first_);
    return place < array_.size() ? array_[place] : -1;
  }
  void insert(VertexId id, VertexIndex index);
  void erase(VertexId id);

 private:
  [[nodiscard]] bool in_array(VertexId id) const {
    return to_number(id) >= first_ && to_number(id) - first_ < (std::int64_t{1} << 24);
  }
  void follow_ids();
  [[nodiscard]] VertexIndex find_in_map(VertexId id) const;
  std::int64_t first_ = 0;  // id of the first element of the array; earlier ids are in the map
  std::size_t erased_ = 0;  // so many ids since the array was looked at
  std::vector<VertexIndex> array_;
  std::unordered_map<VertexId, VertexIndex> map_;
};

/// The result of Graph::remove_vertices, in terms of the graph before the call.
struct Removal {
  std::vector<VertexIndex> new_index;         ///< per vertex; -1: it was removed
  std::vector<std::vector<char>> gone_edges;  ///< per batch and edge; not zero: it was removed
  /// per batch: number of edges that stayed; they are now the first ones in it
  std::vector<std::size_t> kept_edges;
};

class Graph {
 public:
  Graph() = default;
  Graph(const Graph& other);
  Graph& operator=(const Graph& other);
  Graph(Graph&&) = default;
  Graph& operator=(Graph&&) = default;

  // ---- Vertices

  /// Adds a vertex. @param value type.value_size numbers. @throws UsageError if the id
  /// exists already
  VertexIndex add_vertex(const VertexType& type, VertexId id, std::span<const double> value);
  template <Vertex V>
  VertexIndex add_vertex(VertexId id, const std::array<double, V::kValueSize>& value) {
    static const VertexType type = make_vertex_type<V>();
    return add_vertex(type, id, value);
  }
  /// Adds a vertex with a value of its type: add_vertex<VertexSe2>(VertexId{1}, pose).
  template <Vertex V, std::same_as<VertexValue<V>> Value>
  VertexIndex add_vertex(VertexId id, const Value& value) {
    return add_vertex<V>(id, numbers_of_value<V>(value));
  }

  [[nodiscard]] std::size_t vertex_count() const { return ids_.size(); }
  [[nodiscard]] std::optional<VertexIndex> find(VertexId id) const {
    const VertexIndex v = by_id_.find(id);
    return v < 0 ? std::nullopt : std::optional(v);
  }
  [[nodiscard]] VertexId id(VertexIndex v) const { return ids_[index(v)]; }
  /// Returns an id that no vertex ever had: one above the largest so far, at least 1.
  [[nodiscard]] VertexId free_id() const { return free_id_; }
  [[nodiscard]] const VertexType& vertex_type(VertexIndex v) const {
    return vertex_types_[type_of_[index(v)]];
  }
  [[nodiscard]] std::span<const double> value(VertexIndex v) const {
    return {values_.data() + offsets_[index(v)], static_cast<std::size_t>(vertex_type(v).value_size)};
  }
  /// Returns the value in the form of its type: value<VertexSe2>(v) is a Pose2<double>.
  /// @throws UsageError if the vertex is of another type
  template <Vertex V>
  [[nodiscard]] VertexValue<V> value(VertexIndex v) const {
    check_type(v, V::kTag);
    return value_from_numbers<V>(value(v).data());
  }
  /// Sets the numbers as they are. @throws UsageError for a wrong size
  void set_value(VertexIndex v, std::span<const double> value);
  /// Sets a value in the form of its type. A heading is wrapped.
  /// @throws UsageError if the vertex is of another type
  template <Vertex V>
  void set_value(VertexIndex v, const VertexValue<V>& value) {
    check_type(v, V::kTag);
    set_value(v, numbers_of_value<V>(value));
  }
  /// A fixed vertex keeps its value during optimisation.
  void set_fixed(VertexIndex v, bool fixed);
  [[nodiscard]] bool fixed(VertexIndex v) const { return fixed_[index(v)] != 0; }
  void set_stamp(VertexIndex v, Stamp stamp);
  [[nodiscard]] std::optional<Stamp> stamp(VertexIndex v) const;

  /// Removes vertices and every edge that touches one of them. The rest keeps its order, so indices
  /// move up. A batch stays even if it becomes empty.
  /// @param gone per vertex: not zero removes it
  Removal remove_vertices(std::span<const char> gone);

  /// Returns all values at once. Vertex v begins at offsets()[v].
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] const std::vector<std::int64_t>& offsets() const { return offsets_; }
  void set_values(std::vector<double> values);
  [[nodiscard]] ValueView view() const { return {values_.data(), offsets_.data()}; }

  // ---- Edges

  /// Returns the batch of a type, and creates it at the first call. Batches keep the order of
  /// their creation.
  EdgeBatchBase& batch(const EdgeType& type);
  [[nodiscard]] std::size_t batch_count() const { return batches_.size(); }
  [[nodiscard]] const EdgeBatchBase& batch(std::size_t b) const { return *batches_[b].edges; }
  [[nodiscard]] EdgeBatchBase& batch(std::size_t b) { return *batches_[b].edges; }
  [[nodiscard]] const EdgeType& edge_type(std::size_t b) const { return batches_[b].type; }
  [[nodiscard]] std::size_t edge_count() const;

  /// Adds an edge by run-time type and returns its place.
  /// @param fields see EdgeType::fields
  /// @param information symmetric and positive semidefinite, which is not checked. Only its lower triangle
  /// is read; the upper one may be zero
  /// @throws UsageError for a wrong number or type of vertices, a vertex named twice, wrong sizes, and an
  /// upper triangle that is neither zero nor the mirror of the lower one
  EdgePlace add_edge(const EdgeType& type, std::span<const VertexIndex> vertices,
                     std::span<const double> fields, const Eigen::MatrixXd& information);
  template <Edge E>
  EdgePlace add_edge(const E& edge, const typename EdgeBatch<E>::Indices& vertices,
                     const typename EdgeBatch<E>::Information& information) {
    static const EdgeType type = make_edge_type<E>();
    // A batch with this tag may come from another library, so its own append is used.
    const std::size_t place = batch_of(type);
    EdgeBatchBase& target = *batches_[place].edges;
    check_vertices(type, vertices);
    check_triangles(type, information.data());
    if (auto* typed = dynamic_cast<EdgeBatch<E>*>(&target)) {
      typed->append(edge, vertices, information);
    } else {
      append_untyped(target, edge, vertices, information);
    }
    ++structure_version_;
    return {place, target.size() - 1};
  }
  /// Adds an edge with its own robust loss; empty: none.
  template <Edge E>
  EdgePlace add_edge(const E& edge, const typename EdgeBatch<E>::Indices& vertices,
                     const typename EdgeBatch<E>::Information& information, const std::optional<Loss>& loss) {
    const EdgePlace added = add_edge(edge, vertices, information);
    if (loss) set_loss(added, *loss);
    return added;
  }
  /// Sets the robust loss of a single edge.
  void set_loss(EdgePlace edge, const Loss& loss) { batches_[edge.batch].edges->set_loss(edge.edge, loss); }

  /// Returns a number that changes if a vertex or an edge is added or removed, or if a vertex is
  /// fixed or freed.
  [[nodiscard]] std::uint64_t structure_version() const { return structure_version_; }

  /// Returns the sum of rho(e^T Omega e) over all edges at the present values.
  [[nodiscard]] double chi2() const;

 private:
  struct Batch {
    EdgeType type;
    std::unique_ptr<EdgeBatchBase> edges;
  };

  static std::size_t index(VertexIndex v) { return static_cast<std::size_t>(v); }
  /// Returns the number of the batch of a type, and creates the batch at the first call.
  std::size_t batch_of(const EdgeType& type);
  void check_type(VertexIndex v, std::string_view tag) const;
  void check_vertices(const EdgeType& type, std::span<const VertexIndex> vertices) const;
  static void check_triangles(const EdgeType& type, const double* information);
  std::size_t register_type(const VertexType& type);

  template <Edge E>
  void append_untyped(EdgeBatchBase& target, const E& edge, std::span<const VertexIndex> vertices,
                      const typename EdgeBatch<E>::Information& information) {
    std::vector<double> fields;
    for (const auto& f : E::fields()) {
      const double* data = f.read(edge);
      fields.insert(fields.end(), data, data + f.size);
    }
    // The numbers are copied one by one, because g++ 12 warns for a 1 x 1 matrix that a packet
    // would not fit.
    Eigen::MatrixXd dynamic(E::kErrorDimension, E::kErrorDimension);
    for (int r = 0; r < E::kErrorDimension; ++r) {
      for (int c = 0; c < E::kErrorDimension; ++c) dynamic(r, c) = information(r, c);
    }
    target.append(vertices, types_of(vertices), fields, dynamic);
  }
  [[nodiscard]] std::vector<const VertexType*> types_of(std::span<const VertexIndex> vertices) const;

  std::vector<VertexType> vertex_types_;
  std::vector<VertexId> ids_;
  std::vector<std::uint16_t> type_of_;
  std::vector<std::int64_t> offsets_;
  std::vector<double> values_;
  std::vector<char> fixed_;
  std::vector<Stamp> stamps_;  // empty until the first one is set; kNoStamp if a vertex has none
  VertexIds by_id_;
  VertexId free_id_{1};
  std::vector<Batch> batches_;
  std::uint64_t structure_version_ = 0;
};

}  // namespace waymark
