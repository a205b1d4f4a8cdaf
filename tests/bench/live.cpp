#include "bench/live.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include <waymark/tools/live/estimator/estimator.hpp>
#include <waymark/tools/simulation/simulation.hpp>

#include "support/registry.hpp"

using namespace waymark;
using namespace waymark::live;

namespace {

constexpr int kRate = 25;  // Hz of the odometry

/// Half an hour of a simulated drive, by stamps.
const std::vector<Sample>& arrivals() {
  static const std::vector<Sample> samples = [] {
    simulation::SimulationRecipe recipe = simulation::simulation_preset("mixed").recipe;
    recipe.duration_s = 1800;
    const simulation::SimulatedDrive drive = simulation::simulate(recipe, 1);
    std::vector<Sample> all(drive.odometry.begin(), drive.odometry.end());
    for (const simulation::SimulatedFix& fix : drive.fixes) all.emplace_back(fix.fix);
    std::stable_sort(all.begin(), all.end(),
                     [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
    return all;
  }();
  return samples;
}

std::unique_ptr<Estimator> make(double window_s) {
  drive::DriveDescription description;
  description.odometry.resize(1);
  description.gnss.emplace_back();
  description.gnss.back().name = "gnss";
  LiveSettings settings;
  settings.window_s = window_s;
  drive::FusionSettings stated;
  stated.estimates_noise = false;  // searches run beside an estimate
  return std::make_unique<Estimator>(description, stated, settings, waymark_test::registry());
}

/// One sample of the kind, in a window that is full: a fix with its solution, or odometry.
void take(benchmark::State& state, bool fix) {
  const double window_s = static_cast<double>(state.range(0)) / kRate;
  const std::vector<Sample>& samples = arrivals();
  std::unique_ptr<Estimator> estimator;
  std::size_t next = samples.size();
  const auto give = [&] {
    estimator->take(samples[next++]);
    bool solved = false;
    for (const Report& report : estimator->reports()) {
      const auto* pose = std::get_if<LivePose>(&report);
      solved = solved || (pose != nullptr && pose->corrected);
    }
    return solved;
  };
  for (auto _ : state) {
    (void)_;
    double seconds = 0;
    for (bool done = false; !done;) {
      if (next == samples.size()) {
        estimator = make(window_s);
        next = 0;
        while (static_cast<double>(estimator->window_size()) < 0.9 * window_s * kRate) (void)give();
      }
      const auto begin = std::chrono::steady_clock::now();
      done = give() == fix;
      seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    state.SetIterationTime(seconds);
  }
}

}  // namespace

void waymark_bench::register_live_benchmarks() {
  for (const bool fix : {false, true}) {
    auto* made = benchmark::RegisterBenchmark(fix ? "live/fix" : "live/odometry",
                                              [fix](benchmark::State& state) { take(state, fix); });
    made->UseManualTime()->Unit(benchmark::kMicrosecond)->Arg(1500)->Arg(2000)->Arg(15'000);
  }
}
