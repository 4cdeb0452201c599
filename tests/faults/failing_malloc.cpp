// SPDX-License-Identifier: BSD-3-Clause
// malloc itself is replaced, because Eigen does not go through operator new. Left out under sanitizers, which replace
// malloc themselves.
#include "failing_malloc.hpp"

#include <cerrno>
#include <cstdlib>

namespace {

thread_local int left = 0;

bool is_refused() { return left > 0 && --left == 0; }

}  // namespace

namespace helixnav::testing {

void fail_allocation(int count) { left = count; }

}  // namespace helixnav::testing

#ifdef HELIXNAV_CAN_FAIL_MALLOC

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_realloc(void* old, std::size_t size);

void* malloc(std::size_t size) {
  if (is_refused()) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}

void* realloc(void* old, std::size_t size) {
  if (is_refused()) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_realloc(old, size);
}
}

#endif
