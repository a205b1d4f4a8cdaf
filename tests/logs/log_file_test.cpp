// Files: compressed and damaged ones, foreign formats, and the text of every error.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/log_file.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "support/paths.hpp"

namespace log_file_test {

using namespace waymark;
using namespace waymark::formats;
using Catch::Matchers::Message;

namespace {

std::string file_with(const std::string& name, const std::string& content) {
  const std::string path = (waymark_test::scratch_dir() / name).string();
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// NMEA fixes a second apart, each line another.
std::string nmea_log(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    std::string sentence = "GPRMC,";
    for (const int part : {k / 3600, k / 60 % 60, k % 60}) {
      sentence += static_cast<char>('0' + part / 10);
      sentence += static_cast<char>('0' + part % 10);
    }
    sentence += ",A,4807." + std::to_string(1000 + k * 7919 % 9000) + ",N,01131.0000,E,022.4,084.4,230394,,";
    unsigned sum = 0;
    for (const char c : sentence) sum ^= static_cast<unsigned char>(c);
    constexpr const char* kDigits = "0123456789ABCDEF";
    text += '$' + sentence + '*' + kDigits[sum >> 4U] + kDigits[sum & 15U] + "\r\n";
  }
  return text;
}

std::string gzip_of(const std::string& name, const std::string& text) {
  const std::string path = (waymark_test::scratch_dir() / name).string();
  gzFile file = ::gzopen(path.c_str(), "wb");
  REQUIRE(::gzwrite(file, text.data(), static_cast<unsigned>(text.size())) == static_cast<int>(text.size()));
  ::gzclose(file);
  return path;
}

std::string xz_of(const std::string& text) {
  std::string packed(::lzma_stream_buffer_bound(text.size()), '\0');
  std::size_t size = 0;
  REQUIRE(::lzma_easy_buffer_encode(
              6, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
              reinterpret_cast<std::uint8_t*>(packed.data()), &size, packed.size()) == LZMA_OK);
  packed.resize(size);
  return packed;
}

std::string zstd_of(const std::string& text) {
  std::string packed(::ZSTD_compressBound(text.size()), '\0');
  ZSTD_CCtx* const context = ::ZSTD_createCCtx();
  ::ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);  // as the program zstd does
  packed.resize(::ZSTD_compress2(context, packed.data(), packed.size(), text.data(), text.size()));
  ::ZSTD_freeCCtx(context);
  return packed;
}

std::string all_of(const std::string& path) {
  std::string all;
  CHECK(read_in_pieces(path, [&](std::string_view piece) { all += piece; }).empty());
  return all;
}

LogRequest request() {
  LogRequest result;
  result.default_sigma_m = 5;
  return result;
}

LogData read(const std::string& path) {
  return read_log_file(*builtin_log_reader("nmea"), path, request());
}

}  // namespace

TEST_CASE("log files: a compressed log is known by its first bytes, whatever it is called") {
  const std::string text = nmea_log(500);
  const std::string path = gzip_of("compressed.nmea", text);
  REQUIRE(content_of(path).size() < text.size());
  std::string all;
  CHECK(read_in_pieces(path, [&](std::string_view piece) { all += piece; }).empty());
  CHECK(all == text);
  CHECK(read(path).fixes.size() == 500);
  CHECK(recognise_log(path, builtin_log_readers()).reader.name == "nmea");
}

TEST_CASE("log files: a compressed log that is cut gives what came before, and one corrupt record says so") {
  const std::string whole = content_of(gzip_of("whole.gz", nmea_log(5000)));
  const std::string path = file_with("cut.nmea.gz", whole.substr(0, whole.size() / 2));
  const LogData data = read(path);
  CHECK(data.fixes.size() > 1000);
  CHECK(data.fixes.size() < 5000);
  CHECK(data.corrupt_examples.at(0) == path + ": the compressed file is cut off; the part before is used");
  CHECK(data.corrupt >= 1);
}

TEST_CASE("log files: a cut file with many corrupt lines describes no more of them than others do") {
  std::string text = nmea_log(2000);
  for (std::size_t at = text.find('*'); at != std::string::npos; at = text.find('*', at + 500))
    text[at + 1] = 'Z';
  const std::string whole = content_of(gzip_of("many.gz", text));
  const LogData data = read(file_with("many_cut.gz", whole.substr(0, whole.size() * 3 / 4)));
  CHECK(data.corrupt > kCorruptExamples);
  REQUIRE(data.corrupt_examples.size() == kCorruptExamples);
  CHECK(data.corrupt_examples[0].find("cut off") != std::string::npos);
}

TEST_CASE("log files: a damaged compressed log gives what came before, and says what zlib says") {
  std::string damaged = content_of(gzip_of("sound.gz", nmea_log(5000)));
  for (std::size_t i = damaged.size() / 2; i < damaged.size() / 2 + 40; ++i) damaged[i] = '\xFF';
  const std::string path = file_with("damaged.nmea.gz", damaged);
  const LogData data = read(path);
  CHECK(data.fixes.size() > 1000);
  CHECK(data.fixes.size() < 5000);
  CHECK(data.corrupt >= 1);
  const std::string first = data.corrupt_examples.at(0);
  CHECK(first.rfind(path + ": the compressed file is damaged (", 0) == 0);
  CHECK(first.find("<fd:") == std::string::npos);
  CHECK(first.ends_with("); the part before is used"));
}

TEST_CASE(
    "log files: xz and zstd are known by their first bytes too, and their damage is told as that of gzip") {
  const std::string text = nmea_log(5000);
  const auto [name, whole] =
      GENERATE(table<std::string, std::string (*)(const std::string&)>({{"xz", xz_of}, {"zst", zstd_of}}));
  const std::string packed = whole(text);
  REQUIRE(packed.size() < text.size() / 2);
  const std::string path = file_with("packed_" + name, packed);
  CHECK(all_of(path) == text);
  CHECK(read(path).fixes.size() == 5000);
  // Several files of one kind behind each other are one, as their programs have it.
  CHECK(all_of(file_with("twice_" + name, packed + packed)) == text + text);

  const std::string cut = file_with("cut_" + name, packed.substr(0, packed.size() / 2));
  const LogData before = read(cut);
  CHECK(before.fixes.size() > 1000);
  CHECK(before.fixes.size() < 5000);
  CHECK(before.corrupt_examples.at(0) == cut + ": the compressed file is cut off; the part before is used");

  std::string bytes = packed;
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i) bytes[i] = '\xFF';
  const std::string damaged = file_with("damaged_" + name, bytes);
  const std::string first = read(damaged).corrupt_examples.at(0);
  CHECK(first.starts_with(damaged + ": the compressed file is damaged ("));
}

TEST_CASE("log files: a gzip file of several members is one text, and what follows them is left") {
  const std::string member = content_of(gzip_of("member.gz", "first\n"));
  const std::string other = content_of(gzip_of("other.gz", "second\n"));
  CHECK(all_of(file_with("members.gz", member + other)) == "first\nsecond\n");
  CHECK(all_of(file_with("padded.gz", member + std::string(100, '\0'))) == "first\n");
}

TEST_CASE("log files: a compressed log of which nothing is left") {
  const std::string head = content_of(gzip_of("head.gz", nmea_log(100))).substr(0, 14);
  const std::string path = file_with("nothing.gz", head);
  CHECK_THROWS_MATCHES(recognise_log(path, builtin_log_readers()), InputError,
                       Message(path + ": the compressed file is cut off; the part before is used"));
  CHECK_THROWS_MATCHES(read(path), InputError,
                       Message(path + ": none of 1 records could be used; first: " + path +
                               ": the compressed file is cut off; the part before is used"));
}

TEST_CASE("log files: what cannot be read is named with the system's reason") {
  const std::string path = (waymark_test::scratch_dir() / "absent.log").string();
  for (const auto& act : std::vector<std::function<void()>>{
           [&] { (void)read(path); }, [&] { (void)recognise_log(path, builtin_log_readers()); }})
    CHECK_THROWS_MATCHES(act(), InputError, Message(path + ": cannot read: No such file or directory"));
}

TEST_CASE("log files: a folder is its files in order of name, each beginning with a new line") {
  const std::filesystem::path folder = waymark_test::scratch_dir() / "parts";
  std::filesystem::create_directories(folder);
  CHECK_THROWS_MATCHES(read(folder.string()), InputError,
                       Message(folder.string() + ": the folder holds no files"));
  (void)file_with("parts/b", "second\n");
  (void)file_with("parts/a", "first");
  std::string all;
  CHECK(read_in_pieces(folder.string(), [&](std::string_view piece) { all += piece; }).empty());
  CHECK(all == "first\nsecond\n");
}

TEST_CASE("log files: a format that is not read is named with what converts it") {
  const auto refusal = [](const std::string& content) -> std::string {
    const std::string path = file_with("unknown.log", content);
    try {
      (void)recognise_log(path, builtin_log_readers());
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(std::min(text.size(), path.size()));
    }
    return "recognised";
  };
  const std::string start = ": the log's format is not recognised: ";
  CHECK(refusal("") == ": the log is empty");
  CHECK(refusal("MDF     4.10") ==
        start + "it is an MF4 (ASAM MDF) file, which is not supported; asammdf writes CSV from it");
  CHECK(refusal("LOGG\x90") ==
        start +
            "it is a Vector BLF file, which is not supported; `python3 -m can.logconvert` writes a "
            "candump log from it");
  CHECK(refusal("#ROSBAG V1.2\n") ==
        start +
            "it is a bag of ROS before 2010, which is not supported; `rosbag fix` of ROS 1 writes "
            "version 2.0 from it");
  CHECK(
      refusal("\x89MCAP1\r\n") ==
      start +
          "it is an MCAP file of a version other than 0, which is not supported; write it again as version 0");
  CHECK(refusal("PK\x03\x04") == start + "it is a zip archive, which is not supported; unpack it first");
  CHECK(refusal("     3.04           N: GNSS NAV DATA    M: MIXED            RINEX VERSION / TYPE\n") ==
        start +
            "it is a RINEX file without observations, which is not supported; a navigation file belongs to "
            "an observation file: `navigation: FILE`");
  CHECK(refusal("1.0                 COMPACT RINEX FORMAT                    CRINEX VERS   / TYPE\n") ==
        start +
            "it is a compact RINEX file (Hatanaka), which is not supported; `crx2rnx FILE` of RNXCMP writes "
            "plain RINEX from it");
  const auto names = [&](std::string_view head, std::string_view what) {
    const std::string text = refusal(std::string(head));
    return text.starts_with(start + "it is " + std::string(what) + ", which is not supported; ");
  };
  CHECK(names({"SQLite format 3\0....", 20}, "an SQLite file, such as a ROS 2 bag (db3)"));
  CHECK(names("BZh91AY", "a bzip2 file, as openpilot's rlog may be"));
  CHECK(names("$@\x12\x34", "a Septentrio SBF log"));
  CHECK(names({"\x55\x0a\x02\x00\x01\x02zz..\x55", 11}, "a log of Swift's binary protocol (SBP)"));
  CHECK(names({"\xD3\x00\x13\x3E", 4}, "a stream of RTCM 3, which has no positions"));
  CHECK(names({"\xAA\x44\x12\x1C", 4}, "a NovAtel log in binary"));
  CHECK(names({"\x0E\x20\x00\x00\x00\x00\x00\x00.FIT", 12}, "a Garmin FIT file"));
  CHECK(names("<?xml version=\"1.0\"?>\n<TrainingCenterDatabase xmlns=", "a TCX file"));
  CHECK(names("<?xml version=\"1.0\"?>\n<kml xmlns=", "a KML file"));
  CHECK(names("AXCS001\nHFDTE010420\nB1200004810850N01133909EA0050000550\n", "an IGC flight log"));
  CHECK(names("MATLAB 5.0 MAT-file, Platform: GLNXA64", "a MATLAB file"));
  CHECK(names("\x89HDF\r\n\x1A\n", "an HDF5 file (or MATLAB 7.3)"));
  CHECK(names("PAR1\x15", "a Parquet file"));
  CHECK(names("Time Stamp,ID,Extended,Dir,Bus,LEN,D1\n1,00000100,false,Rx,0,1,FF\n",
              "SavvyCAN's table of CAN frames"));
  CHECK(names("t12340011223\rt1230\r", "an slcan log"));
  CHECK(refusal("nothing that anyone knows\n") ==
        start + "state its 'format'; `waymark info` lists all formats");
}

TEST_CASE("log files: a table in UTF-16 is one in UTF-8") {
  const std::string table =
      "time,latitude,longitude,accuracy,Stra\xC3\x9F"
      "e \xF0\x9F\x9A\x97\n1,50,8,2,a\n";
  const std::u16string units = u"\uFEFFtime,latitude,longitude,accuracy,Stra\u00DFe \U0001F697\n1,50,8,2,a\n";
  for (const bool little : {true, false}) {
    std::string text;
    for (const char16_t unit : units) {
      const char low = static_cast<char>(unit & 0xFF);
      const char high = static_cast<char>(unit >> 8);
      text += little ? std::string{low, high} : std::string{high, low};
    }
    std::string read;
    const std::string path = file_with("utf16.csv", text);
    CHECK(read_in_pieces(path, [&](std::string_view piece) { read += piece; }).empty());
    CHECK(read == table);
    CHECK(recognise_log(path, builtin_log_readers()).reader.name == "csv");
  }
}

TEST_CASE("log files: two readers that are equally sure are both named") {
  class Sure final : public WholeLogReader {
   public:
    [[nodiscard]] LogData read_whole(std::string_view, const std::string&, const LogRequest&) const override {
      return {};
    }
    [[nodiscard]] Recognition recognise(std::string_view) const override { return {0.5, "always"}; }
  };
  const Sure one;
  const std::vector<LogReaderType> readers{{"first", "", &one}, {"second", "", &one}};
  const std::string path = file_with("either.log", "anything\n");
  CHECK_THROWS_MATCHES(recognise_log(path, readers), InputError,
                       Message(path + ": the log may be 'first' or 'second'; state its 'format'"));
}

}  // namespace log_file_test
