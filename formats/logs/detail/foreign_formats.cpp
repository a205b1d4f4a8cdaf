#include <waymark/formats/logs/detail/foreign_formats.hpp>

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

namespace waymark::formats {
namespace {

struct ForeignFormat {
  std::string_view name;
  std::string_view remedy;
};

/// A format that is known by bytes at a place.
struct Signature {
  std::size_t at;
  std::string_view bytes;
  ForeignFormat format;
};

// NUL bytes are part of some signatures, so their lengths are stated.
constexpr std::array<Signature, 16> kSignatures{{
    {0, "MDF     ", {"an MF4 (ASAM MDF) file", "asammdf writes CSV from it"}},
    {0, "LOGG", {"a Vector BLF file", "`python3 -m can.logconvert` writes a candump log from it"}},
    {0, "#ROSBAG V1", {"a bag of ROS before 2010", "`rosbag fix` of ROS 1 writes version 2.0 from it"}},
    {0,
     {"SQLite format 3\0", 16},
     {"an SQLite file, such as a ROS 2 bag (db3)", "`ros2 bag convert` writes MCAP from it"}},
    {0, {"\x89MCAP", 5}, {"an MCAP file of a version other than 0", "write it again as version 0"}},
    {0, {"PK\x03\x04", 4}, {"a zip archive", "unpack it first"}},
    {0,
     "BZh",
     {"a bzip2 file, as openpilot's rlog may be",
      "`bzip2 -dk FILE` unpacks it; openpilot's LogReader "
      "writes tables from an rlog"}},
    {0, "$@", {"a Septentrio SBF log", "the SBF Converter of RxTools writes NMEA from it"}},
    {0,
     {"\xAA\x44\x12", 3},
     {"a NovAtel log in binary", "NovAtel Convert writes ASCII from it (BESTPOSA, BESTVELA)"}},
    {0,
     {"\xD3\x00", 2},
     {"a stream of RTCM 3, which has no positions", "RTKLIB's convbin and rnx2rtkp compute them"}},
    {8,
     ".FIT",
     {"a Garmin FIT file", "`gpsbabel -i garmin_fit -f FILE -o gpx -F drive.gpx` writes GPX from it"}},
    {0,
     "MATLAB 5.0 MAT-file",
     {"a MATLAB file", "`writetable` in MATLAB or scipy.io.loadmat writes CSV from it"}},
    {0, {"\x89HDF\r\n\x1A\n", 8}, {"an HDF5 file (or MATLAB 7.3)", "h5py or pandas writes CSV from it"}},
    {0, "PAR1", {"a Parquet file", "`pandas.read_parquet(FILE).to_csv(...)` writes CSV from it"}},
    {0,
     "Time Stamp,ID,Extended,",
     {"SavvyCAN's table of CAN frames", "save it from SavvyCAN as a candump log"}},
    {0, {"\x89PNG", 4}, {"a picture", "it holds no log"}},
}};

/// A text format that is known by words near its beginning.
struct Words {
  std::string_view words;
  ForeignFormat format;
};
constexpr std::array<Words, 4> kWords{{
    {"COMPACT RINEX",
     {"a compact RINEX file (Hatanaka)", "`crx2rnx FILE` of RNXCMP writes plain RINEX from it"}},
    {"RINEX VERSION",
     {"a RINEX file without observations", "a navigation file belongs to an observation file: `navigation: FILE`"}},
    {"<TrainingCenterDatabase",
     {"a TCX file", "`gpsbabel -i gtrnctr -f FILE -o gpx -F drive.gpx` writes GPX from it"}},
    {"<kml", {"a KML file", "`gpsbabel -i kml -f FILE -o gpx -F drive.gpx` writes GPX from it"}},
}};

std::string_view first_line(std::string_view head) {
  return head.substr(0, head.find_first_of("\r\n"));
}

bool is_hex(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

/// "t1238..." of the Lawicel protocol: kind, identifier, length, bytes.
bool is_slcan(std::string_view line) {
  if (line.size() < 5 || std::string_view("tTrR").find(line.front()) == std::string_view::npos) return false;
  const std::size_t digits = line.front() == 't' || line.front() == 'r' ? 3 : 8;
  return line.size() > digits + 1 && is_hex(line.substr(1)) && line[digits + 1] <= '8';
}

/// "AXXX..." of a flight recorder, with fixes "B101355...".
bool is_igc(std::string_view head) {
  return head.starts_with('A') && head.find("\nHFDTE") != std::string_view::npos;
}

/// Swift's binary protocol has no header of a file: a message begins with 0x55, and its type and sender follow.
bool is_sbp(std::string_view head) {
  if (head.size() < 8 || head[0] != '\x55') return false;
  const std::size_t next = 8 + static_cast<unsigned char>(head[5]);
  return head.size() > next && head[next] == '\x55';
}

std::string sentence(const ForeignFormat& format) {
  return fmt::format("it is {}, which is not supported; {}", format.name, format.remedy);
}

}  // namespace

std::optional<std::string> foreign_format(std::string_view head) {
  for (const Signature& signature : kSignatures)
    if (head.size() > signature.at && head.substr(signature.at).starts_with(signature.bytes))
      return sentence(signature.format);
  constexpr std::size_t kNear = 1000;
  for (const Words& known : kWords)
    if (head.substr(0, kNear).find(known.words) != std::string_view::npos) return sentence(known.format);
  if (is_slcan(first_line(head)))
    return sentence(
        {"an slcan log", "`python3 -m can.logger -i slcan` records candump logs; slcan has no stamps"});
  if (is_igc(head))
    return sentence(
        {"an IGC flight log", "`gpsbabel -i igc -f FILE -o gpx -F drive.gpx` writes GPX from it"});
  if (is_sbp(head))
    return sentence({"a log of Swift's binary protocol (SBP)", "`sbp2json` writes JSON from it"});
  return std::nullopt;
}

}  // namespace waymark::formats
