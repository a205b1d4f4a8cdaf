/// The registry of types. It is a value: explicit calls fill it, and it is passed to its users.
/// There are no singletons and no static initialisers (linkers drop those from libraries).
///
/// Ownership: a registry owns its entries. Lifetime: pointers and references to entries are valid
/// until an entry is added to their table. The product of a factory belongs to the caller and does
/// not refer to the registry. Code and data of a module stay valid as long as the process, because
/// modules are never unloaded. Threads: any number may read a registry, and may call factories at
/// the same time; a thread that adds entries must be the only one. Precondition: vertex types are
/// added before edge types that join them are used.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/graph/detail/typed_batch.hpp>
#include <waymark/core/graph/edge.hpp>
#include <waymark/core/graph/loss.hpp>
#include <waymark/core/graph/vertex.hpp>
#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/optimize/algorithm.hpp>
#include <waymark/core/optimize/start.hpp>

namespace WAYMARK_EXPORT waymark {

/// A plugin whose types are in the registry.
struct PluginRecord {
  std::string name;
  std::string version;
  std::string place;  ///< file of a module, or "built in"
};

/// An entry and its origin.
template <typename T>
struct Registered {
  T type;
  std::string origin;  ///< "waymark" or the name of the plugin
};

/// One table of the registry: entries in the order of registration, found by name.
template <typename T>
using RegistryTable = std::vector<Registered<T>>;

class TypeRegistry {
 public:
  /// Sets the origin of all entries that are added from now on.
  void set_origin(std::string origin) { origin_ = std::move(origin); }

  /// Each throws UsageError if the name exists already, and names both origins.
  void add_vertex(VertexType type);
  void add_edge(EdgeType type);
  void add_loss(LossType type);
  void add_linear_solver(LinearSolverType type);
  void add_algorithm(AlgorithmType type);
  void add_odometry_model(OdometryModelType type);
  void add_gnss_modeling(GnssModelingType type);
  void add_sensor_model(SensorModelType type);
  void add_log_reader(LogReaderType type);
  void add_start(StartType type);
  void add_plugin(PluginRecord plugin);
  template <Vertex V>
  void add_vertex() {
    add_vertex(make_vertex_type<V>());
  }
  template <typename E>
  void add_edge() {
    static_assert(Edge<E>,
                  "an edge type has kTag, kErrorDimension, Vertices and fields(): core/graph/edge.hpp");
    if constexpr (Edge<E>) add_edge(make_edge_type<E>());
  }

  /// Each returns null if nothing has the tag or name.
  [[nodiscard]] const VertexType* find_vertex(std::string_view tag) const;
  [[nodiscard]] const EdgeType* find_edge(std::string_view tag) const;
  [[nodiscard]] const LossType* find_loss(std::string_view name) const;
  [[nodiscard]] const LogReader* find_log_reader(std::string_view name) const;

  /// Each throws UsageError for an unknown name (it lists the names that exist), and OptionError
  /// for options that the type does not have and values that they cannot have.
  [[nodiscard]] std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name,
                                                                 const Options& options = {}) const;
  [[nodiscard]] InitialValues make_start(std::string_view name, const Graph& graph) const;
  [[nodiscard]] std::unique_ptr<Algorithm> make_algorithm(std::string_view name,
                                                          const Options& options = {}) const;
  [[nodiscard]] std::unique_ptr<OdometryModel> make_odometry_model(std::string_view name,
                                                                   const Options& options = {}) const;
  [[nodiscard]] std::unique_ptr<GnssModeling> make_gnss_modeling(std::string_view name,
                                                                 const Options& options = {}) const;
  [[nodiscard]] std::unique_ptr<SensorModel> make_sensor_model(std::string_view name,
                                                               const Options& options = {}) const;
  /// Returns the type with this name. @throws UsageError for an unknown one; it lists the
  /// names that exist
  [[nodiscard]] const OdometryModelType& odometry_model(std::string_view name) const;
  [[nodiscard]] const GnssModelingType& gnss_modeling(std::string_view name) const;
  [[nodiscard]] const SensorModelType& sensor_model(std::string_view name) const;

  [[nodiscard]] const RegistryTable<VertexType>& vertices() const { return vertices_; }
  [[nodiscard]] const RegistryTable<EdgeType>& edges() const { return edges_; }
  [[nodiscard]] const RegistryTable<LossType>& losses() const { return losses_; }
  [[nodiscard]] const RegistryTable<LinearSolverType>& linear_solvers() const { return linear_solvers_; }
  [[nodiscard]] const RegistryTable<AlgorithmType>& algorithms() const { return algorithms_; }
  [[nodiscard]] const RegistryTable<OdometryModelType>& odometry_models() const { return odometry_models_; }
  [[nodiscard]] const RegistryTable<GnssModelingType>& gnss_modelings() const { return gnss_modelings_; }
  [[nodiscard]] const RegistryTable<SensorModelType>& sensor_models() const { return sensor_models_; }
  [[nodiscard]] const RegistryTable<LogReaderType>& log_readers() const { return log_readers_; }
  [[nodiscard]] const RegistryTable<StartType>& starts() const { return starts_; }
  /// Returns the plugins in the order in which they were entered.
  [[nodiscard]] const std::vector<PluginRecord>& plugins() const { return plugins_; }

 private:
  std::string origin_ = "waymark";
  RegistryTable<VertexType> vertices_;
  RegistryTable<EdgeType> edges_;
  RegistryTable<LossType> losses_;
  RegistryTable<LinearSolverType> linear_solvers_;
  RegistryTable<AlgorithmType> algorithms_;
  RegistryTable<OdometryModelType> odometry_models_;
  RegistryTable<GnssModelingType> gnss_modelings_;
  RegistryTable<SensorModelType> sensor_models_;
  RegistryTable<LogReaderType> log_readers_;
  RegistryTable<StartType> starts_;
  std::vector<PluginRecord> plugins_;
};

/// Registers the types of core itself: the Gaussian prior of run-time arity and the robust losses.
void register_core_types(TypeRegistry& registry);

}  // namespace waymark
