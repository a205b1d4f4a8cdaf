#include <algorithm>
#include <iterator>
#include <string_view>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/guard.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/core/graph/gaussian_prior.hpp>
#include <waymark/core/registry/detail/graph_statements.hpp>
#include <waymark/core/registry/detail/guarded_models.hpp>
#include <waymark/core/registry/detail/option_check.hpp>
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

bool is_blank_or_control(unsigned char c) {
  return c <= ' ' || c == 0x7f;
}

/// Names are words in files and on the command line.
void check_name(const std::string& name, const std::string& origin, const char* kind) {
  if (!name.empty() && name.front() != '#' && std::none_of(name.begin(), name.end(), is_blank_or_control))
    return;
  throw UsageError(std::string(kind) + " '" + name + "' of " + origin +
                   " cannot be registered: a name is a word without blanks that does not begin with '#'");
}

void check_tag(const std::string& tag, const std::string& origin, const char* kind) {
  const auto& words = detail::kGraphStatements;
  if (tag != "FIX" && std::find(std::begin(words), std::end(words), tag) == std::end(words)) return;
  throw UsageError(std::string(kind) + " '" + tag + "' of " + origin +
                   " cannot be registered: this word is a statement of .graph files; rename it");
}

/// What is missing would be called.
void check_callable(const LossType& type, const std::string& origin) {
  if (type.evaluate == nullptr)
    throw UsageError("loss '" + type.name + "' of " + origin + " has no function");
}
void check_callable(const LogReaderType& type, const std::string& origin) {
  if (type.reader == nullptr)
    throw UsageError("log reader '" + type.name + "' of " + origin + " has no reader");
}

void check_vertex_of(const EdgeType& edge, const VertexType& vertex) {
  for (std::size_t k = 0; k < edge.vertex_sizes.size(); ++k)
    if (edge.vertex_tags[k] == vertex.tag) check_sizes(edge, k, vertex);
}

/// The TYPE line of a .graph file names the form of the error and the fields; it must be read again.
void check_schema(const EdgeType& type, const std::string& origin) {
  const auto fail = [&](const std::string& what) {
    throw UsageError("edge type '" + type.tag + "' of " + origin + " cannot be registered: " + what);
  };
  if (std::any_of(type.form.begin(), type.form.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
    fail("the form of its error has a control character");
  for (std::size_t i = 0; i < type.fields.size(); ++i) {
    const std::string& name = type.fields[i].name;
    const bool is_word = !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) {
      return is_blank_or_control(c) || c == ',' || c == ':';
    });
    if (!is_word) fail("its field '" + name + "' is no word without blanks, commas and colons");
    for (std::size_t j = 0; j < i; ++j)
      if (type.fields[j].name == name) fail("two of its fields are named '" + name + "'");
  }
}

template <typename T>
void add(RegistryTable<T>& table, T type, const std::string& origin, const char* kind) {
  check_name(name_of(type), origin, kind);
  if constexpr (requires { type.tag; }) check_tag(type.tag, origin, kind);
  if constexpr (requires { check_callable(type, origin); }) check_callable(type, origin);
  if constexpr (requires { type.options; }) require_sound_priors(type.name + " of " + origin, type.options);
  for (const Registered<T>& entry : table) {
    if (name_of(entry.type) != name_of(type)) continue;
    throw UsageError(std::string(kind) + " '" + name_of(type) + "' of " + origin +
                     " is already registered by " + entry.origin +
                     "; rename one of them or load only one plugin");
  }
  table.push_back({std::move(type), origin});
}

template <typename T>
const Registered<T>& require(const RegistryTable<T>& table, std::string_view name, const char* kind) {
  for (const Registered<T>& entry : table) {
    if (name_of(entry.type) == name) return entry;
  }
  std::vector<std::string_view> names;
  for (const Registered<T>& entry : table) names.push_back(name_of(entry.type));
  throw UsageError(std::string("unknown ") + kind + " '" + std::string(name) + "'" + suggestion(name, names));
}

/// Makes a model, guarded with all of its calls.
template <typename T>
auto make(const Registered<T>& entry, const char* kind, const Options& options) {
  const T& type = entry.type;
  const CheckedOptions checked(type.name, options, type.options);
  const Guarded who{entry.origin, kind, type.name};
  return guarded_model(who,
                       guarded([&] { return who.text(); }, type.name, [&] { return type.make(checked); }));
}

/// Solvers and algorithms of our own are called in every iteration, and need no guard.
template <typename T>
auto make_own(const Registered<T>& entry, const char* kind, const Options& options) {
  if (entry.origin != "waymark") return make(entry, kind, options);
  return entry.type.make(CheckedOptions(entry.type.name, options, entry.type.options));
}

/// Guards an initial guess, which is called from the table too.
StartType guarded_start(StartType type, const std::string& origin) {
  type.make = [who = Guarded{origin, "initial guess", type.name},
               make = std::move(type.make)](const Graph& graph) {
    InitialValues made = guarded([&] { return who.text(); }, who.name, [&] { return make(graph); });
    const std::size_t expected = graph.values().size();
    if (made.values.empty() || made.values.size() == expected) return made;
    throw PluginError(who.text() + ": made " + std::to_string(made.values.size()) +
                          " numbers for a graph of " + std::to_string(expected) +
                          "; they must be in the layout of Graph::values()",
                      who.name);
  };
  return type;
}

}  // namespace

void TypeRegistry::add_vertex(VertexType type) {
  for (const Registered<EdgeType>& edge : edges_) check_vertex_of(edge.type, type);
  add(vertices_, std::move(type), origin_, "vertex type");
}
void TypeRegistry::add_edge(EdgeType type) {
  for (const Registered<VertexType>& vertex : vertices_) check_vertex_of(type, vertex.type);
  check_schema(type, origin_);
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
  for (const auto& [option, value] : type.noise_search.options)
    if (!has_option(type.options, option))
      throw UsageError(type.name + " of " + origin_ +
                       ": noise_search: " + problem_with_name("option", option, type.options));
  add(sensor_models_, std::move(type), origin_, "sensor model");
}
void TypeRegistry::add_log_reader(LogReaderType type) {
  add(log_readers_, std::move(type), origin_, "log reader");
}
void TypeRegistry::add_start(StartType type) {
  add(starts_, guarded_start(std::move(type), origin_), origin_, "initial guess");
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
  return make_own(require(linear_solvers_, name, "linear solver"), "linear solver", options);
}
InitialValues TypeRegistry::make_start(std::string_view name, const Graph& graph) const {
  return require(starts_, name, "initial guess").type.make(graph);
}
std::unique_ptr<Algorithm> TypeRegistry::make_algorithm(std::string_view name, const Options& options) const {
  return make_own(require(algorithms_, name, "algorithm"), "algorithm", options);
}
std::unique_ptr<OdometryModel> TypeRegistry::make_odometry_model(std::string_view name,
                                                                 const Options& options) const {
  return make(require(odometry_models_, name, "odometry model"), "odometry model", options);
}
std::unique_ptr<GnssModeling> TypeRegistry::make_gnss_modeling(std::string_view name,
                                                               const Options& options) const {
  return make(require(gnss_modelings_, name, "GNSS modeling"), "GNSS modeling", options);
}
std::unique_ptr<SensorModel> TypeRegistry::make_sensor_model(std::string_view name,
                                                             const Options& options) const {
  return make(require(sensor_models_, name, "sensor model"), "sensor model", options);
}

const OdometryModelType& TypeRegistry::odometry_model(std::string_view name) const {
  return require(odometry_models_, name, "odometry model").type;
}
const GnssModelingType& TypeRegistry::gnss_modeling(std::string_view name) const {
  return require(gnss_modelings_, name, "GNSS modeling").type;
}
const SensorModelType& TypeRegistry::sensor_model(std::string_view name) const {
  return require(sensor_models_, name, "sensor model").type;
}

void register_core_types(TypeRegistry& registry) {
  registry.add_edge(gaussian_prior_type());
  for (const LossType& loss : builtin_losses()) registry.add_loss(loss);
}

}  // namespace waymark
