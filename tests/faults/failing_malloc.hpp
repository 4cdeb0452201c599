// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>  // __GLIBC__

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__GLIBC__)
#define HELIXNAV_CAN_FAIL_MALLOC 1
#endif

namespace helixnav::testing {

/// From now on the `count`-th call of malloc or realloc gives no memory; all others do. Zero: none fails.
void fail_allocation(int count);

}  // namespace helixnav::testing
