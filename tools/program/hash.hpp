/// A fingerprint of input files for provenance.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace waymark {

/// FNV-1a, 64 bits, as 16 hexadecimal digits. Tells files apart; it is no protection against forgery.
/// Source: Fowler, Noll, Vo; RFC draft "The FNV Non-Cryptographic Hash Algorithm".
[[nodiscard]] inline std::string fnv1a64_hex(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 1099511628211ULL;
  }
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) text[static_cast<std::size_t>(i)] = "0123456789abcdef"[hash & 15];
  return text;
}

}  // namespace waymark
