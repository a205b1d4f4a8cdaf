#include <waymark/formats/logs/detail/common/log_request.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>

namespace waymark::formats {
namespace {

std::string_view samples_of(StreamKind stream) {
  switch (stream) {
    case StreamKind::odometry:
      return "odometry";
    case StreamKind::gnss:
      return "fixes";
    case StreamKind::truth:
      return "truth";
    case StreamKind::sensor:
      return "sensor readings";
  }
  return "samples";
}

/// "gnss and truth", "odometry, gnss and truth".
std::string listed(std::initializer_list<StreamKind> streams) {
  std::string text;
  for (const StreamKind* stream = streams.begin(); stream != streams.end(); ++stream) {
    if (stream != streams.begin()) text += stream + 1 == streams.end() ? " and " : ", ";
    text += to_string(*stream);
  }
  return text;
}

}  // namespace

void require_streams(const std::string& path, const LogRequest& request, std::string_view format,
                     std::initializer_list<StreamKind> given) {
  if (std::find(given.begin(), given.end(), request.stream) != given.end()) return;
  throw InputError(fmt::format("{}: {} holds no {}; it gives the streams {}", path, format,
                               samples_of(request.stream), listed(given)));
}

void require_no_columns(const std::string& path, const LogRequest& request, std::string_view format) {
  if (!request.columns.empty())
    throw InputError(fmt::format("{}: {} has no columns to map; leave out 'columns'", path, format));
}

void require_companions(const std::string& path, const LogRequest& request, std::string_view format,
                        std::string_view known) {
  for (const auto& [name, file] : request.companions) {
    if (name != known)
      throw InputError(fmt::format("{}: {} takes no '{}' file; leave it out", path, format, name));
  }
}

void require_positions(const std::string& path, const LogRequest& request, std::string_view format) {
  require_streams(path, request, format, {StreamKind::gnss, StreamKind::truth});
  require_no_columns(path, request, format);
  require_companions(path, request, format);
}

}  // namespace waymark::formats
