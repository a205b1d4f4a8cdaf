/// What is fuzzed, by name. libFuzzer runs one target as a program of its own (libfuzzer_main.cpp); a short run of
/// all of them needs no libFuzzer (short_run.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace waymark_fuzz {

/// Ends the program if the code under test breaks an invariant.
/// @param name of the target, for functions that serve several
using Run = void(std::string_view name, const std::uint8_t* bytes, std::size_t size);

Run fuzz_log_reader;
Run fuzz_dbc;
Run fuzz_log_file;
Run fuzz_graph;
Run fuzz_drive_yaml;
Run fuzz_results;
Run fuzz_options;
Run fuzz_module;
Run fuzz_tum;
Run fuzz_geojson_map;

struct Target {
  std::string_view name;
  Run* run;
};

[[nodiscard]] std::span<const Target> targets();

}  // namespace waymark_fuzz
