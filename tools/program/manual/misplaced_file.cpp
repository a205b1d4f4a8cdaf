#include <waymark/tools/program/manual/misplaced_file.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text/detail/byte_order_mark.hpp>
#include <waymark/tools/drive/description/drive_file.hpp>
#include <waymark/tools/program/manual/option_text.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>

namespace waymark::program {
namespace {

enum class FileKind { drive, graph, log };

/// The kinds of files that the positional of a command names (option_text.hpp); none: it wants no files.
std::vector<FileKind> wanted_by(const CLI::App& command) {
  std::vector<FileKind> wanted;
  for (const OptionText& option : option_texts(command)) {
    if (!option.positional()) continue;
    for (const std::string& word : split_text(option.value, "|")) {
      if (word == "DRIVE.yaml") wanted.push_back(FileKind::drive);
      if (word == "GRAPH") wanted.push_back(FileKind::graph);
      if (word == "LOG") wanted.push_back(FileKind::log);
    }
  }
  return wanted;
}

/// Tells whether the first line that is no comment is one of a graph.
bool is_graph_text(std::string_view text) {
  text = formats::without_byte_order_mark(text);
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (line.empty() || line.front() == '#') continue;
    constexpr std::array<std::string_view, 5> kTags{"GRAPH ", "VERTEX", "EDGE", "FIX ", "PARAMS_"};
    return std::any_of(kTags.begin(), kTags.end(),
                       [&](std::string_view tag) { return line.starts_with(tag); });
  }
  return false;
}

/// A kind, and what tells it.
struct Identity {
  FileKind kind;
  std::string format;  ///< of a log
};

std::optional<Identity> identify(const std::string& path) {
  if (drive::is_drive_file(path)) return Identity{FileKind::drive, ""};
  try {
    if (is_graph_text(formats::read_head(path))) return Identity{FileKind::graph, ""};
    const formats::Recognised log = formats::recognise_log(path, formats::builtin_log_readers());
    // Graphs of other programs are columns of numbers too.
    constexpr std::array<std::string_view, 4> kTables{".csv", ".txt", ".tsv", ".gz"};
    const std::string ending = std::filesystem::path(path).extension().string();
    if (log.reader.name == "csv" && std::find(kTables.begin(), kTables.end(), ending) == kTables.end())
      return std::nullopt;
    return Identity{FileKind::log, log.reader.name};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string description_of(const Identity& file) {
  if (file.kind == FileKind::drive) return "describes a drive";
  return file.kind == FileKind::graph ? "is a graph" : "is a log (" + file.format + ")";
}

/// Returns the command that takes a file of one kind nearest to where another one wants to go.
std::string next_step(FileKind has, FileKind wants, const std::string& path) {
  if (has == FileKind::log) return fmt::format("waymark init {} -o drive.yaml", path);
  if (has == FileKind::graph) return fmt::format("waymark optimize {} -o fused.graph", path);
  if (wants == FileKind::log) return fmt::format("waymark inspect {}", path);
  return fmt::format("waymark convert {} -o drive.graph", path);
}

std::string wish_of(FileKind wants) {
  if (wants == FileKind::drive) return "a drive.yaml, which names the logs of a drive";
  return wants == FileKind::graph ? "a graph" : "logs";
}

}  // namespace

std::string misplaced_file(const CLI::App& app, const std::vector<std::string>& words) {
  const std::string path = only_file(app, words);
  std::error_code none;
  if (path.empty() || !std::filesystem::is_regular_file(path, none)) return {};
  const CLI::App& command = *app.get_subcommand(words.front());
  const std::vector<FileKind> wanted = wanted_by(command);
  if (wanted.empty()) return {};
  const std::optional<Identity> file = identify(path);
  if (!file || std::find(wanted.begin(), wanted.end(), file->kind) != wanted.end()) return {};
  return fmt::format("{} {}, and '{}' wants {}; type\n  {}", path, description_of(*file), command.get_name(),
                     wish_of(wanted.front()), next_step(file->kind, wanted.front(), path));
}

}  // namespace waymark::program
