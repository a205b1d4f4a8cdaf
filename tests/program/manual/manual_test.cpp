// The manual in its three forms: --help, man pages and the completion of bash say the same words.
#include <algorithm>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "program/support/help.hpp"
#include "program/support/program.hpp"
#include "support/paths.hpp"
#include "support/skip.hpp"

namespace manual_test {

namespace {

using Words = std::set<std::string>;

/// The options at the front of a line: "-o,--out DIR" has two.
void add_options(const std::string& line, Words& options) {
  for (const std::string& word : words_of(line)) {
    if (!word.starts_with('-')) return;
    options.insert(word);
  }
}

Words help_options(const std::string& command) {
  Words options;
  for (const std::string& line : lines_of(run({"help", command}).out)) {
    if (line.starts_with("  -")) add_options(line, options);
  }
  return options;
}

/// Roff without its font changes and escaped hyphens.
std::string plain(std::string text) {
  for (const char* escape : {"\\fB", "\\fI", "\\fR"}) {
    for (auto at = text.find(escape); at != std::string::npos; at = text.find(escape)) text.erase(at, 3);
  }
  for (auto at = text.find("\\-"); at != std::string::npos; at = text.find("\\-")) text.erase(at, 1);
  return text;
}

Words man_options(const std::string& command) {
  Words options;
  bool term = false;
  for (const std::string& line : lines_of(run({"help", "--man", command}).out)) {
    if (term) add_options(plain(line), options);
    term = line == ".TP";
  }
  return options;
}

bool has_bash() {
  if (exists("/bin/bash")) return true;
  waymark_test::skip("no /bin/bash");
  return false;
}

/// The completions that bash offers for the last word. @param folder  the working folder
Words completed(const std::vector<std::string>& words, const std::string& folder = "") {
  static const std::string kScript =
      "source <(\"$0\" completion bash) && COMP_WORDS=(\"$0\" \"$@\") COMP_CWORD=$# && _waymark && "
      "{ [[ ${#COMPREPLY[@]} -eq 0 ]] || printf '%s\\n' \"${COMPREPLY[@]}\"; }";
  std::vector<std::string> arguments = {"--norc", "-c", kScript, waymark_test::program_path()};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const RunResult result = run(arguments, {.folder = folder, .program = "/bin/bash"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(result.err.empty());
  const std::vector<std::string> lines = lines_of(result.out);
  return {lines.begin(), lines.end()};
}

}  // namespace

TEST_CASE("manual: every option of --help is in the man page, and the other way round") {
  for (const std::string& command : subcommands()) {
    INFO(command);
    const Words options = help_options(command);
    CHECK(options.contains("--help"));
    CHECK(man_options(command) == options);
  }
}

TEST_CASE("manual: every option of --help is completed, and no other") {
  if (!has_bash()) return;
  for (const std::string& command : subcommands()) {
    INFO(command);
    CHECK(completed({command, "-"}) == help_options(command));
  }
  const std::vector<std::string> names = subcommands();
  CHECK(completed({""}) == Words(names.begin(), names.end()));
  CHECK(completed({"help", ""}) == Words(names.begin(), names.end()));
}

TEST_CASE("manual: help prints what --help prints") {
  CHECK(run({"help"}).out == run({"--help"}).out);
  CHECK(run({"help", "run"}).out == run({"run", "--help"}).out);
  const RunResult unknown = run({"help", "optimise"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "unknown subcommand 'optimise'; did you mean 'optimize'?"));
}

TEST_CASE("manual: help of a subcommand has its required options in the usage, and no long lines") {
  const std::string help = run({"help", "run"}).out;
  CHECK(contains(help, "Usage: waymark run [OPTIONS] -o DIR DRIVE.yaml\n"));
  CHECK(contains(help, "\nThe drive:\n"));
  for (const std::string& command : subcommands()) {
    for (const std::string& line : lines_of(run({"help", command}).out)) {
      INFO(line);
      CHECK(line.size() <= 104);  // an example may be as long as its command
    }
  }
}

TEST_CASE("manual: the man pages have every section, and groff formats them without a warning") {
  const std::string folder = fresh_folder();
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);  // 2023-11-14
  const RunResult written = run({"help", "--man", "--out", folder + "man"});
  unsetenv("SOURCE_DATE_EPOCH");
  REQUIRE(written.code == 0);
  const std::vector<std::string> pages = names_in(folder + "man");
  CHECK(pages.size() == subcommands().size() + 1);
  const bool has_groff = exists("/usr/bin/groff");
  if (!has_groff) waymark_test::skip("no groff (package groff-base)");
  for (const std::string& page : pages) {
    INFO(page);
    const std::string text = read_text(folder + "man/" + page);
    CHECK(contains(text, "\"2023-11-14\""));
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "ENVIRONMENT",
                                "FILES", "EXAMPLES", "SEE ALSO"}) {
      INFO(section);
      CHECK(contains(text, std::string("\n.SH ") + section + "\n"));
    }
    if (!has_groff) continue;
    const RunResult formatted =
        run({"-man", "-Tutf8", "-ww", "-z", folder + "man/" + page}, {.program = "/usr/bin/groff"});
    CHECK(formatted.code == 0);
    CHECK(formatted.err == "");
    if (!exists("/usr/bin/mandoc")) continue;
    const RunResult linted =
        run({"-Tlint", "-Wwarning", folder + "man/" + page}, {.program = "/usr/bin/mandoc"});
    CHECK(linted.out == "");
  }
}

TEST_CASE("manual: a page has no date without SOURCE_DATE_EPOCH, and a wrong one is refused") {
  CHECK(run({"help", "--man"}).out.starts_with(".TH WAYMARK 1 \"\" \"waymark "));
  setenv("SOURCE_DATE_EPOCH", "yesterday", 1);
  const RunResult wrong = run({"help", "--man"});
  unsetenv("SOURCE_DATE_EPOCH");
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "SOURCE_DATE_EPOCH: expected seconds since 1970, got 'yesterday'"));
}

TEST_CASE("manual: pages go into a folder only as man pages, all of them") {
  const std::string folder = fresh_folder();
  CHECK(run({"help", "--out", folder + "man"}).code == 2);
  CHECK(run({"help", "run", "--man", "--out", folder + "man"}).code == 2);
  CHECK_FALSE(exists(folder + "man"));
  write_text(folder + "file", "");
  CHECK(run({"help", "--man", "--out", folder + "file"}).code == 5);
}

TEST_CASE("completion: closed sets and names of the registry, single and in lists") {
  if (!has_bash()) return;
  CHECK(completed({"convert", "--format", ""}) == Words{"graph", "g2o", "toro", "covariance"});
  CHECK(completed({"run", "-a", "d"}) == Words{"dogleg"});
  CHECK(completed({"run", "--solver", "block"}) == Words{"block_cholesky"});
  CHECK(completed({"run", "--solver", "=", "block"}) == Words{"block_cholesky"});
  CHECK(completed({"run", "-m", "g1,g"}) == Words{"g1,g1", "g1,g2", "g1,g3"});
  CHECK(completed({"optimize", "--start", "l"}) == Words{"linear"});
  CHECK(completed({"optimize", "--loss", "hub"}) == Words{"huber:"});
  CHECK(completed({"optimize", "--loss", "huber", ":"}).empty());
  CHECK(completed({"simulate", "--preset", "ur"}) == Words{"urban"});
  CHECK(completed({"run", "--from", ""}).empty());
  CHECK(completed({"completion", ""}) == Words{"bash", "fish", "zsh"});
}

TEST_CASE("completion: files by what a command reads, folders where it writes") {
  if (!has_bash()) return;
  const std::string folder = fresh_folder();
  for (const char* name : {"drive.yaml", "a graph.graph", "b.g2o", "notes.txt", "sensor.so"})
    write_text(folder + name, "");
  REQUIRE(run({"help", "--man", "--out", folder + "folder"}).code == 0);
  CHECK(completed({"run", ""}, folder) == Words{"drive.yaml", "folder"});
  CHECK(completed({"optimize", ""}, folder) == Words{"a graph.graph", "b.g2o", "folder"});
  CHECK(completed({"check", "a"}, folder) == Words{"a graph.graph"});
  CHECK(completed({"inspect", "n"}, folder) == Words{"notes.txt"});
  CHECK(completed({"run", "-o", ""}, folder) == Words{"folder"});
  CHECK(completed({"info", "--plugin", ""}, folder) == Words{"sensor.so", "folder"});
}

TEST_CASE("completion: plugins add names, from the folders and from the command line") {
  if (!has_bash()) return;
  const std::string sound = waymark_test::test_module_dir() + "/sound.so";
  CHECK(completed({"optimize", "--trusted", "EDGE_SAM"}).empty());
  CHECK(completed({"optimize", "--plugin", sound, "--trusted", "EDGE_SAM"}) == Words{"EDGE_SAMPLE"});
  setenv("WAYMARK_PLUGIN_PATH", waymark_test::test_module_dir().c_str(), 1);
  const Words edges = completed({"optimize", "--trusted", "EDGE_SAM"});
  const Words plugins = completed({"info", "--plugin", "sou"});
  unsetenv("WAYMARK_PLUGIN_PATH");
  CHECK(edges == Words{"EDGE_SAMPLE"});
  CHECK(plugins == Words{"sound"});
}

TEST_CASE("completion: zsh and fish ask bash, with the words so far") {
  if (!has_bash()) return;
  for (const char* shell : {"zsh", "fish"}) {
    const std::string script = run({"completion", shell}).out;
    const auto begin = script.find("bash -c '");
    REQUIRE(begin != std::string::npos);
    const std::string question = script.substr(begin, script.find("' bash", begin) + 6 - begin);
    const std::string program = waymark_test::program_path();
    const RunResult result =
        run({"--norc", "-c", question + " " + program + " " + program + " opti"}, {.program = "/bin/bash"});
    INFO(shell << ": " << result.err);
    CHECK(result.out == "optimize\n");
  }
}

TEST_CASE("completion: other shells are refused, and so is none") {
  CHECK(run({"completion", "tcsh"}).code == 2);
  CHECK(contains(run({"completion"}).err, "waymark completion bash"));
  CHECK(contains(run({"completion", "--values", "CAR"}).err,
                 "unknown kind of names 'CAR'; there are: ALGORITHM"));
}

}  // namespace manual_test
