#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark {
namespace {

const std::string& name_of(const VertexType& type) {
  return type.tag;
}
const std::string& name_of(const EdgeType& type) {
  return type.tag;
}
template <typename T>
const std::string& name_of(const T& type) {
  return type.name;
}

template <typename T>
const T* find(const RegistryTable<T>& table, std::string_view name) {
  for (const Registered<T>& entry : table) {
    if (name_of(entry.type) == name) return &entry.type;
  }
  return nullptr;
}

template <typename T>
void add(RegistryTable<T>& table, T type, const std::string& origin, const char* kind) {
  for (const Registered<T>& entry : table) {
    if (name_of(entry.type) != name_of(type)) continue;
    throw UsageError(std::string(kind) + " '" + name_of(type) + "' of " + origin +
                     " is already registered by " + entry.origin +
                     "; rename one of them or load only one plugin");
  }
  table.push_back({std::move(type), origin});
}

template <typename T>
const T& require(const RegistryTable<T>& table, std::string_view name, const char* kind) {
  if (const T* found = find(table, name)) return *found;
  std::vector<std::string_view> names;
  for (const Registered<T>& entry : table) names.push_back(name_of(entry.type));
  throw UsageError(std::string("unknown ") + kind + " '" + std::string(name) + "'" + suggestion(name, names));
}

template <typename T>
auto make(const T& type, const Options& options) {
  return type.make(CheckedOptions(type.name, options, type.options));
}

}  // namespace

void TypeRegistry::add_vertex(VertexType type) {
  add(vertices_, std::move(type), origin_, "vertex type");
}
void TypeRegistry::add_edge(EdgeType type) {
  add(edges_, std::move(type), origin_, "edge type");
}
void TypeRegistry::add_loss(LossType type) {
  add(losses_, std::move(type), origin_, "loss");
}
void TypeRegistry::add_linear_solver(LinearSolverType type) {
  add(linear_solvers_, std::move(type), origin_, "linear solver");
}
void TypeRegistry::add_algorithm(AlgorithmType type) {
  add(algorithms_, std::move(type), origin_, "algorithm");
}
void TypeRegistry::add_odometry_model(OdometryModelType type) {
  add(odometry_models_, std::move(type), origin_, "odometry model");
}
void TypeRegistry::add_gnss_modeling(GnssModelingType type) {
  add(gnss_modelings_, std::move(type), origin_, "GNSS modeling");
}
void TypeRegistry::add_sensor_model(SensorModelType type) {
  add(sensor_models_, std::move(type), origin_, "sensor model");
}
void TypeRegistry::add_log_reader(LogReaderType type) {
  add(log_readers_, std::move(type), origin_, "log reader");
}
void TypeRegistry::add_start(StartType type) {
  add(starts_, std::move(type), origin_, "initial guess");
}

void TypeRegistry::add_plugin(PluginRecord plugin) {
  for (const PluginRecord& other : plugins_) {
    if (other.name != plugin.name) continue;
    throw UsageError("plugin '" + plugin.name + "' (" + plugin.place + ") is already loaded (" + other.place +
                     "); load only one of them, or rename it in its WAYMARK_PLUGIN line");
  }
  plugins_.push_back(std::move(plugin));
}

const VertexType* TypeRegistry::find_vertex(std::string_view tag) const {
  return find(vertices_, tag);
}
const EdgeType* TypeRegistry::find_edge(std::string_view tag) const {
  return find(edges_, tag);
}
const LossType* TypeRegistry::find_loss(std::string_view name) const {
  return find(losses_, name);
}
const LogReader* TypeRegistry::find_log_reader(std::string_view name) const {
  const LogReaderType* type = find(log_readers_, name);
  return type == nullptr ? nullptr : type->reader;
}

std::unique_ptr<LinearSolver> TypeRegistry::make_linear_solver(std::string_view name,
                                                               const Options& options) const {
  return make(require(linear_solvers_, name, "linear solver"), options);
}
InitialValues TypeRegistry::make_start(std::string_view name, const Graph& graph) const {
  return require(starts_, name, "initial guess").make(graph);
}
std::unique_ptr<Algorithm> TypeRegistry::make_algorithm(std::string_view name, const Options& options) const {
  return make(require(algorithms_, name, "algorithm"), options);
}
std::unique_ptr<OdometryModel> TypeRegistry::make_odometry_model(std::string_view name,
                                                                 const Options& options) const {
  return make(odometry_model(name), options);
}
std::unique_ptr<GnssModeling> TypeRegistry::make_gnss_modeling(std::string_view name,
                                                               const Options& options) const {
  return make(gnss_modeling(name), options);
}
std::unique_ptr<SensorModel> TypeRegistry::make_sensor_model(std::string_view name,
                                                             const Options& options) const {
  return make(sensor_model(name), options);
}

const OdometryModelType& TypeRegistry::odometry_model(std::string_view name) const {
  return require(odometry_models_, name, "odometry model");
}
const GnssModelingType& TypeRegistry::gnss_modeling(std::string_view name) const {
  return require(gnss_modelings_, name, "GNSS modeling");
}
const SensorModelType& TypeRegistry::sensor_model(std::string_view name) const {
  return require(sensor_models_, name, "sensor model");
}

void register_core_types(TypeRegistry& registry) {
  registry.add_edge(gaussian_prior_type());
  for (const LossType& loss : builtin_losses()) registry.add_loss(loss);
}

}  // namespace waymark
