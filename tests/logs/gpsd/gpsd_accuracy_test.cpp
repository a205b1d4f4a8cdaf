#include <catch2/catch.hpp>

#include "logs/gpsd/gpsd_reports.hpp"

namespace gpsd_accuracy_test {

using namespace waymark;
using namespace waymark_test::gpsd_samples;

TEST_CASE("gpsd: which figure a stated meaning reads") {
  LogRequest request = utc_fixes();
  const auto east_variance = [&](AccuracyMeaning meaning, std::string_view text) {
    request.accuracy = meaning;
    return read(text, request).fixes.at(0).covariance_en(0, 0);
  };
  CHECK(east_variance(AccuracyMeaning::one_sigma, kFix) == Approx(16));       // epx
  CHECK(east_variance(AccuracyMeaning::drms, kFix) == Approx(50));            // eph^2 / 2
  CHECK(east_variance(AccuracyMeaning::cep50, kFix) == Approx(72.13475204));  // eph^2 / (2 ln 2)
  const char* radial_only =
      R"({"class":"TPV","mode":2,"time":"2005-06-09T14:34:45Z","lat":1,"lon":2,"eph":10})";
  CHECK(east_variance(AccuracyMeaning::automatic, radial_only) == Approx(50));
  CHECK(east_variance(AccuracyMeaning::percent95, radial_only) == Approx(25));
}

TEST_CASE("gpsd: a report without accuracy takes the stated default, or is corrupt") {
  const std::string text = std::string(kFix) + "\n" +
                           R"({"class":"TPV","mode":2,"time":"2005-06-09T14:34:46Z","lat":1,"lon":2})" + "\n";
  LogRequest request = utc_fixes();
  const LogData strict = read(text, request);
  CHECK(strict.fixes.size() == 1);
  CHECK(strict.corrupt_examples ==
        std::vector<std::string>{
            "log.json:2:1: TPV: the log has no accuracy (0 and less are none): state 'accuracy: {default_sigma: ...}'"});
  request.default_sigma_m = 7;
  CHECK(read(text, request).fixes.at(1).covariance_en(1, 1) == 49);
}

TEST_CASE("gpsd: equal epx and epy throughout are remarked upon") {
  const LogData data =
      read(R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45Z","lat":1,"lon":2,"epx":3,"epy":3})");
  CHECK(data.notes.back() ==
        "log.json: epx equals epy throughout: gpsd 3.11 to 3.18 reports u-blox' hAcc unchanged; "
        "read it with 'drms': sigma would be 2.12 m on average instead of 1.5 m");
}

TEST_CASE("gpsd: a GST object of the same time gives the accuracy, before its TPV or after it") {
  const std::string gst =
      R"({"class":"GST","time":"2005-06-09T14:34:45.280Z","rms":1,"major":8.7,"minor":4.7,)"
      R"("orient":132.3,"lat":6.8,"lon":7.2,"alt":14})"
      "\n";
  const std::string other = R"({"class":"GST","time":"2005-06-09T14:34:46.280Z","lat":1,"lon":1})"
                            "\n";
  const std::string tpv = std::string(kFix) + "\n";
  for (const std::string& text : {gst + tpv, tpv + gst, gst + other + tpv, tpv + gst + other}) {
    const LogData data = read(text);
    const Eigen::Matrix2d& covariance = data.fixes.at(0).covariance_en;
    CHECK(covariance(0, 0) == Approx(7.2 * 7.2));  // lon is the east error, 1 sigma
    CHECK(covariance(1, 1) == Approx(6.8 * 6.8));
    // The ellipse's own off-diagonal: (8.7^2 - 4.7^2) sin cos of its axis, clockwise from north.
    CHECK(covariance(0, 1) == Approx(-26.68).epsilon(0.01));
    CHECK(data.notes ==
          std::vector<std::string>{"log.json: 1 fixes with a GST object, whose errors are 1 sigma; 1 of "
                                   "them with the correlation of its error ellipse"});
  }
  CHECK(read(other + tpv).fixes.at(0).covariance_en(0, 0) == Approx(4));  // of another time
  LogRequest stated = utc_fixes();
  stated.accuracy = AccuracyMeaning::percent95;
  CHECK(read(gst + tpv, stated).fixes.at(0).covariance_en(0, 0) == Approx(4));  // the stated one wins
}

TEST_CASE("gpsd: version and values tell the dialect") {
  const auto note = [](const std::string& release, const std::string& figures) {
    const std::vector<std::string> notes =
        read(R"({"class":"VERSION","release":")" + release + "\"}\n" +
             R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45Z","lat":1,"lon":2,)" + figures + "}\n")
            .notes;
    return notes.size() > 1 ? notes[1] : std::string();
  };
  const std::string equal = R"("epx":10,"epy":10)";
  const std::string dilution = R"("epx":6,"epy":8,"eph":2)";
  CHECK(note("3.10", equal) ==
        "log.json: epx and epy of gpsd before 3.11 are the 3-D accuracy / sqrt(2), a rough 1sigma: sigma "
        "would be 10 m on average instead of 5 m");
  const std::string raw =
      "log.json: epx equals epy throughout: gpsd 3.11 to 3.18 reports u-blox' hAcc unchanged; read "
      "it with 'drms': sigma would be 7.07 m on average instead of 5 m";
  CHECK(note("3.17", equal) == raw);
  CHECK(note("", equal) == raw);
  const std::string since_3_19 =
      "log.json: epx and epy come from the dilution of precision (gpsd since 3.19); eph is the "
      "receiver's own accuracy, if it states one; read it with 'drms': sigma would be 1.41 m on "
      "average instead of 3.5 m";
  CHECK(note("3.22", dilution) == since_3_19);
  CHECK(note("3.20.1~dev", dilution) == since_3_19);
  CHECK(note("unknown", dilution) == since_3_19);
  CHECK(note("3.17", dilution).empty());
  CHECK(note("3.22", equal).empty());
}

TEST_CASE("gpsd: status, the last SKY and dgpsAge are told") {
  const auto told = [](const std::string& members) {
    const std::string text =
        R"({"class":"SKY","device":"/dev/ttyS0","hdop":0.75,"nSat":20,"uSat":12,"satellites":[{"PRN":1}]})"
        "\n"
        R"({"class":"TPV","mode":3,"time":"2005-06-09T14:34:45Z","lat":1,"lon":2,"epx":4,"epy":4)" +
        members + "}\n";
    return read(text).fixes.at(0).told;
  };
  CHECK(told("").quality == FixQuality::unknown);
  CHECK(told(R"(,"status":2)").quality == FixQuality::differential);
  CHECK(told(R"(,"status":3)").quality == FixQuality::fixed);
  CHECK(told(R"(,"status":4)").quality == FixQuality::floating);
  CHECK(told(R"(,"status":5)").quality == FixQuality::dead_reckoned);
  CHECK(told(R"(,"status":8)").quality == FixQuality::simulated);
  CHECK(told(R"(,"status":77)").quality == FixQuality::unknown);
  CHECK(told("").hdop == 0.75);
  CHECK(told("").satellites == 12);
  CHECK(told(R"(,"dgpsAge":1.5)").correction_age_s == 1.5);
}

}  // namespace gpsd_accuracy_test
