#include <waymark/formats/logs/detail/compression/codec.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>

#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

namespace waymark::formats {
namespace {

constexpr std::string_view kGzipMagic{"\x1F\x8B", 2};
constexpr std::string_view kXzMagic{
    "\xFD"
    "7zXZ\0",
    6};
constexpr std::string_view kZstdMagic{"\x28\xB5\x2F\xFD", 4};

/// A log compressed by another program may ask for this much memory, bytes. `xz -9` needs 65 MiB,
/// `zstd --ultra -22` 128 MiB.
constexpr std::uint64_t kMostMemory = 256U << 20U;
constexpr int kMostWindowBits = 27;
/// Zstandard does not deliver what it decoded in a call that ends at damage, so a call is for this much.
constexpr std::size_t kZstdStep = 32U << 10U;

/// zlib counts in 32 bits.
unsigned within_32_bits(std::size_t size) {
  return static_cast<unsigned>(std::min<std::size_t>(size, std::numeric_limits<unsigned>::max()));
}

class GzipCodec final : public Codec {
 public:
  GzipCodec() {
    constexpr int kGzipOnly = 16;
    if (::inflateInit2(&stream_, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  GzipCodec(const GzipCodec&) = delete;
  GzipCodec& operator=(const GzipCodec&) = delete;
  ~GzipCodec() override { ::inflateEnd(&stream_); }

  Outcome step(std::span<const char>& in, std::span<char>& out, bool last) override {
    if (between_members_) {
      // As gzip does, what is no further member is ignored.
      if (in.empty()) return last ? Outcome::end : Outcome::more;
      if (in.front() != kGzipMagic.front()) return Outcome::end;
      ::inflateReset(&stream_);
      between_members_ = false;
    }
    const unsigned given = within_32_bits(in.size());
    const unsigned room = within_32_bits(out.size());
    // zlib's interface is older than const.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    stream_.avail_in = given;
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = room;
    const int code = ::inflate(&stream_, Z_NO_FLUSH);
    in = in.subspan(given - stream_.avail_in);
    out = out.subspan(room - stream_.avail_out);
    if (code == Z_STREAM_END) between_members_ = true;
    return code == Z_OK || code == Z_BUF_ERROR || code == Z_STREAM_END ? Outcome::more : Outcome::damaged;
  }
  [[nodiscard]] std::string_view what() const override {
    return stream_.msg == nullptr ? std::string_view("bad data") : std::string_view(stream_.msg);
  }

 private:
  z_stream stream_{};
  bool between_members_ = false;
};

class XzCodec final : public Codec {
 public:
  XzCodec() {
    if (::lzma_stream_decoder(&stream_, kMostMemory, LZMA_CONCATENATED) != LZMA_OK) throw std::bad_alloc();
  }
  XzCodec(const XzCodec&) = delete;
  XzCodec& operator=(const XzCodec&) = delete;
  ~XzCodec() override { ::lzma_end(&stream_); }

  Outcome step(std::span<const char>& in, std::span<char>& out, bool last) override {
    stream_.next_in = reinterpret_cast<const std::uint8_t*>(in.data());
    stream_.avail_in = in.size();
    stream_.next_out = reinterpret_cast<std::uint8_t*>(out.data());
    stream_.avail_out = out.size();
    code_ = ::lzma_code(&stream_, last ? LZMA_FINISH : LZMA_RUN);
    in = in.last(stream_.avail_in);
    out = out.last(stream_.avail_out);
    if (code_ == LZMA_STREAM_END) return Outcome::end;
    return code_ == LZMA_OK || code_ == LZMA_BUF_ERROR ? Outcome::more : Outcome::damaged;
  }
  [[nodiscard]] std::string_view what() const override {
    if (code_ == LZMA_MEMLIMIT_ERROR) return "it needs more than 256 MiB of memory";
    if (code_ == LZMA_OPTIONS_ERROR) return "unknown options";
    return "bad data";
  }

 private:
  lzma_stream stream_ = LZMA_STREAM_INIT;
  lzma_ret code_ = LZMA_OK;
};

class ZstdCodec final : public Codec {
 public:
  ZstdCodec() : stream_(::ZSTD_createDStream()) {
    if (stream_ == nullptr) throw std::bad_alloc();
    ::ZSTD_DCtx_setParameter(stream_, ZSTD_d_windowLogMax, kMostWindowBits);
  }
  ZstdCodec(const ZstdCodec&) = delete;
  ZstdCodec& operator=(const ZstdCodec&) = delete;
  ~ZstdCodec() override { ::ZSTD_freeDStream(stream_); }

  Outcome step(std::span<const char>& in, std::span<char>& out, bool last) override {
    if (in.empty() && last && frame_done_) return Outcome::end;
    ZSTD_inBuffer source{in.data(), in.size(), 0};
    ZSTD_outBuffer target{out.data(), std::min(out.size(), kZstdStep), 0};
    const std::size_t rest = ::ZSTD_decompressStream(stream_, &target, &source);
    in = in.subspan(source.pos);
    out = out.subspan(target.pos);
    if (::ZSTD_isError(rest) != 0U) {
      what_ = ::ZSTD_getErrorName(rest);
      return Outcome::damaged;
    }
    frame_done_ = rest == 0;
    return Outcome::more;
  }
  [[nodiscard]] std::string_view what() const override { return what_; }

 private:
  ZSTD_DStream* stream_;
  bool frame_done_ = false;  ///< another frame may follow
  std::string_view what_;
};

}  // namespace

std::unique_ptr<Codec> codec_of(std::string_view head) {
  if (head.starts_with(kGzipMagic)) return std::make_unique<GzipCodec>();
  if (head.starts_with(kXzMagic)) return std::make_unique<XzCodec>();
  if (head.starts_with(kZstdMagic)) return std::make_unique<ZstdCodec>();
  return nullptr;
}

std::unique_ptr<Codec> zstd_codec() {
  return std::make_unique<ZstdCodec>();
}

}  // namespace waymark::formats
