#include <waymark/tools/program/doctor/libraries.hpp>

#include <algorithm>

#include <GeographicLib/Config.h>
#include <expat.h>
#include <nlopt.h>
#include <zlib.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#ifdef WAYMARK_WITH_CHOLMOD
#include <cholmod.h>
#endif
#ifdef WAYMARK_WITH_CSPARSE
#include <cs.h>
#endif

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <waymark/tools/benchmark/contestants.hpp>
#include <waymark/tools/fleet/table/sqlite_file.hpp>

namespace waymark::program {
namespace {

std::string numbers(int major, int minor, int patch) {
  return fmt::format("{}.{}.{}", major, minor, patch);
}

void add_solvers(std::vector<Library>& libraries) {
#ifdef WAYMARK_WITH_CHOLMOD
  int version[3] = {};
  cholmod_version(version);
  libraries.push_back({"CHOLMOD", numbers(version[0], version[1], version[2]),
                       "GPL-2.0-or-later (supernodal module), LGPL-2.1 (simplicial)", LicenceTerms::gpl,
                       "linear solvers cholmod*"});
#endif
#ifdef WAYMARK_WITH_CSPARSE
  libraries.push_back({"CXSparse", numbers(CS_VER, CS_SUBVER, CS_SUBSUB), "LGPL-2.1-or-later",
                       LicenceTerms::lgpl, "linear solver csparse"});
#endif
  libraries.push_back({"Eigen", numbers(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
                       "MPL-2.0", LicenceTerms::permissive, "linear algebra, linear solver eigen"});
}

}  // namespace

std::vector<Library> built_in_libraries() {
  std::vector<Library> libraries;
  add_solvers(libraries);
  for (const std::string& peer : benchmark::built_in_peers()) {
    const auto space = peer.find(' ');
    libraries.push_back({peer.substr(0, space), peer.substr(space + 1),
                         "BSD-3-Clause; Debian's links SPQR and CHOLMOD: GPL-2.0-or-later", LicenceTerms::gpl,
                         "peer of 'waymark bench'"});
  }
  int major = 0;
  int minor = 0;
  int patch = 0;
  nlopt_version(&major, &minor, &patch);
  libraries.push_back({"NLopt", numbers(major, minor, patch), "LGPL-2.1-or-later", LicenceTerms::lgpl,
                       "noise parameters of a drive"});
  const auto add = [&](const char* name, const std::string& version, const char* licence, const char* use) {
    libraries.push_back({name, version, licence, LicenceTerms::permissive, use});
  };
  add("GeographicLib", GEOGRAPHICLIB_VERSION_STRING, "MIT", "UTM coordinates");
  add("yaml-cpp", WAYMARK_YAML_CPP_VERSION, "MIT", "drive.yaml");
  add("zlib", zlibVersion(), "Zlib", "compressed logs");
  std::string expat = XML_ExpatVersion();  // "expat_2.5.0"
  expat.erase(0, expat.find('_') + 1);
  add("expat", expat, "MIT", "GPX logs");
  add("SQLite", fleet::sqlite_version(), "public domain", "merged tables of fleets");
  add("fmt", numbers(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100), "MIT", "text");
  add("nlohmann-json",
      numbers(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH), "MIT",
      "JSON");
  add("CLI11", CLI11_VERSION, "BSD-3-Clause", "command line");
  return libraries;
}

LicenceTerms licence_mode(const std::vector<Library>& libraries) {
  LicenceTerms mode = LicenceTerms::permissive;
  for (const Library& library : libraries) mode = std::max(mode, library.terms);
  return mode;
}

std::string to_string(LicenceTerms terms) {
  switch (terms) {
    case LicenceTerms::permissive:
      return "permissive";
    case LicenceTerms::lgpl:
      return "LGPL";
    case LicenceTerms::gpl:
      return "GPL";
  }
  return {};
}

}  // namespace waymark::program
