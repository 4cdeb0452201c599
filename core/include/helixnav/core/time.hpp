// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace helixnav::core {

/// Time is a whole number of nanoseconds since the log's own origin: equal stamps compare equal.
using Nanoseconds = std::int64_t;

inline Nanoseconds nanoseconds_from_seconds(double t_s) { return static_cast<Nanoseconds>(std::llround(t_s * 1e9)); }
inline double seconds(Nanoseconds t_ns) { return static_cast<double>(t_ns) * 1e-9; }

}  // namespace helixnav::core
