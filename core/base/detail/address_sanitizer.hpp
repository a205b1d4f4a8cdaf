/// Whether this is built with AddressSanitizer, whose shadow memory takes all of the address space: limits on
/// memory end such a program at once.
#pragma once

namespace waymark::detail {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kAddressSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kAddressSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool kAddressSanitized = false;
#endif

}  // namespace waymark::detail
