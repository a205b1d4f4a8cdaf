/// A fingerprint of input files for provenance.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace waymark::formats {

/// FNV-1a, 64 bits. Tells files apart; it is no protection against forgery.
/// Source: Fowler, Noll, Vo; RFC draft "The FNV Non-Cryptographic Hash Algorithm".
class Fnv1a64 {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      hash_ ^= static_cast<unsigned char>(byte);
      hash_ *= 1099511628211ULL;
    }
  }
  /// 16 hexadecimal digits.
  [[nodiscard]] std::string hex() const {
    std::string text(16, '0');
    std::uint64_t rest = hash_;
    for (auto digit = text.rbegin(); digit != text.rend(); ++digit, rest >>= 4)
      *digit = "0123456789abcdef"[rest & 15];
    return text;
  }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

[[nodiscard]] inline std::string fnv1a64_hex(std::string_view bytes) {
  Fnv1a64 hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace waymark::formats
