// How fast readers are: real samples, repeated in memory to 100 MB. Of a build type that optimises:
// waymark_logs_tests "[.throughput]"
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>

#include <waymark/formats/logs/log_readers.hpp>
#include <waymark/formats/text_file.hpp>

#include "support/paths.hpp"

using namespace waymark;

namespace {

constexpr std::size_t kBytes = 100'000'000;
constexpr std::size_t kPiece = 1U << 20U;

/// The best of three runs, in MB/s.
double megabytes_per_second(const LogReader& reader, const std::string& text) {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  double best = 0;
  for (int run = 0; run < 3; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const auto decoder = reader.open("log", request);
    for (std::size_t k = 0; k < text.size(); k += kPiece) {
      decoder->take(std::string_view(text).substr(k, kPiece));
      decoder->data().fixes.clear();
    }
    decoder->finish();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    best = std::max(best, 1e-6 * static_cast<double>(text.size()) / seconds.count());
  }
  return best;
}

}  // namespace

TEST_CASE("throughput of log readers", "[.throughput]") {
  struct Sample {
    const char* reader;
    const char* file;
  };
  for (const Sample& sample : {Sample{"nmea", "nmea/genivi_munich_Petuelring_2009.nmea"},
                               Sample{"nmea", "nmea/gpsd_ublox-neo-m9n-nmea.log"},
                               Sample{"gpsd_json", "gpsd/gpsd_ublox-glo.log.chk"},
                               Sample{"gpsd_json", "gpsd/gpsd_telit-he910.log.chk"}}) {
    const auto path = waymark_test::shared_data_dir() / "logs" / sample.file;
    if (!std::filesystem::exists(path)) {
      std::cout << "SKIPPED: " << path.string() << " is absent\n";
      return;
    }
    const std::string once = read_text_file(path.string());
    std::string text;
    while (text.size() < kBytes) text += once;
    std::cout << sample.reader << ' ' << sample.file << ": "
              << megabytes_per_second(*builtin_log_reader(sample.reader), text) << " MB/s\n";
  }
}
