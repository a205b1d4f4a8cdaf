#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/program/commands/commands.hpp>
#include <waymark/tools/program/terminal/desktop.hpp>
#include <waymark/tools/program/terminal/output.hpp>

namespace waymark::program {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  CommonOptions common;
  std::string place;
};

/// Returns the pages of a folder; a page that is about all others comes first.
std::vector<std::string> pages_in(const std::string& folder) {
  std::vector<std::string> pages;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".html") pages.push_back(entry.path().string());
  if (error) throw InputError(folder + ": cannot read: " + error.message());
  std::sort(pages.begin(), pages.end());
  std::stable_partition(pages.begin(), pages.end(), [](const std::string& page) {
    const std::string stem = fs::path(page).stem().string();
    return stem == evaluation::ResultFolder::kReport || stem == evaluation::ResultFolder::kComparison;
  });
  return pages;
}

/// Returns the absolute path of the page to show.
std::string page_of(const std::string& place) {
  std::string page = place;
  if (fs::is_directory(place)) {
    const std::vector<std::string> pages = pages_in(place);
    if (pages.empty())
      throw InputError(place + ": has no report; 'waymark run DRIVE.yaml --out " + place + "' writes one");
    page = pages.front();
  } else if (!fs::is_regular_file(place) || fs::path(place).extension() != ".html") {
    throw InputError(place + ": is neither a folder of results nor a page (.html)");
  }
  return fs::canonical(page).string();
}

ExitCode view(const ViewOptions& options) {
  const Console console(options.common);
  const std::string page = page_of(options.place);
  const bool opened = open_on_desktop(page);
  if (!opened) console.note("no desktop opens it here: open the page in any browser");
  console.result(options.common.json ? json_document("view", {{"page", page}, {"opened", opened}})
                                     : page + "\n");
  return kSuccess;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("view",
                         "Open the report of a result folder in the browser\n\n"
                         "Prints the path of the page, and opens it with the desktop's browser if "
                         "there is one. The page is one file and needs no server.");
  const auto options = std::make_shared<ViewOptions>();
  command
      ->add_option("folder", options->place, "Folder of 'run', 'evaluate', 'compare', ..., or a page in it")
      ->required()
      ->type_name("DIR|PAGE.html");
  add_common_options(*command, options->common);
  command->footer("Example:\n  waymark view results");
  command->callback([options, &action] { action = [options] { return view(*options); }; });
}

}  // namespace waymark::program
