#include <new>

#include <waymark/formats/logs/detail/compression/codec.hpp>

#ifdef WAYMARK_HAS_BZIP2
#include <bzlib.h>
#endif
#ifdef WAYMARK_HAS_LZ4
#include <lz4frame.h>
#endif

namespace waymark::formats {
namespace {

#ifdef WAYMARK_HAS_BZIP2
class Bzip2Codec final : public Codec {
 public:
  Bzip2Codec() {
    if (::BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  Bzip2Codec(const Bzip2Codec&) = delete;
  Bzip2Codec& operator=(const Bzip2Codec&) = delete;
  ~Bzip2Codec() override { ::BZ2_bzDecompressEnd(&stream_); }

  Outcome step(std::span<const char>& in, std::span<char>& out, bool /*last*/) override {
    if (ended_) return Outcome::end;
    // The interface is older than const. Pieces are far below its 32 bits.
    stream_.next_in = const_cast<char*>(in.data());
    stream_.avail_in = static_cast<unsigned>(in.size());
    stream_.next_out = out.data();
    stream_.avail_out = static_cast<unsigned>(out.size());
    const int code = ::BZ2_bzDecompress(&stream_);
    in = in.last(stream_.avail_in);
    out = out.last(stream_.avail_out);
    ended_ = code == BZ_STREAM_END;
    if (ended_) return Outcome::end;
    return code == BZ_OK ? Outcome::more : Outcome::damaged;
  }
  [[nodiscard]] std::string_view what() const override { return "bad data"; }

 private:
  bz_stream stream_{};
  bool ended_ = false;
};
#endif

#ifdef WAYMARK_HAS_LZ4
class Lz4Codec final : public Codec {
 public:
  Lz4Codec() {
    if (::LZ4F_isError(::LZ4F_createDecompressionContext(&context_, LZ4F_VERSION)) != 0U)
      throw std::bad_alloc();
  }
  Lz4Codec(const Lz4Codec&) = delete;
  Lz4Codec& operator=(const Lz4Codec&) = delete;
  ~Lz4Codec() override { ::LZ4F_freeDecompressionContext(context_); }

  Outcome step(std::span<const char>& in, std::span<char>& out, bool /*last*/) override {
    std::size_t made = out.size();
    std::size_t used = in.size();
    const std::size_t rest = ::LZ4F_decompress(context_, out.data(), &made, in.data(), &used, nullptr);
    if (::LZ4F_isError(rest) != 0U) {
      what_ = ::LZ4F_getErrorName(rest);
      return Outcome::damaged;
    }
    in = in.subspan(used);
    out = out.subspan(made);
    return Outcome::more;  // another frame may follow
  }
  [[nodiscard]] std::string_view what() const override { return what_; }

 private:
  LZ4F_dctx* context_ = nullptr;
  std::string_view what_;
};
#endif

}  // namespace

std::unique_ptr<Codec> bzip2_codec() {
#ifdef WAYMARK_HAS_BZIP2
  return std::make_unique<Bzip2Codec>();
#else
  return nullptr;
#endif
}

std::unique_ptr<Codec> lz4_codec() {
#ifdef WAYMARK_HAS_LZ4
  return std::make_unique<Lz4Codec>();
#else
  return nullptr;
#endif
}

}  // namespace waymark::formats
