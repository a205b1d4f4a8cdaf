/// The run path of a binary: the folders in which the dynamic linker looks first.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program/support/program.hpp"

namespace waymark_test {

/// Returns the entries of RPATH and RUNPATH. An empty entry means the folder in which the program is
/// started, in which anybody may have laid a library.
inline std::vector<std::string> run_path(const std::string& file) {
  const RunResult result = run({"-W", "-d", file}, {.program = "/usr/bin/readelf"});
  std::vector<std::string> entries;
  for (auto at = result.out.find("PATH)"); at != std::string::npos; at = result.out.find("PATH)", at + 1)) {
    const auto begin = result.out.find('[', at) + 1;
    const std::string all = result.out.substr(begin, result.out.find(']', begin) - begin) + ":";
    for (std::size_t from = 0; from < all.size(); from = all.find(':', from) + 1)
      entries.push_back(all.substr(from, all.find(':', from) - from));
  }
  return entries;
}

/// Returns the programs, libraries and modules below a folder, but no objects of the compiler.
inline std::vector<std::string> binaries_below(const std::string& folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.is_symlink() || entry.path().extension() == ".o") continue;
    char begin[17] = {};
    std::ifstream(entry.path(), std::ios::binary).read(begin, sizeof begin);
    const bool linked = begin[16] == 2 || begin[16] == 3;  // e_type: ET_EXEC, ET_DYN
    if (std::string_view(begin, 4) == "\177ELF" && linked) found.push_back(entry.path());
  }
  return found;
}

/// Tells whether every entry is absolute or relative to the binary.
inline bool is_safe(const std::vector<std::string>& entries) {
  for (const std::string& entry : entries)
    if (!entry.starts_with('/') && !entry.starts_with("$ORIGIN/")) return false;
  return true;
}

}  // namespace waymark_test
