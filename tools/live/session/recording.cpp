#include <waymark/tools/live/session/recording.hpp>

#include <array>
#include <cerrno>
#include <cstring>

#include <waymark/core/base/error.hpp>

namespace waymark::live {
namespace {

// A line of text, then pieces: input (4 bytes), arrival (8), size (4), bytes; little endian.
constexpr std::string_view kBegin = "WAYMARK-INTAKE 1\n";
constexpr std::size_t kHead = 16;
constexpr std::uint32_t kLargest = 1U << 24U;

void put(std::uint64_t value, std::size_t size, char* to) {
  for (std::size_t i = 0; i < size; ++i) to[i] = static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::uint64_t get(const char* from, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8U | static_cast<unsigned char>(from[i]);
  return value;
}

}  // namespace

Recorder::Recorder(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (file_ == nullptr) throw OutputError(path + ": cannot write: " + std::strerror(errno));
  (void)std::fwrite(kBegin.data(), 1, kBegin.size(), file_);
}

Recorder::~Recorder() {
  if (file_ != nullptr) (void)std::fclose(file_);
}

bool Recorder::write(const Piece& piece) {
  if (file_ == nullptr) return false;
  std::array<char, kHead> head;
  put(piece.input, 4, head.data());
  put(static_cast<std::uint64_t>(piece.arrival_ns), 8, head.data() + 4);
  put(piece.bytes.size(), 4, head.data() + 12);
  const bool done = std::fwrite(head.data(), 1, kHead, file_) == kHead &&
                    std::fwrite(piece.bytes.data(), 1, piece.bytes.size(), file_) == piece.bytes.size();
  if (done) return true;
  (void)std::fclose(file_);
  file_ = nullptr;
  return false;
}

bool Recorder::flush() {
  return file_ != nullptr && std::fflush(file_) == 0;
}

void read_recording(const std::string& path, const std::function<void(const Piece&)>& take) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw InputError(path + ": cannot read: " + std::strerror(errno));
  std::string begin(kBegin.size(), '\0');
  const bool known = std::fread(begin.data(), 1, begin.size(), file) == begin.size() && begin == kBegin;
  std::array<char, kHead> head;
  try {
    if (!known) throw InputError(path + ": no recording of 'waymark live --record'");
    while (std::fread(head.data(), 1, kHead, file) == kHead) {
      const auto size = static_cast<std::uint32_t>(get(head.data() + 12, 4));
      if (size > kLargest)
        throw InputError(path + ": damaged: a piece of " + std::to_string(size) + " bytes");
      Piece piece{static_cast<std::uint32_t>(get(head.data(), 4)),
                  static_cast<std::int64_t>(get(head.data() + 4, 8)), std::string(size, '\0')};
      if (std::fread(piece.bytes.data(), 1, size, file) != size) break;
      take(piece);
    }
  } catch (...) {
    (void)std::fclose(file);
    throw;
  }
  (void)std::fclose(file);
}

}  // namespace waymark::live
