// What is said of packages beside their ABI: tools/packaging/check_hardening.sh and sbom.py.
#include <algorithm>
#include <filesystem>
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace packaging_test {

namespace {

using nlohmann::json;

const std::string kFolder = waymark_test::source_dir() + "/tools/packaging/";

/// Builds a program that copies into an array on the stack: what GCC and clang both fortify.
std::string build(std::vector<std::string> flags) {
  const std::string folder = fresh_folder();
  const std::string source = write_text(folder + "print.cpp",
                                        "#include <cstdio>\n"
                                        "#include <cstring>\n"
                                        "int main(int count, char** names) {\n"
                                        "  char text[64];\n"
                                        "  std::strcpy(text, names[count - 1]);\n"
                                        "  std::fprintf(stderr, \"%s: %d\", text, count);\n"
                                        "  return text[0];\n"
                                        "}\n");
  flags.insert(flags.end(), {"-O2", source, "-o", folder + "print"});
  const RunResult built = run(flags, {.program = COMPILER});
  INFO(built.err);
  REQUIRE(built.code == 0);
  return folder + "print";
}

RunResult check(std::vector<std::string> arguments) {
  return run(std::move(arguments), {.program = kFolder + "check_hardening.sh"});
}

const std::vector<std::string> kHard{"-fPIE",
                                     "-pie",
                                     "-Wl,-z,relro,-z,now",
                                     "-fstack-protector-strong",
                                     "-U_FORTIFY_SOURCE",
                                     "-D_FORTIFY_SOURCE=2"};

std::vector<std::string> hard_but(const std::vector<std::string>& others) {
  std::vector<std::string> flags = kHard;
  flags.insert(flags.end(), others.begin(), others.end());
  return flags;
}

}  // namespace

TEST_CASE("hardening: a binary with all properties passes, alone and in a folder") {
  const std::string program = build(kHard);
  const RunResult result = check({program});
  INFO(result.out << result.err);
  CHECK(result.code == 0);
  CHECK(check({std::filesystem::path(program).parent_path()}).code == 0);
}

TEST_CASE("hardening: every property that a binary lacks is named") {
  const std::vector<std::pair<std::vector<std::string>, std::string>> lacking{
      {{"-no-pie", "-fno-PIE"}, "not position independent"},
      {{"-Wl,-z,norelro"}, "relocations stay writable"},
      {{"-Wl,-z,lazy"}, "relocations are bound late"},
      {{"-Wl,-z,execstack"}, "a segment, or the stack, is both writable and executable"},
      {{"-fno-stack-protector"}, "no stack protector"},
      {{"-U_FORTIFY_SOURCE"}, "no fortified function"}};
  for (const auto& [flags, said] : lacking) {
    const std::string program = build(hard_but(flags));
    const RunResult result = check({program});
    INFO(said << ": " << result.out << result.err);
    CHECK(result.code == 1);
    CHECK(contains(result.out, program + ": " + said));
  }
}

TEST_CASE("hardening: of what is only linked as every build is, no more is asked") {
  const std::string program = build(hard_but({"-fno-stack-protector", "-U_FORTIFY_SOURCE"}));
  CHECK(check({"--linked", program}).code == 0);
  CHECK(check({"--linked", fresh_folder()}).code == 2);  // nothing there
}

TEST_CASE("bill of materials: it has the libraries that are loaded, and those compiled in") {
  if (!std::filesystem::exists("/usr/bin/dpkg-query")) return waymark_test::skip("no Debian");
  const std::string file = fresh_folder() + "waymark.spdx.json";
  const RunResult result =
      run({"1.2.3", file, waymark_test::program_path()}, {.program = kFolder + "sbom.py"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const json document = json::parse(read_text(file));
  CHECK(document.at("spdxVersion") == "SPDX-2.3");
  CHECK(document.at("dataLicense") == "CC0-1.0");  // the specification allows no other
  CHECK(document.at("documentNamespace").get<std::string>().starts_with("https://"));

  std::set<std::string> names;
  for (const json& package : document.at("packages")) {
    INFO(package);
    names.insert(package.at("SPDXID").get<std::string>());
    CHECK_FALSE(package.at("versionInfo").get<std::string>().empty());
    if (package.at("name") == "libyaml-cpp0.7") {
      const RunResult asked =
          run({"-W", "-f", "${Version}", package.at("name")}, {.program = "/usr/bin/dpkg-query"});
      CHECK(asked.out == package.at("versionInfo").get<std::string>());
    }
  }
  CHECK(names.size() == document.at("packages").size());

  const auto has = [&](const char* from, const char* kind, const char* to) {
    const auto& relations = document.at("relationships");
    return std::count(relations.begin(), relations.end(),
                      json{{"spdxElementId", std::string("SPDXRef-") + from},
                           {"relationshipType", kind},
                           {"relatedSpdxElement", std::string("SPDXRef-") + to}}) == 1;
  };
  CHECK(has("DOCUMENT", "DESCRIBES", "waymark"));
  CHECK(has("waymark", "DYNAMIC_LINK", "libyaml-cpp0.7"));
  CHECK(has("libyaml-cpp-dev", "BUILD_DEPENDENCY_OF", "waymark"));
  CHECK(has("waymark", "STATIC_LINK", "libeigen3-dev"));  // headers alone
  CHECK(has("ninja-build", "BUILD_TOOL_OF", "waymark"));
  for (const json& relation : document.at("relationships")) {
    INFO(relation);
    CHECK(
        (relation.at("spdxElementId") == "SPDXRef-DOCUMENT" || names.contains(relation.at("spdxElementId"))));
    CHECK(names.contains(relation.at("relatedSpdxElement")));
  }
}

TEST_CASE("bill of materials: the same binaries at the same time give the same bytes") {
  if (!std::filesystem::exists("/usr/bin/dpkg-query")) return waymark_test::skip("no Debian");
  const std::string folder = fresh_folder();
  for (const char* name : {"a", "b"})
    REQUIRE(run({"-c", "SOURCE_DATE_EPOCH=1700000000 \"$0\" 1.2.3 \"$1\" \"$2\"", kFolder + "sbom.py",
                 folder + name, waymark_test::program_path()},
                {.program = "/bin/sh"})
                .code == 0);
  CHECK(read_text(folder + "a") == read_text(folder + "b"));
  CHECK(contains(read_text(folder + "a"), "\"created\": \"2023-11-14T22:13:20Z\""));
}

}  // namespace packaging_test
