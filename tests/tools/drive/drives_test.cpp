// The real drives, through the library as the program uses it: from the anchored start every modeling and
// every algorithm reaches one minimum; from dead reckoning a failure is reported as one.

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

#include "support/paths.hpp"
#include "support/registry.hpp"
#include "support/skip.hpp"

namespace drives_test {

using namespace waymark;
using namespace waymark::drive;
using namespace waymark::formats;

namespace {

struct DriveCase {
  std::string name;
  std::filesystem::path yaml;
  std::string data;  ///< in the shared data; empty: the drive is bundled
};

std::vector<DriveCase> drives() {
  const std::filesystem::path source = waymark_test::source_dir();
  std::vector<DriveCase> cases = {{"bundled", source / "examples/berlin_potsdamer_platz/drive.yaml", ""}};
  for (const char* name :
       {"berlin_gendarmenmarkt", "nagoya", "aarhus_horsens", "munich_2009", "pittsburgh_i376"}) {
    cases.push_back(
        {name, source / "examples/drives" / (std::string(name) + ".yaml"), std::string("drives/") + name});
  }
  return cases;
}

bool is_absent(const DriveCase& drive) {
  return !drive.data.empty() && !waymark_test::shared_data(drive.data);
}

/// A drive and how its drive.yaml has it fused.
struct LoadedDrive {
  PreparedDrive drive;
  FusionSettings settings;
};

LoadedDrive load(const DriveCase& drive, const TypeRegistry& registry) {
  const std::string data = drive.data.empty() ? "" : waymark_test::shared_data(drive.data).value();
  const DriveFile file = load_drive_file(drive.yaml.string(), data);
  return {load_drive(file.description, registry), file.settings};
}

GraphDocument document_of(Fusion& fusion, FusionSettings settings, const std::string& modeling) {
  settings.modeling = modeling;
  return fusion.model(settings).document;
}

Summary solve(GraphDocument& document, const std::string& algorithm, const TypeRegistry& registry) {
  const auto method = registry.make_algorithm(algorithm);
  const auto solver = registry.make_linear_solver("block_cholesky");
  return optimize(document.graph, *method, *solver, {});
}

const std::vector<std::string> kAlgorithms = {"gauss_newton", "levenberg_marquardt", "dogleg"};

/// Covariance under which G1 and G3 equal G2: the fix's covariance plus the stiff identity edge's.
void add_identity_covariance(PreparedDrive& drive) {
  constexpr double kIdentityInformation = 1e6;  // default of g2
  for (Fix& fix : drive.fixes) fix.covariance += Eigen::Matrix2d::Identity() / kIdentityInformation;
}

}  // namespace

TEST_CASE("real drives: from the anchored guess all modelings and algorithms reach one minimum") {
  const auto drive = GENERATE(from_range(drives()));
  if (is_absent(drive)) return;
  INFO(drive.name);
  TypeRegistry registry = waymark_test::full_registry();
  register_log_readers(registry);
  const LoadedDrive plain = load(drive, registry);
  PreparedDrive effective = plain.drive;
  add_identity_covariance(effective);
  Fusion fusion(plain.drive, registry);
  Fusion effective_fusion(effective, registry);

  double reference = 0;
  double effective_reference = 0;
  for (const std::string& algorithm : kAlgorithms) {
    for (const std::string modeling : {"g1", "g3", "g2"}) {
      INFO(modeling << " " << algorithm);
      GraphDocument document = document_of(fusion, plain.settings, modeling);
      const Summary summary = solve(document, algorithm, registry);
      CHECK(summary.converged());
      if (modeling == "g2") {
        CHECK(summary.final_chi2 == Approx(effective_reference).epsilon(1e-6));
        continue;
      }
      if (reference == 0) {
        reference = summary.final_chi2;
        GraphDocument stiff = document_of(effective_fusion, plain.settings, "g1");
        effective_reference = solve(stiff, algorithm, registry).final_chi2;
      }
      CHECK(summary.final_chi2 == Approx(reference).epsilon(1e-6));
    }
  }
}

TEST_CASE("real drives: from dead reckoning no failure passes for a success") {
  const auto drive = GENERATE(from_range(drives()));
  if (is_absent(drive)) return;
  INFO(drive.name);
  TypeRegistry registry = waymark_test::full_registry();
  register_log_readers(registry);
  const LoadedDrive loaded = load(drive, registry);
  Fusion fusion(loaded.drive, registry);
  GraphDocument best = document_of(fusion, loaded.settings, "g1");
  const double minimum = solve(best, "dogleg", registry).final_chi2;
  FusionSettings dead_reckoning = loaded.settings;
  dead_reckoning.initial_guess.method = StartMethod::dead_reckoning;
  for (const std::string modeling : {"g1", "g2", "g3"}) {
    for (const std::string& algorithm : kAlgorithms) {
      GraphDocument document = document_of(fusion, dead_reckoning, modeling);
      const double start = document.graph.chi2();
      const Summary summary = solve(document, algorithm, registry);
      INFO(modeling << " " << algorithm);
      // No start finds less than the anchored one; the best values are returned, never worse than the
      // start's.
      CHECK(summary.final_chi2 > minimum * (1 - 1e-6));
      CHECK(summary.final_chi2 <= start);
      // The graph has the values of the Summary.
      CHECK(document.graph.chi2() == Approx(summary.final_chi2).epsilon(1e-9));
      if (!summary.converged()) continue;
      // Declared converged: no step from here promises more than the tolerance.
      CHECK(solve(document, "gauss_newton", registry).final_chi2 == Approx(summary.final_chi2).epsilon(1e-5));
    }
  }
}

}  // namespace drives_test
