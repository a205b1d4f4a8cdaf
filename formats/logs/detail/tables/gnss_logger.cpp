#include <waymark/formats/logs/detail/tables/gnss_logger.hpp>

#include <array>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/kind_tally.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/tables/table_inside.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {
namespace {

constexpr std::string_view kFixNames = "# Fix,Provider,";
constexpr std::string_view kFix = "Fix,";
/// The tag's column is named too, as the rows have it.
constexpr std::size_t kBeforeNames = 2;

const std::array<KnownColumn, 9> kPhoneColumns{{
    {"time", "ms", "", {"UnixTimeMillis", "(UTC)TimeInMs"}},
    {"latitude", "deg", "", {"LatitudeDegrees", "Latitude"}},
    {"longitude", "deg", "", {"LongitudeDegrees", "Longitude"}},
    {"height", "m", "", {"AltitudeMeters", "Altitude"}},
    {"speed", "m/s", "", {"SpeedMps", "Speed"}},
    {"speed_accuracy", "m/s", "", {"SpeedAccuracyMps"}},
    {"course", "deg", "", {"BearingDegrees"}},
    {"course_accuracy", "deg", "", {"BearingAccuracyDegrees"}},
    {"accuracy", "m", "", {"AccuracyMeters", "Accuracy"}},
}};

class GnssLoggerDecoder final : public TableInside {
 public:
  using TableInside::TableInside;

 private:
  void take_line(std::string_view line, std::size_t number) override;
  void end() override;

  KindTally fixes_;
};

void GnssLoggerDecoder::take_line(std::string_view line, std::size_t number) {
  if (line.starts_with(kFixNames) && !is_open()) {
    LogRequest inner = request();
    if (!inner.where) inner.where = RowFilter{"Provider", "GPS", true};
    open_table(line.substr(kBeforeNames), number, kPhoneColumns, ',', TimeScale::utc, std::move(inner));
  }
  if (!line.starts_with(kFix)) return;
  if (!is_open())
    throw InputError(fmt::format(
        "{}:{}: a fix before the comment '# Fix,Provider,...' that names its columns", path(), number));
  const std::string_view provider = line.substr(kFix.size(), line.find(',', kFix.size()) - kFix.size());
  fixes_.add(provider);
  // Older versions of the app write "gps".
  give_row(lower_case(provider) == "gps"
               ? fmt::format("Fix,GPS{}", line.substr(kFix.size() + provider.size()))
               : std::string(line),
           number);
}

void GnssLoggerDecoder::end() {
  if (!is_open())
    throw InputError(
        path() +
        ": the log names no columns of fixes ('# Fix,Provider,...'); its raw measurements are not read");
  finish_table();
  data_.kinds = fixes_.counts();
  if (data_.records > 0) return;
  std::string providers;
  for (const auto& [name, count] : data_.kinds)
    providers += fmt::format("{}{} ({})", providers.empty() ? "" : ", ", shown_name(name), count);
  throw InputError(providers.empty()
                       ? path() + ": the log has no line 'Fix,...'; its raw measurements are not read"
                       : fmt::format("{}: no fix of the provider that is read; the log has {}: state for "
                                     "example 'where: Provider == {}'",
                                     path(), providers, shown_name(data_.kinds.begin()->first)));
}

}  // namespace

std::unique_ptr<LogDecoder> GnssLoggerReader::open(const std::string& path, const LogRequest& request) const {
  require_streams(path, request, "a GnssLogger log", {StreamKind::gnss, StreamKind::truth});
  require_companions(path, request, "a GnssLogger log");
  return std::make_unique<GnssLoggerDecoder>(path, request);
}

Recognition GnssLoggerReader::recognise(std::string_view head) const {
  if (head.find(kFixNames) == std::string_view::npos) return {};
  return {0.95, "a comment names the columns of Android's GnssLogger"};
}

}  // namespace waymark::formats
