#include <waymark/formats/logs/detail/rinex/rinex.hpp>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/detail/common/line_decoder.hpp>
#include <waymark/formats/logs/detail/common/log_request.hpp>
#include <waymark/formats/logs/detail/raw/raw_rows.hpp>
#include <waymark/formats/logs/detail/rinex/rinex_observations.hpp>

namespace waymark::formats {
namespace {

class RinexDecoder final : public LineDecoder {
 public:
  RinexDecoder(const std::string& path, const LogRequest& request)
      : LineDecoder(path, request),
        observations_(path, {[this](const satellites::RawEpoch& epoch) { take_epoch(epoch); },
                             [this](std::size_t line, std::size_t column, const std::string& what) {
                               ++data_.records;
                               corrupt(line, column, what);
                             }}),
        rows_(path, this->request(), data_) {}

 protected:
  void take_line(std::string_view line, std::size_t number) override {
    observations_.take_line(line, number);
  }
  void end() override;

 private:
  void take_epoch(const satellites::RawEpoch& epoch) {
    if (observations_.stated_place()) rows_.state_place(*observations_.stated_place());
    rows_.take(epoch);
  }

  RinexObservations observations_;
  RawRows rows_;
};

void RinexDecoder::end() {
  observations_.finish();
  rows_.finish();
  if (observations_.unused() > 0)
    note(fmt::format("{} measurements have no pseudorange of a first frequency, or are of another system",
                     observations_.unused()));
  if (observations_.events() > 0) note(fmt::format("{} event records were skipped", observations_.events()));
}

}  // namespace

std::unique_ptr<LogDecoder> RinexReader::open(const std::string& path, const LogRequest& request) const {
  if (request.stream == StreamKind::gnss)
    throw InputError(
        fmt::format("{}: a RINEX file of observations holds no fixes but pseudoranges; name the broadcast "
                    "ephemerides beside it, 'navigation: FILE'",
                    path));
  require_streams(path, request, "a RINEX file of observations", {StreamKind::sensor});
  require_no_columns(path, request, "a RINEX file of observations");
  require_companions(path, request, "a RINEX file of observations", "navigation");
  if (!request.companions.contains("navigation"))
    throw InputError(
        fmt::format("{}: the satellites of a RINEX file need broadcast ephemerides; name them with "
                    "'navigation: FILE' (one file or a list)",
                    path));
  return std::make_unique<RinexDecoder>(path, request);
}

Recognition RinexReader::recognise(std::string_view head) const {
  const std::optional<RinexVersion> version = rinex_version(head.substr(0, head.find_first_of("\r\n")));
  if (!version || version->kind != 'O') return {};
  return {1, fmt::format("the first line is that of RINEX {:.2f} observations", version->version)};
}

}  // namespace waymark::formats
