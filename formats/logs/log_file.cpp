#include <waymark/formats/logs/log_file.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/guard.hpp>
#include <waymark/formats/logs/detail/compression/byte_source.hpp>
#include <waymark/formats/logs/detail/foreign_formats.hpp>
#include <waymark/formats/text/detail/input_file.hpp>
#include <waymark/formats/text/detail/utf16.hpp>

namespace waymark::formats {
namespace {

constexpr std::size_t kPiece = 1U << 20U;
constexpr std::size_t kHead = 64U << 10U;

/// Returns the file itself. For a folder it returns the files inside, in order of name.
std::vector<std::string> files_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return {path};
  std::error_code error;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    if (entry.is_regular_file(ignored)) files.push_back(entry.path().string());
  }
  if (error) fail_read(path, error.value());
  if (files.empty()) throw InputError(path + ": the folder holds no files");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string read_head(const std::string& path) {
  std::vector<char> buffer(kHead);
  std::string head;
  std::string trouble;
  for (const std::string& name : files_of(path)) {
    ByteSource file(name);
    Utf16Text text;
    while (head.size() < kHead) {
      const std::string_view piece = file.next(buffer);
      if (piece.empty()) break;
      head += text.converted(piece);
    }
    if (trouble.empty()) trouble = file.trouble();
    if (head.size() >= kHead) break;
  }
  if (head.empty() && trouble.empty()) throw EmptyLogError(path + ": the log is empty");
  if (head.empty()) throw InputError(path + ": " + trouble);
  return head;
}

std::string read_in_pieces(const std::string& path, const std::function<void(std::string_view)>& take,
                           const ReadProgress& progress) {
  std::vector<char> buffer(kPiece);
  std::string trouble;
  const std::vector<std::string> files = files_of(path);
  for (const std::string& name : files) {
    ByteSource file(name);
    Utf16Text text;
    char last = '\n';
    for (std::string_view piece = file.next(buffer); !piece.empty(); piece = file.next(buffer)) {
      piece = text.converted(piece);
      take(piece);
      if (!piece.empty()) last = piece.back();
      if (progress && files.size() == 1) progress(file.done(), file.size());
    }
    if (trouble.empty()) trouble = file.trouble();
    if (files.size() > 1 && last != '\n') take("\n");  // no line continues in the next file
  }
  return trouble;
}

CompanionFile read_companion(const std::string& path) {
  CompanionFile file{path, {}};
  const std::string trouble = read_in_pieces(path, [&file](std::string_view piece) { file.text += piece; });
  if (!trouble.empty()) throw InputError(path + ": " + trouble);
  return file;
}

LogData read_log_file(const LogReader& reader, const std::string& path, const LogRequest& request,
                      const ReadProgress& progress, const std::function<void(std::string_view)>& seen) {
  const auto of_reader = [&](const auto& call) {
    return guarded([&] { return path + ": the log reader"; }, "", call);
  };
  const std::unique_ptr<LogDecoder> decoder = of_reader([&] { return reader.open(path, request); });
  const auto take = [&](std::string_view piece) {
    if (seen) seen(piece);
    of_reader([&] { decoder->take(piece); });
  };
  const std::string trouble = read_in_pieces(path, take, progress);
  of_reader([&] { decoder->finish(); });
  LogData& data = decoder->data();
  if (!trouble.empty()) {
    ++data.records;
    ++data.corrupt;
    data.corrupt_examples.insert(data.corrupt_examples.begin(), path + ": " + trouble);
    data.corrupt_examples.resize(std::min(data.corrupt_examples.size(), kCorruptExamples));
  }
  require_samples(data, path);
  return std::move(data);
}

Recognised recognise_log(const std::string& path, std::span<const LogReaderType> readers) {
  const std::string head = read_head(path);
  const std::optional<std::string> foreign = foreign_format(head);
  Recognised best;
  std::string rival;
  for (const LogReaderType& entry : readers) {
    const Recognition why = guarded([&] { return path + ": log reader '" + entry.name + "'"; }, entry.name,
                                    [&] { return entry.reader->recognise(head); });
    if (why.certainty <= 0 || why.certainty < best.why.certainty) continue;
    rival = why.certainty == best.why.certainty ? std::string(best.reader.name) : std::string();
    best = {entry, why};
  }
  // Some foreign logs are tables too; only a table is so little of a format that it has to yield.
  if (foreign && best.why.certainty <= 0.5) best = {};
  if (best.reader.reader == nullptr)
    throw InputError(fmt::format("{}: the log's format is not recognised: {}", path,
                                 foreign.value_or("state its 'format'; `waymark info` lists all formats")));
  if (!rival.empty())
    throw InputError(
        fmt::format("{}: the log may be '{}' or '{}'; state its 'format'", path, rival, best.reader.name));
  return best;
}

}  // namespace waymark::formats
