#include <waymark/formats/logs/detail/ubx/ubx_frames.hpp>

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kHeader = 6;
constexpr std::size_t kFrame = kHeader + 2;  // with the checksum and without a payload
constexpr char kSync1 = '\xB5';
constexpr char kSync2 = '\x62';

/// NAV RXM INF ACK CFG UPD MON AID TIM ESF MGA LOG SEC HNR NAV2
constexpr std::array<unsigned, 15> kClasses{0x01, 0x02, 0x04, 0x05, 0x06, 0x09, 0x0A, 0x0B,
                                            0x0D, 0x10, 0x13, 0x21, 0x27, 0x28, 0x29};

struct Name {
  std::uint16_t key;
  const char* name;
};
constexpr std::array<Name, 49> kMessageNames{{
    {0x0101, "NAV-POSECEF"},   {0x0102, "NAV-POSLLH"},  {0x0103, "NAV-STATUS"},    {0x0104, "NAV-DOP"},
    {0x0105, "NAV-ATT"},       {0x0106, "NAV-SOL"},     {0x0107, "NAV-PVT"},       {0x0109, "NAV-ODO"},
    {0x0111, "NAV-VELECEF"},   {0x0112, "NAV-VELNED"},  {0x0113, "NAV-HPPOSECEF"}, {0x0114, "NAV-HPPOSLLH"},
    {0x0120, "NAV-TIMEGPS"},   {0x0121, "NAV-TIMEUTC"}, {0x0122, "NAV-CLOCK"},     {0x0123, "NAV-TIMEGLO"},
    {0x0124, "NAV-TIMEBDS"},   {0x0125, "NAV-TIMEGAL"}, {0x0126, "NAV-TIMELS"},    {0x0130, "NAV-SVINFO"},
    {0x0132, "NAV-SBAS"},      {0x0134, "NAV-ORB"},     {0x0135, "NAV-SAT"},       {0x0136, "NAV-COV"},
    {0x013C, "NAV-RELPOSNED"}, {0x0143, "NAV-SIG"},     {0x0161, "NAV-EOE"},       {0x0213, "RXM-SFRBX"},
    {0x0214, "RXM-MEASX"},     {0x0215, "RXM-RAWX"},    {0x0232, "RXM-RTCM"},      {0x0402, "INF-NOTICE"},
    {0x0500, "ACK-NAK"},       {0x0501, "ACK-ACK"},     {0x0A04, "MON-VER"},       {0x0A09, "MON-HW"},
    {0x0A38, "MON-RF"},        {0x0D01, "TIM-TP"},      {0x0D03, "TIM-TM2"},       {0x1002, "ESF-MEAS"},
    {0x1003, "ESF-RAW"},       {0x1010, "ESF-STATUS"},  {0x1014, "ESF-ALG"},       {0x1015, "ESF-INS"},
    {0x2703, "SEC-UNIQID"},    {0x2800, "HNR-PVT"},     {0x2801, "HNR-ATT"},       {0x2802, "HNR-INS"},
    {0x0A21, "MON-RXR"},
}};

unsigned byte_at(std::string_view bytes, std::size_t place) {
  return static_cast<unsigned char>(bytes[place]);
}

/// Fletcher's checksum: b is the sum of all intermediate sums a. Sums of 32 bits wrap at a multiple
/// of 256, so the low byte is right.
bool checksum_is_right(std::string_view frame) {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  const std::size_t end = frame.size() - 2;
  for (std::size_t i = 2; i < end; ++i) {
    a += byte_at(frame, i);
    b += a;
  }
  return (a & 0xFFU) == byte_at(frame, end) && (b & 0xFFU) == byte_at(frame, end + 1);
}

bool is_known_class(std::uint16_t key) {
  return std::find(kClasses.begin(), kClasses.end(), key >> 8U) != kClasses.end();
}

UbxFound incomplete(std::size_t begin, std::size_t missing) {
  return {UbxFound::Kind::incomplete, begin, begin, missing, {}};
}

}  // namespace

bool UbxStretch::checksum_is_right(std::size_t begin, std::size_t size) {
  if (sums_.empty()) {
    summed_ += size;
    if (summed_ <= 4 * bytes_.size()) return formats::checksum_is_right(bytes_.substr(begin, size));
    make_sums();
  }
  // The sums over a part come from the sums a(i) and b(i) over the bytes from the start of the
  // stretch to byte i: a = a(last) - a(first), b = b(last) - b(first) - (last - first) a(first).
  const std::size_t first = begin + 2;
  const std::size_t last = begin + size - 2;
  const Sums& before = sums_[first];
  const Sums& after = sums_[last];
  const std::size_t a = after.a - std::size_t{before.a};
  const std::size_t b = after.b - std::size_t{before.b} - (last - first) * before.a;
  return (a & 0xFFU) == byte_at(bytes_, last) && (b & 0xFFU) == byte_at(bytes_, last + 1);
}

void UbxStretch::make_sums() {
  sums_.resize(bytes_.size() + 1);
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    sums_[i + 1].a = static_cast<std::uint8_t>(sums_[i].a + byte_at(bytes_, i));
    sums_[i + 1].b = static_cast<std::uint8_t>(sums_[i].b + sums_[i + 1].a);
  }
}

UbxFound find_ubx_frame(UbxStretch& stretch, std::size_t from) {
  const std::string_view bytes = stretch.bytes();
  for (std::size_t begin = from;; begin += 2) {
    begin = bytes.find(kSync1, begin);
    if (begin == std::string_view::npos) return {};
    const std::string_view rest = bytes.substr(begin);
    if (rest.size() >= 2 && rest[1] != kSync2) {
      --begin;  // the next byte may be a sync byte itself
      continue;
    }
    if (rest.size() < kHeader) return incomplete(begin, kHeader - rest.size());
    const auto key = static_cast<std::uint16_t>(byte_at(rest, 2) << 8U | byte_at(rest, 3));
    const std::size_t length = byte_at(rest, 4) | byte_at(rest, 5) << 8U;
    if (length <= kLongestUbxPayload) {
      const std::size_t size = length + kFrame;
      if (rest.size() < size) return incomplete(begin, size - rest.size());
      if (stretch.checksum_is_right(begin, size))
        return {UbxFound::Kind::frame, begin, begin + size, 0, {key, rest.substr(kHeader, length)}};
    }
    if (is_known_class(key)) return {UbxFound::Kind::broken, begin, begin + 2, 0, {key, {}}};
  }
}

std::string ubx_name(std::uint16_t key) {
  for (const Name& entry : kMessageNames) {
    if (entry.key == key) return entry.name;
  }
  return fmt::format("UBX-0x{:02X}-0x{:02X}", key >> 8U, key & 0xFFU);
}

void UbxFrameDecoder::take(std::string_view piece) {
  std::string_view rest = piece;
  while (!begun_.empty() && !rest.empty()) {
    const std::size_t part = std::min(std::max(missing_, kLongestUbxPayload + kFrame), rest.size());
    begun_ += rest.substr(0, part);
    rest.remove_prefix(part);
    if (part < missing_) {
      missing_ -= part;
      return;
    }
    begun_.erase(0, scan(begun_, false));
    // The rest of this piece is usually complete, so it is searched in place, without copies.
    const std::size_t taken = piece.size() - rest.size();
    if (begun_.size() > taken) continue;
    rest = piece.substr(taken - begun_.size());
    begun_.clear();
  }
  if (begun_.empty() && !rest.empty()) begun_ = rest.substr(scan(rest, false));
}

void UbxFrameDecoder::finish() {
  scan(begun_, true);
  begun_.clear();
  // end() may throw, and the kinds then tell what the log has instead.
  for (unsigned key = 0; key < 1U << 16U; ++key) {
    if (!counts_[key >> 8U]) {  // the class has not occurred yet
      key |= 0xFFU;
      continue;
    }
    const auto kind = static_cast<std::uint16_t>(key);
    if (const std::size_t messages = count(kind); messages > 0) data_.kinds[ubx_name(kind)] = messages;
  }
  end();
  if (strange_ > 0) note(fmt::format("{} bytes that belong to no UBX frame were skipped", strange_));
}

std::size_t UbxFrameDecoder::count(std::uint16_t key) const {
  const std::unique_ptr<CountsById>& of_class = counts_[key >> 8U];
  return of_class ? (*of_class)[key & 0xFFU] : 0;
}

void UbxFrameDecoder::give(const UbxFrame& frame, std::uint64_t place) {
  std::unique_ptr<CountsById>& of_class = counts_[frame.key >> 8U];
  if (!of_class) of_class = std::make_unique<CountsById>();
  ++(*of_class)[frame.key & 0xFFU];
  ++number_;
  byte_ = place;
  take_frame(frame);
}

/// Delivers the complete frames. @return how many bytes are done; the rest may begin a frame
std::size_t UbxFrameDecoder::scan(std::string_view bytes, bool at_end) {
  std::size_t done = 0;
  UbxStretch stretch(bytes);
  for (;;) {
    const UbxFound found = find_ubx_frame(stretch, done);
    if (found.kind == UbxFound::Kind::incomplete && !at_end) {
      missing_ = found.missing;
      pass_over(bytes.substr(done, found.begin - done));
      base_ += found.begin;
      return found.begin;
    }
    if (found.kind == UbxFound::Kind::nothing) {
      pass_over(bytes.substr(done));
      base_ += bytes.size();
      return bytes.size();
    }
    pass_over(bytes.substr(done, found.begin - done));
    if (found.kind == UbxFound::Kind::frame) {
      give(found.frame, base_ + found.begin);
      done = found.end;
    } else {
      give_broken(found, bytes);
      const std::size_t next = std::min(found.begin + 2, bytes.size());
      pass_over(bytes.substr(found.begin, next - found.begin));
      done = next;
    }
  }
}

void UbxFrameDecoder::pass_over(std::string_view bytes) {
  if (bytes.empty()) return;
  strange_ += bytes.size();
  take_strange(bytes);
}

void UbxFrameDecoder::give_broken(const UbxFound& found, std::string_view bytes) {
  const std::uint64_t place = base_ + found.begin;
  const std::string_view rest = bytes.substr(found.begin);
  if (found.kind == UbxFound::Kind::incomplete) {
    if (rest.size() < kHeader) return;  // too few bytes to recognise a frame
    const auto key = static_cast<std::uint16_t>(byte_at(rest, 2) << 8U | byte_at(rest, 3));
    if (!is_known_class(key)) return;
    ++data_.records;
    corrupt(place, ubx_name(key) + ": the log ends within the message");
    return;
  }
  ++data_.records;
  const std::size_t length = byte_at(rest, 4) | byte_at(rest, 5) << 8U;
  corrupt(place, length > kLongestUbxPayload ? fmt::format("{}: no message has a length of {} bytes",
                                                           ubx_name(found.frame.key), length)
                                             : ubx_name(found.frame.key) + ": the checksum is wrong");
}

void UbxFrameDecoder::corrupt(std::uint64_t byte, const std::string& what) {
  ++data_.corrupt;
  if (data_.corrupt_examples.size() < kCorruptExamples)
    data_.corrupt_examples.push_back(fmt::format("{}:byte {}: {}", path_, byte, what));
}

}  // namespace waymark::formats
