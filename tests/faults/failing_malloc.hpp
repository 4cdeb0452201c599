// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>  // __GLIBC__

#include "sanitized.hpp"

#if !defined(HELIXNAV_SANITIZED) && defined(__GLIBC__)
#define HELIXNAV_CAN_FAIL_MALLOC 1
#endif

namespace helixnav::testing {

/// From now on the `count`-th call of malloc or realloc fails; all others succeed. Zero: none fails.
void fail_allocation(int count);

}  // namespace helixnav::testing
