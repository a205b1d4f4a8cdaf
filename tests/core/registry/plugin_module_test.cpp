// Modules as files: one that does not fit is refused, with the reason, before its code runs; nothing that
// a module does while it registers can leave half of it behind.
#include <sys/stat.h>
#include <xmmintrin.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/registry/detail/module_file.hpp>
#include <waymark/core/registry/plugin_loader.hpp>

#include "support/paths.hpp"
#include "support/registry.hpp"
#include "support/skip.hpp"

namespace plugin_module_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

std::string module_file(const std::string& name) {
  return waymark_test::test_module_dir() + "/" + name + ".so";
}

/// Loads a module and says whether any of its code ran.
struct Attempt {
  std::string error;  ///< empty: it was loaded
  bool ran = false;
};

Attempt attempt(const std::string& file, TypeRegistry& registry) {
  const std::filesystem::path trace = scratch_dir() / "module_ran";
  std::filesystem::remove(trace);
  setenv("WAYMARK_TEST_MODULE_RAN", trace.c_str(), 1);
  Attempt result;
  try {
    load_plugin(file, registry);
  } catch (const UsageError& error) {
    result.error = error.what();
  }
  unsetenv("WAYMARK_TEST_MODULE_RAN");
  result.ran = std::filesystem::exists(trace);
  return result;
}

bool is_built(const std::string& name) {
  if (std::filesystem::exists(module_file(name))) return true;
  waymark_test::skip("module " + name + " is not built on this processor or with this compiler");
  return false;
}

}  // namespace

TEST_CASE("modules: a sound one is loaded, and its code runs") {
  TypeRegistry registry = full_registry();
  const Attempt sound = attempt(module_file("sound"), registry);
  CHECK(sound.error == "");
  CHECK(sound.ran);
  REQUIRE(registry.find_edge("EDGE_SAMPLE") != nullptr);
  CHECK(registry.plugins().back().name == "sample");
  CHECK(registry.plugins().back().version == "1.2.3");
  CHECK(registry.plugins().back().place == module_file("sound"));
  CHECK(check_edge_type(registry, *registry.find_edge("EDGE_SAMPLE")).sound());
}

TEST_CASE("modules: another build is refused with the reason, before any of its code runs") {
  struct Case {
    const char* module;
    std::string reason;
    const char* remedy;
  };
  const std::string numbers =
      "(plugin " + std::to_string(kPluginAbi - 1) + ", waymark " + std::to_string(kPluginAbi) + ")";
  const Case cases[] = {
      {"avx2", "Eigen maximal alignment differs (plugin 32, waymark 16)", "without -march=native, -mavx"},
      {"linked_fast", "was linked with -ffast-math or -Ofast", "link the plugin without these flags"},
      {"linked_fast_stripped", "was linked with -ffast-math or -Ofast",
       "link the plugin without these flags"},
      {"debug_stl", "_GLIBCXX_DEBUG differs (plugin 1, waymark 0)", "waymark_add_plugin()"},
      {"other_abi", "plugin ABI number differs " + numbers, "build the plugin again"},
      {"no_descriptor", "no symbol 'waymark_plugin'", "define it with WAYMARK_PLUGIN"},
  };
  for (const Case& wrong : cases) {
    if (!is_built(wrong.module)) continue;
    TypeRegistry registry = full_registry();
    constexpr unsigned kControl = ~0x3fu;  // all but the sticky flags of past operations
    const unsigned control = _mm_getcsr() & kControl;
    const Attempt refused = attempt(module_file(wrong.module), registry);
    INFO(refused.error);
    CHECK_THAT(refused.error,
               Contains(module_file(wrong.module)) && Contains(wrong.reason) && Contains(wrong.remedy));
    CHECK_FALSE(refused.ran);
    CHECK((_mm_getcsr() & kControl) == control);
    CHECK(registry.find_edge("EDGE_SAMPLE") == nullptr);
  }
}

TEST_CASE("modules: a tag that is taken and a registration that throws leave the registry as it was") {
  struct Case {
    const char* module;
    const char* reason;
  };
  const Case cases[] = {
      {"duplicate", "edge type 'EDGE_SE2' of sample is already registered by waymark; rename one of them"},
      {"throws", "plugin 'sample' could not be registered: the sensor is not plugged in"},
      {"throws_number",
       "plugin 'sample' could not be registered: it threw something that is no std::exception"},
  };
  for (const Case& wrong : cases) {
    TypeRegistry registry = full_registry();
    const std::size_t edges = registry.edges().size();
    const std::size_t plugins = registry.plugins().size();
    const Attempt refused = attempt(module_file(wrong.module), registry);
    CHECK_THAT(refused.error, Contains(module_file(wrong.module)) && Contains(wrong.reason));
    CHECK(registry.edges().size() == edges);
    CHECK(registry.plugins().size() == plugins);
  }
}

TEST_CASE("modules: two with one name or one tag are told apart by both origins") {
  TypeRegistry registry = full_registry();
  REQUIRE(attempt(module_file("sound"), registry).error == "");
  const Attempt again = attempt(module_file("wrong_jacobian"), registry);  // also named sample
  CHECK_THAT(again.error, Contains("plugin 'sample'") && Contains(module_file("sound")) &&
                              Contains(module_file("wrong_jacobian")) && Contains("load only one"));
}

TEST_CASE("modules: a wrong Jacobian of a plugin is reported with the entry, both values and the vertex") {
  TypeRegistry registry = full_registry();
  REQUIRE(attempt(module_file("wrong_jacobian"), registry).error == "");
  const EdgeTypeCheck check = check_edge_type(registry, *registry.find_edge("EDGE_SAMPLE"));
  CHECK_FALSE(check.sound());
  CHECK_THAT(describe(check.graph, 0, check.worst),
             Contains("EDGE_SAMPLE") && Contains("vertex 1 (VERTEX_SE2") && Contains("row 1, column 1 (y)") &&
                 Contains("given -1, differences of the error give 1"));
}

TEST_CASE("modules: a folder or a pipe of a plugin's name is refused without being read") {
  TypeRegistry registry = full_registry();
  const std::filesystem::path folder = scratch_dir() / "folder.so";
  std::filesystem::create_directories(folder);
  CHECK_THAT(attempt(folder, registry).error, Contains("folder.so: is no regular file"));
  const std::filesystem::path pipe = scratch_dir() / "pipe.so";
  std::filesystem::remove(pipe);
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(attempt(pipe, registry).error, Contains("pipe.so: is no regular file"));
}

TEST_CASE("modules: a file that is damaged anywhere is refused or loaded, never a crash of the reader") {
  std::ifstream file(module_file("sound"), std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(file), {}};
  const std::string path = (scratch_dir() / "damaged.so").string();
  const auto read = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      const ModuleFile module(path);
      (void)module.symbol("waymark_plugin");
      (void)module.sets_flush_to_zero();
    } catch (const UsageError&) {
    }
  };
  for (std::size_t length = 0; length < 400; ++length) read(sound.substr(0, length));
  for (std::size_t part = 1; part < 20; ++part) read(sound.substr(0, sound.size() * part / 20));
  for (std::size_t at = 0; at < 600; ++at) {  // headers
    std::string bytes = sound;
    bytes[at] = static_cast<char>(~bytes[at]);
    read(bytes);
  }
  for (std::size_t from_end = 1; from_end < 3000; from_end += 7) {  // section headers
    std::string bytes = sound;
    bytes[bytes.size() - from_end] = static_cast<char>(0xff);
    read(bytes);
  }
}

TEST_CASE("modules: a file that is cut off is refused before it is loaded") {
  const std::string whole = module_file("sound");
  const auto size = std::filesystem::file_size(whole);
  const std::filesystem::path cut = scratch_dir() / "cut.so";
  for (const std::uintmax_t part : {size / 4, size / 2}) {
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, part);
    TypeRegistry own = registry();
    const Attempt result = attempt(cut, own);
    INFO(part << " of " << size << ": " << result.error);
    CHECK_FALSE(result.error.empty());
    CHECK_FALSE(result.ran);
  }
}

TEST_CASE("modules: one that kills the process that loads it is refused, and the host lives") {
#if defined(__SANITIZE_THREAD__)
  return waymark_test::skip("ThreadSanitizer has a thread of its own, so there is no trial in a child");
#endif
  TypeRegistry own = registry();
  const Attempt result = attempt(module_file("crashes"), own);
  CHECK_THAT(result.error, Contains("crashes.so: loading it ends a process by signal 6 (Aborted)"));
}

}  // namespace plugin_module_test
