// Is this compiled with the address sanitizer? It reserves more memory than there is, and is slow.
#pragma once

namespace jvari::test {
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
inline constexpr bool sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool sanitized = false;
#endif
}  // namespace jvari::test
