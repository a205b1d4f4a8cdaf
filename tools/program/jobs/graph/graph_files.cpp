#include <waymark/core/base/error.hpp>
#include <waymark/formats/graph/graph_format.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/jobs/graph/graph_files.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/manual/usage_hints.hpp>

namespace waymark::program {
namespace {

std::vector<std::string> format_names() {
  return {formats::kGraphFormats.begin(), formats::kGraphFormats.end()};
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const formats::Recipient& profile : formats::profiles()) names.emplace_back(profile.name);
  return names;
}

/// Returns the reader of the output. It is not for our own format.
const formats::Recipient& recipient_of(const OutputFormat& output, formats::GraphFormat format) {
  const formats::Recipient* profile = formats::find_profile(output.profile);
  return profile != nullptr ? *profile : formats::any_reader(format);
}

}  // namespace

void add_input_format(CLI::App& command, std::string& format) {
  command
      .add_option("--input-format", format,
                  "graph and g2o are told apart by the first line; toro and covariance (GTSAM's .graph) look "
                  "alike, so they are never guessed")
      ->check(one_of("format", format_names()))
      ->capture_default_str();
}

void add_output_format(CLI::App& command, OutputFormat& output, bool with_profile) {
  command.add_option("--format", output.format, "Format to write: graph (default), g2o, toro, covariance")
      ->check(one_of("format", format_names()));
  if (!with_profile) return;
  command
      .add_option("--profile", output.profile,
                  "Write for the reader of this program; refuse a graph whose minimum would move there")
      ->check(one_of("profile", profile_names()));
}

formats::GraphFormat chosen_format(const OutputFormat& output) {
  const formats::Recipient* profile = formats::find_profile(output.profile);
  if (output.format.empty())
    return profile != nullptr ? profile->formats.front() : formats::GraphFormat::graph;
  const formats::GraphFormat format = *formats::graph_format_from_string(output.format);
  if (profile == nullptr) return format;
  std::string known;
  for (const formats::GraphFormat candidate : profile->formats) {
    if (candidate == format) return format;
    known += (known.empty() ? "" : ", ") + std::string(to_string(candidate));
  }
  throw UsageError("--profile " + output.profile + ": " + std::string(profile->reader) +
                   " does not read the format " + output.format + "; it reads: " + known);
}

formats::GraphDocument read_graph_file(const std::string& text, const std::string& name,
                                       const std::string& format, bool lenient, const TypeRegistry& registry,
                                       const Console& console) {
  formats::ReadReport report;
  formats::GraphDocument document = formats::read_graph_as(*formats::graph_format_from_string(format), text,
                                                           name, registry, lenient, &report);
  console.end_progress();
  if (report.skipped > 0) {
    const std::string skipped = std::to_string(report.skipped) + " lines were skipped";
    document.provenance.emplace_back("warning", skipped);
    console.warning(skipped + "; the first ones:");
    for (const std::string& example : report.examples) console.tell("  " + example);
  }
  if (report.edges_only) console.note("the file has only edges; the initial guess is the odometry chain");
  if (report.apart > 0) console.note(apart_note(report.apart));
  return document;
}

void announce_output(const OutputFormat& output, const formats::GraphDocument& document,
                     const std::string& name, const Console& console) {
  const formats::GraphFormat format = chosen_format(output);
  if (format == formats::GraphFormat::graph) return;
  const formats::Recipient& recipient = recipient_of(output, format);
  const formats::ForeignGraph foreign(document, name, recipient, format);
  for (const std::string& change : foreign.changes()) console.note(change);
  if (const std::string left_out = foreign.left_out(); !left_out.empty()) {
    console.note("left out, as " + std::string(recipient.reader) + " has no place for it: " + left_out);
  }
}

void write_graph_file(const std::string& path, const OutputFormat& output,
                      const formats::GraphDocument& document, const std::string& name,
                      const TypeRegistry& registry) {
  const formats::GraphFormat format = chosen_format(output);
  if (format == formats::GraphFormat::graph) {
    formats::write_file_atomically(
        path, [&](const formats::TextSink& sink) { formats::write_graph(document, registry, sink); });
    return;
  }
  const formats::ForeignGraph foreign(document, name, recipient_of(output, format), format);
  formats::write_file_atomically(path, [&](const formats::TextSink& sink) { foreign.write(sink); });
}

}  // namespace waymark::program
