/// Examines a shared object without loading it (ELF, System V ABI).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>

namespace waymark {

/// The bytes of a shared object for this processor. Shown for the tests.
class WAYMARK_EXPORT ModuleFile {
 public:
  /// @throws UsageError if the file cannot be read or is no 64-bit shared object for this processor
  explicit ModuleFile(const std::string& path);

  /// Returns the bytes of a dynamic symbol as they are in the file, before any relocation. Empty if
  /// the file does not have the symbol, or does not hold all of it.
  [[nodiscard]] std::optional<std::span<const std::byte>> symbol(std::string_view name) const;

  /// Tells whether its code makes the processor flush denormal numbers to zero. The start-up file
  /// that -ffast-math links does so, with `orl $0x8040` right before `ldmxcsr`. Always false on
  /// other processors.
  [[nodiscard]] bool sets_flush_to_zero() const;

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace waymark
