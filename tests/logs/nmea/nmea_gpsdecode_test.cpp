// Our decoders against gpsd's, on recordings of real receivers. gpsdecode 3.22 differs in this:
// - it does not report the first epoch, from which it learns the receiver's cycle, nor the position of a GLL
//   that stands alone;
// - it moves dates by 1024 weeks if it takes them for dates before a rollover of the GPS week;
// - it rounds: a time to 1 ms, a position to 1e-9 degrees (0.1 mm), a height to 1e-4 m, a speed to 1e-3 m/s,
//   a course to 1e-4 degrees, an error to 1e-3 m;
// - a fix from fewer than three satellites is none.
// Its epx and epy are from GST if the log has it, else from the dilution of precision, which we do not
// make an accuracy of unasked: the GST objects are compared.
#include "logs/gpsd/gpsdecode.hpp"

#include <catch2/catch.hpp>

#include <waymark/formats/logs/detail/nmea/nmea.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "support/paths.hpp"
#include "support/skip.hpp"

namespace nmea_gpsdecode_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;

namespace {

struct NmeaLog {
  const char* name;
  std::size_t only_ours;   ///< fixes that gpsdecode does not report
  std::size_t accuracies;  ///< GST objects with errors and a date
  bool date_moved;         ///< by gpsdecode
  bool status;             ///< gpsd tells one: corrections, RTK
};
constexpr NmeaLog kNmeaLogs[] = {
    {"genivi_munich_Petuelring_2009.nmea", 26, 0, true, false},  // 25 of two satellites
    {"gpsd_gr8013-w.log", 1, 3, true, false},
    {"gpsd_mt3339.log", 1, 0, true, true},
    {"gpsd_neo-m8n.log", 2, 0, true, false},  // begins within an epoch, with a GLL
    {"gpsd_nmea-fuzzy-cases.log", 1, 0, false, true},
    {"gpsd_polarx2.log", 1, 4, true, false},
    {"gpsd_quectel-L70.log", 1, 16, false, true},
    {"gpsd_st-teseo-liv3f.log", 2, 0, false, true},
    {"gpsd_ublox-8.log", 1, 0, false, false},
    {"gpsd_ublox-neo-m9n-nmea.log", 1, 61, false, true},
};

std::filesystem::path nmea_log(const std::string& name) {
  return shared_data_dir() / "logs" / "nmea" / name;
}

std::vector<GeodeticFix> nmea_fixes(const std::filesystem::path& path) {
  LogRequest request;
  request.time_scale = TimeScale::utc;
  request.default_sigma_m = 10;
  return NmeaReader().read(read_text_file(path.string()), path.filename().string(), request).fixes;
}

/// Differences no larger than the rounding of gpsd's output.
void check_rounding_only(const Comparison& comparison) {
  CHECK(comparison.position_m < 0.0001);
  CHECK(comparison.height_m < 0.00006);
  CHECK(comparison.time_s < 0.00051);
  CHECK(comparison.speed_mps < 0.00051);
  CHECK(comparison.course_deg < 0.00006);
  CHECK(comparison.accuracy_m < 0.00051);
}

}  // namespace

TEST_CASE("gpsdecode: NMEA fixes agree to its rounding, and so do quality, HDOP and age of corrections") {
  std::size_t ages = 0;
  std::size_t same_hdop = 0;
  for (const NmeaLog& log : kNmeaLogs) {
    const auto objects = run_gpsdecode(nmea_log(log.name));
    if (!objects) return;
    INFO(log.name);
    const Comparison comparison = compare_with_gpsd(nmea_fixes(nmea_log(log.name)), *objects);
    CHECK(comparison.matched == comparison.theirs);
    CHECK(comparison.ours - comparison.matched == log.only_ours);
    CHECK(comparison.accuracies == log.accuracies);
    CHECK(comparison.other_dates == (log.date_moved ? comparison.matched : 0));
    check_rounding_only(comparison);
    CHECK(comparison.qualities == (log.status ? comparison.matched : 0));
    CHECK(comparison.other_qualities == 0);
    CHECK(comparison.age_s == 0);
    ages += comparison.ages;
    same_hdop += comparison.same_hdop;
    // gpsd has the dilution of GSA, where a log has none of an epoch that of the one before.
    CHECK(comparison.other_hdop <= 2);
  }
  CHECK(ages == 13);
  CHECK(same_hdop > 2000);
}

TEST_CASE("gpsdecode: gpsd's own regression output of a recording agrees with its NMEA fixes") {
  const auto output = waymark_test::shared_data("logs/gpsd/gpsd_neo-m8n.log.chk");
  if (!output) return;
  const Comparison comparison =
      compare_with_gpsd(nmea_fixes(nmea_log("gpsd_neo-m8n.log")), gpsd_objects(read_text_file(*output)));
  CHECK(comparison.matched == 22);
  CHECK(comparison.theirs == 22);
  CHECK(comparison.other_dates == 22);  // 2034 for 2015
  check_rounding_only(comparison);
}

}  // namespace nmea_gpsdecode_test
