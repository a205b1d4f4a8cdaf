#include <elf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/detail/module_file.hpp>

namespace waymark {
namespace {

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#else
constexpr Elf64_Half kMachine = EM_NONE;
#endif

/// Returns the object of type T at an offset. @return empty if the file ends before its end
template <typename T>
std::optional<T> object_at(std::span<const std::byte> bytes, std::uint64_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return std::nullopt;
  T object;
  std::memcpy(&object, bytes.data() + offset, sizeof(T));
  return object;
}

/// Calls visit(entry) for each entry of a table until it returns true. @return whether it did
template <typename Entry, typename Visit>
bool any_of_table(std::span<const std::byte> bytes, std::uint64_t offset, std::uint64_t count, Visit visit) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto entry = object_at<Entry>(bytes, offset + i * sizeof(Entry));
    if (!entry) return false;
    if (visit(*entry)) return true;
  }
  return false;
}

/// Returns the zero-terminated name at an offset. Empty if it does not end within the file.
std::string_view name_at(std::span<const std::byte> bytes, std::uint64_t offset) {
  if (offset >= bytes.size()) return {};
  const auto* begin = reinterpret_cast<const char*>(bytes.data()) + offset;
  const void* end = std::memchr(begin, 0, bytes.size() - offset);
  return end == nullptr ? std::string_view() : std::string_view(begin);
}

/// Returns `size` bytes at an address of the loaded image, if the file holds them.
std::optional<std::span<const std::byte>> bytes_at_address(std::span<const std::byte> bytes,
                                                           const Elf64_Ehdr& header, std::uint64_t address,
                                                           std::uint64_t size) {
  std::optional<std::span<const std::byte>> found;
  any_of_table<Elf64_Phdr>(bytes, header.e_phoff, header.e_phnum, [&](const Elf64_Phdr& segment) {
    const bool holds = segment.p_type == PT_LOAD && address >= segment.p_vaddr &&
                       address - segment.p_vaddr <= segment.p_filesz &&
                       size <= segment.p_filesz - (address - segment.p_vaddr);
    if (!holds) return false;
    const std::uint64_t offset = segment.p_offset + (address - segment.p_vaddr);
    if (offset <= bytes.size() && size <= bytes.size() - offset) found = bytes.subspan(offset, size);
    return true;
  });
  return found;
}

/// Tells whether a segment lies in the file, and at a place where the system can map it.
bool is_whole(const Elf64_Phdr& segment, std::size_t file_size) {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 40U;
  if (segment.p_offset > file_size || segment.p_filesz > file_size - segment.p_offset) return false;
  if (segment.p_type != PT_LOAD) return true;
  const bool aligned =
      segment.p_align <= 1 || (std::has_single_bit(segment.p_align) &&
                               segment.p_vaddr % segment.p_align == segment.p_offset % segment.p_align);
  return aligned && segment.p_filesz <= segment.p_memsz && segment.p_memsz < kLargest &&
         segment.p_vaddr < kLargest;
}

/// Returns what is wrong with the table of segments; empty: nothing. Segments that are loaded ascend
/// and do not overlap; the dynamic section is in one of them.
std::string flaw_of_segments(std::span<const std::byte> bytes, const Elf64_Ehdr& header) {
  std::uint64_t end = 0;
  std::size_t seen = 0;
  bool dynamic = false;
  const bool flawed =
      header.e_phentsize != sizeof(Elf64_Phdr) ||
      any_of_table<Elf64_Phdr>(bytes, header.e_phoff, header.e_phnum, [&](const Elf64_Phdr& s) {
        ++seen;
        const bool loaded = s.p_type == PT_LOAD;
        if (!is_whole(s, bytes.size()) || (loaded && s.p_vaddr < end)) return true;
        if (loaded) end = s.p_vaddr + s.p_memsz;
        if (s.p_type == PT_DYNAMIC)
          dynamic = bytes_at_address(bytes, header, s.p_vaddr, s.p_filesz).has_value();
        return false;
      });
  if (flawed || seen != header.e_phnum) return "its segments do not lie in the file";
  return dynamic ? "" : "it has no dynamic section";
}

bool sets_flush_to_zero_in(std::span<const std::byte> code) {
  constexpr std::array kBits{std::byte{0x40}, std::byte{0x80}, std::byte{0}, std::byte{0}};
  // bytes between the immediate and the instruction that uses it
  constexpr std::ptrdiff_t kReach = 16;
  for (auto at = code.begin();; ++at) {
    at = std::search(at, code.end(), kBits.begin(), kBits.end());
    if (at == code.end()) return false;
    const auto stop = code.end() - at > kReach ? at + kReach : code.end();
    for (auto next = at + 4; stop - next >= 3; ++next) {  // 0f ae /2: ldmxcsr
      if (next[0] == std::byte{0x0f} && next[1] == std::byte{0xae} &&
          (next[2] & std::byte{0x38}) == std::byte{0x10})
        return true;
    }
  }
}

}  // namespace

ModuleFile::ModuleFile(const std::string& path) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  if (kind != std::filesystem::file_type::regular && kind != std::filesystem::file_type::not_found)
    throw UsageError(path + ": is no regular file; give the plugin's module");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UsageError(path + ": cannot read the plugin: " + std::strerror(errno));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  bytes_.resize(text.size());
  std::copy(text.begin(), text.end(), reinterpret_cast<char*>(bytes_.data()));
  const auto header = object_at<Elf64_Ehdr>(bytes_, 0);
  const bool shared_object = header && std::memcmp(header->e_ident, ELFMAG, SELFMAG) == 0 &&
                             header->e_ident[EI_CLASS] == ELFCLASS64 && header->e_type == ET_DYN &&
                             (kMachine == EM_NONE || header->e_machine == kMachine);
  if (!shared_object)
    throw UsageError(path +
                     ": is no shared object for this machine; build the plugin with waymark_add_plugin()");
  if (const std::string flaw = flaw_of_segments(bytes_, *header); !flaw.empty())
    throw UsageError(path + ": is damaged: " + flaw + "; build the plugin again");
}

std::optional<std::span<const std::byte>> ModuleFile::symbol(std::string_view name) const {
  const Elf64_Ehdr header = *object_at<Elf64_Ehdr>(bytes_, 0);
  std::optional<std::span<const std::byte>> found;
  any_of_table<Elf64_Shdr>(bytes_, header.e_shoff, header.e_shnum, [&](const Elf64_Shdr& section) {
    if (section.sh_type != SHT_DYNSYM) return false;
    const auto names = object_at<Elf64_Shdr>(bytes_, header.e_shoff + section.sh_link * sizeof(Elf64_Shdr));
    if (!names) return false;
    const std::uint64_t count = section.sh_size / sizeof(Elf64_Sym);
    return any_of_table<Elf64_Sym>(bytes_, section.sh_offset, count, [&](const Elf64_Sym& symbol) {
      if (symbol.st_shndx == SHN_UNDEF || name_at(bytes_, names->sh_offset + symbol.st_name) != name)
        return false;
      found = bytes_at_address(bytes_, header, symbol.st_value, symbol.st_size);
      return true;
    });
  });
  return found;
}

bool ModuleFile::sets_flush_to_zero() const {
#if defined(__x86_64__)
  const Elf64_Ehdr header = *object_at<Elf64_Ehdr>(bytes_, 0);
  return any_of_table<Elf64_Phdr>(bytes_, header.e_phoff, header.e_phnum, [&](const Elf64_Phdr& segment) {
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0) return false;
    const auto code = bytes_at_address(bytes_, header, segment.p_vaddr, segment.p_filesz);
    return code && sets_flush_to_zero_in(*code);
  });
#else
  return false;
#endif
}

}  // namespace waymark
