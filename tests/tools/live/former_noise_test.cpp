// What a live run takes from the summary of a former run.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/tools/live/session/former_noise.hpp>

#include "support/registry.hpp"

namespace former_noise_test {

using namespace waymark;
using waymark_test::registry;

namespace {

/// Settings after reading a summary that says of which receivers the fixes are not late.
drive::FusionSettings with_former(const std::string& without_delay, drive::FusionSettings settings = {}) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("waymark_summary_" + std::to_string(getpid()) + ".json");
  std::ofstream(file) << R"({"correlated": {"noise": [{"source": "", "owner": "correlated",
    "option": "white_sigma", "value": 0.7}])"
                      << without_delay << "}}";
  settings.modeling = "correlated";
  live::use_former_noise(file.string(), registry(), settings);
  std::filesystem::remove(file);
  return settings;
}

}  // namespace

TEST_CASE("former noise: noise and the decision on delays are options of the live run") {
  const drive::FusionSettings settings = with_former(R"(, "without_delay": [""])");
  CHECK(settings.modeling_options.at("white_sigma") == "0.7");
  CHECK(settings.modeling_options.at("time_offset") == "off");
  const drive::FusionSettings two = with_former(R"(, "without_delay": ["rear"])");
  CHECK_FALSE(two.modeling_options.contains("time_offset"));
  CHECK(two.sources.at("rear").options.at("time_offset") == "off");
}

TEST_CASE("former noise: a delay that was found, or is asked for, stays") {
  CHECK_FALSE(with_former(R"(, "without_delay": [])").modeling_options.contains("time_offset"));
  CHECK_FALSE(with_former("").modeling_options.contains("time_offset"));
  drive::FusionSettings asks;
  asks.calibration = Options{{"time_offset", "constant"}};
  CHECK_FALSE(with_former(R"(, "without_delay": [""])", asks).modeling_options.contains("time_offset"));
}

}  // namespace former_noise_test
