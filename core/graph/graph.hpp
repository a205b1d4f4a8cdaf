/// The graph: vertices with their values, and batches of edges over them.
///
/// All values are in one flat array, so copying it is a snapshot. A vertex is identified by
/// its index in insertion order. Nothing depends on hash or pointer order, so equal input
/// gives equal bits.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/core/graph/edge_batch.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/graph/vertex.hpp>

namespace waymark {

/// Maps ids to indices. Ids from 0 up are looked up in an array, all others in a hash map (which is
/// never iterated).
class VertexIds {
 public:
  [[nodiscard]] VertexIndex find(VertexId id) const {  ///< -1: absent
    if (id < 0 || id >= kArrayLimit) return find_in_map(id);
    const auto place = static_cast<std::size_t>(id);
    return place < array_.size() ? array_[place] : -1;
  }
  void insert(VertexId id, VertexIndex index);
  void erase(VertexId id);

 private:
  static constexpr VertexId kArrayLimit = VertexId{1} << 24;
  [[nodiscard]] VertexIndex find_in_map(VertexId id) const;
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
  /// @throws UsageError for a wrong size
  void set_value(VertexIndex v, std::span<const double> value);
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

  /// Adds an edge by run-time type. It returns the batch, in which the edge is the last one.
  /// @param fields see EdgeType::fields
  /// @param information symmetric
  /// @throws UsageError for a wrong number or type of vertices, a vertex named twice,
  /// and wrong sizes
  EdgeBatchBase& add_edge(const EdgeType& type, std::span<const VertexIndex> vertices,
                          std::span<const double> fields, const Eigen::MatrixXd& information);
  template <Edge E>
  EdgeBatchBase& add_edge(const E& edge, const typename EdgeBatch<E>::Indices& vertices,
                          const typename EdgeBatch<E>::Information& information) {
    static const EdgeType type = make_edge_type<E>();
    // A batch with this tag may come from another library, so its own append is used.
    EdgeBatchBase& target = batch(type);
    check_vertices(type, vertices);
    if (auto* typed = dynamic_cast<EdgeBatch<E>*>(&target)) {
      typed->append(edge, vertices, information);
    } else {
      append_untyped(target, E(edge), vertices, information);
    }
    ++structure_version_;
    return target;
  }

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
  void check_vertices(const EdgeType& type, std::span<const VertexIndex> vertices) const;
  std::size_t register_type(const VertexType& type);

  template <Edge E>
  void append_untyped(EdgeBatchBase& target, E edge, std::span<const VertexIndex> vertices,
                      const typename EdgeBatch<E>::Information& information) {
    std::vector<double> fields;
    for (const auto& f : E::fields()) {
      const double* data = f.data(edge);
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
  VertexId free_id_ = 1;
  std::vector<Batch> batches_;
  std::uint64_t structure_version_ = 0;
};

}  // namespace waymark
