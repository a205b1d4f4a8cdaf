// Texts and files that take a call each: results of former runs, options, trajectories, module files.
#include <cmath>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/detail/module_file.hpp>
#include <waymark/core/registry/flow_text.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>
#include <waymark/plugins/builtin.hpp>
#include <waymark/tools/evaluation/output/metrics_reader.hpp>
#include <waymark/tools/evaluation/output/summary_json.hpp>
#include <waymark/types_se2/register.hpp>

#include "invariants.hpp"
#include "memory_file.hpp"
#include "targets.hpp"

namespace waymark_fuzz {

using namespace waymark;

namespace {

std::string text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// Runs what may refuse its input.
template <typename Call>
void may_refuse(Call call) {
  try {
    call();
  } catch (const InputError&) {
    // refused
  } catch (const UsageError&) {
    // refused
  }
}

}  // namespace

void fuzz_results(std::string_view name, const std::uint8_t* bytes, std::size_t size) {
  may_refuse([&] {
    if (name == "metrics_json")
      (void)evaluation::read_metrics_json(text_of(bytes, size), "metrics.json");
    else
      (void)evaluation::read_run_summary(text_of(bytes, size), "summary.json");
  });
}

/// The text is a value of an option: in flow style, and of every option of every model.
void fuzz_options(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  static const TypeRegistry registry = [] {
    TypeRegistry made;
    register_core_types(made);
    register_se2_types(made);
    plugins::register_builtin_plugins(made);
    return made;
  }();
  const std::string text = text_of(bytes, size);
  may_refuse([&] {
    const std::string once = flow_text(parse_flow(text));
    if (flow_text(parse_flow(once)) != once) broken("a value is written as another one: " + once);
  });
  for (const auto& modeling : registry.gnss_modelings())
    for (const OptionInfo& option : modeling.type.options)
      may_refuse([&] { (void)registry.make_gnss_modeling(modeling.type.name, {{option.name, text}}); });
}

void fuzz_module(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  const MemoryFile file(text_of(bytes, size));
  may_refuse([&] {
    const ModuleFile module(file.path());
    (void)module.sets_flush_to_zero();
    if (const auto found = module.symbol("waymark_plugin"); found && found->size() > size)
      broken("a symbol is larger than its file");
  });
}

void fuzz_tum(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  may_refuse([&] {
    for (const auto& pose : formats::read_tum(text_of(bytes, size), "truth.tum"))
      if (!pose.pose.allFinite()) broken("a pose is not finite");
  });
}

}  // namespace waymark_fuzz
