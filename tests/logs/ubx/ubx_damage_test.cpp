#include <catch2/catch.hpp>

#include "logs/ubx/ubx_epochs.hpp"

namespace ubx_damage_test {

using namespace waymark;
using namespace waymark_test;
using namespace waymark_test::ubx_samples;

TEST_CASE("ubx: what is corrupt is told with its place") {
  CHECK(decode(pvt_frame(nav_pvt().u32(28, 900'000'001))).corrupt_examples ==
        Notes{"log.ubx:byte 0: the position 90.0000001, 12.25 is outside -90 .. 90, -180 .. 180"});
  CHECK(decode(pvt_frame(nav_pvt().u32(0, 604'800'000))).corrupt_examples ==
        Notes{"log.ubx:byte 0: iTOW 604800000 ms lies beyond the end of a week"});
  CHECK(decode("junk" + ubx_frame(0x0107, std::string(83, 'x'))).corrupt_examples ==
        Notes{"log.ubx:byte 4: NAV-PVT: 83 bytes, but the message has at least 84"});
  CHECK(decode(ubx_frame(0x0107, "")).corrupt == 0);  // a poll

  std::string wrong = pvt_frame(nav_pvt());
  wrong[30] ^= 1;
  const std::string good = pvt_frame(nav_pvt(1));
  const LogData data = read("$GPGGA,1*00\r\n" + wrong + good);
  CHECK(data.fixes.size() == 1);
  CHECK(data.fixes[0].line == 1);
  CHECK(data.records == 2);
  CHECK(data.corrupt_examples == Notes{"log.ubx:byte 13: NAV-PVT: the checksum is wrong"});
  CHECK(has_note(data, "113 bytes that belong to no UBX frame were skipped"));

  const LogData cut = read(good + good.substr(0, 50));
  CHECK(cut.fixes.size() == 1);
  CHECK(cut.corrupt_examples == Notes{"log.ubx:byte 100: NAV-PVT: the log ends within the message"});
}

TEST_CASE("ubx: a corrupt length swallows no frames") {
  const std::string good = pvt_frame(nav_pvt()) + pvt_frame(nav_pvt(1)) + pvt_frame(nav_pvt(2));
  for (const int length : {93, 200, 8192, 8193, 0xFFFF}) {
    std::string wrong = pvt_frame(nav_pvt());
    wrong[4] = static_cast<char>(length & 0xFF);
    wrong[5] = static_cast<char>(length >> 8);
    const LogData data = read(wrong + good);
    CHECK(data.fixes.size() == 3);
    CHECK(data.corrupt == 1);
    CHECK(data.corrupt_examples.at(0).starts_with("log.ubx:byte 0: NAV-PVT: "));
    if (length > 8192)
      CHECK(data.corrupt_examples[0] ==
            "log.ubx:byte 0: NAV-PVT: no message has a length of " + std::to_string(length) + " bytes");
  }
  // Sync bytes by chance in other binary data are no record: no class of the protocol follows.
  const LogData data = read(std::string("\xB5\xB5\x62\x77\x07\x02\x00", 7) + good + "\xB5");
  CHECK(data.fixes.size() == 3);
  CHECK(data.corrupt == 0);
}

TEST_CASE("ubx: what cannot be read at all is an error that says why") {
  CHECK_THROWS_MATCHES(read(""), InputError, Message("log.ubx: the log holds no records"));
  CHECK_THROWS_MATCHES(read("$GPGGA,1*00\r\n"), InputError, Message("log.ubx: the log holds no records"));
  LogRequest request;
  request.columns["time"] = {"t", "", ""};
  CHECK_THROWS_MATCHES(
      read("", request), InputError,
      Message("log.ubx: a UBX log has no column for 'time'; only 'position' may be stated, as "
              "'NAV-PVT' (all navigation messages) or 'HNR-PVT'"));
  request.columns = {{"position", {"NAV-SOL", "", ""}}};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: 'position' of a UBX log is 'NAV-PVT' (all navigation messages) or "
                               "'HNR-PVT', got 'NAV-SOL'"));
  request.columns.clear();
  request.gps_week = -1;
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: week -1 is outside 0 .. 10000 (time: {week: ...})"));
  request.gps_week = 0;
  request.companions["dbc"] = {{"a.dbc", ""}};
  CHECK_THROWS_MATCHES(read("", request), InputError,
                       Message("log.ubx: a UBX log takes no 'dbc' file; leave it out"));
}

TEST_CASE("ubx: a log is known by its frames") {
  const auto certainty = [](std::string_view head) { return UbxReader().recognise(head).certainty; };
  const std::string pvt = pvt_frame(nav_pvt());
  CHECK(certainty("") == 0);
  CHECK(certainty("$GPGGA,1*00\r\n") == 0);
  CHECK(certainty(pvt) == Approx(0.9));
  std::string mixed;
  for (int i = 0; i < 3; ++i)
    mixed += "$GPGGA,of,NMEA,there,is,much,more,than,of,UBX" + std::string(900, ',') + pvt;
  CHECK(certainty(mixed) == 1);
  CHECK(UbxReader().recognise(mixed).evidence ==
        "3 UBX frames with a right checksum, 3 of them with a position or raw measurements");
  const std::string silent = nav_eoe(1) + nav_eoe(2) + nav_eoe(3);
  CHECK(certainty(silent + std::string(36, ' ')) == Approx(0.45));
}

}  // namespace ubx_damage_test
