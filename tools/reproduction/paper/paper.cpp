#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/reproduction/paper/paper.hpp>

namespace waymark::reproduction {
namespace {

constexpr std::size_t kMostFields = 6;
using Fields = std::array<std::string_view, kMostFields>;

/// Calls take(fields) for every line but comments and the heading.
template <typename Take>
void for_each_line(std::string_view csv, Take take) {
  bool heading = true;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    std::string_view line = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    if (line.empty() || line.front() == '#') continue;
    if (std::exchange(heading, false)) continue;
    Fields fields;
    for (std::string_view& field : fields) {
      const std::size_t comma = std::min(line.find(','), line.size());
      field = line.substr(0, comma);
      line.remove_prefix(std::min(comma + 1, line.size()));
    }
    take(fields);
  }
}

template <typename Number>
Number number(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError("the paper's figures: expected a number, got '" + std::string(text) + "'");
  return value;
}

std::vector<PaperDrive> parse_drives() {
  std::vector<PaperDrive> drives;
  for_each_line(kPaperDrivesCsv, [&](const Fields& f) {
    drives.push_back({number<int>(f[0]), number<double>(f[1]), number<int>(f[2]), number<int>(f[3]),
                      number<double>(f[4]), std::string(f[5])});
  });
  return drives;
}

std::vector<PaperResult> parse_results() {
  std::vector<PaperResult> results;
  for_each_line(kPaperTablesCsv, [&](const Fields& f) {
    results.push_back({number<int>(f[0]),
                       std::string(f[1]),
                       {number<double>(f[2]), number<double>(f[3]), number<double>(f[4])}});
  });
  return results;
}

}  // namespace

const std::vector<PaperDrive>& paper_drives() {
  static const std::vector<PaperDrive> drives = parse_drives();
  return drives;
}

const std::vector<PaperResult>& paper_results() {
  static const std::vector<PaperResult> results = parse_results();
  return results;
}

std::optional<PaperMetrics> paper_metrics(int dataset, std::string_view system) {
  for (const PaperResult& result : paper_results()) {
    if (result.dataset == dataset && result.system == system) return result.metrics;
  }
  return std::nullopt;
}

}  // namespace waymark::reproduction
