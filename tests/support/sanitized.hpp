// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::support {

/// HELIXNAV_SANITIZED is defined where the address or thread sanitizer is on; GCC and clang report this differently.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HELIXNAV_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HELIXNAV_SANITIZED
#endif
#endif

#ifdef HELIXNAV_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace helixnav::support
