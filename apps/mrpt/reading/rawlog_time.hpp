// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <mrpt/core/Clock.h>

#include "helixnav/core/time.hpp"

namespace helixnav::apps {

/// MRPT counts 100 ns since 1601; ours is 0 at the Unix epoch, so that small times in a log are preserved.
inline constexpr std::int64_t unix_epoch_100ns = 116'444'736'000'000'000;

/// To the nearest 100 ns.
inline mrpt::Clock::time_point rawlog_time(core::Nanoseconds t_ns) {
  const std::int64_t ticks = (t_ns >= 0 ? t_ns + 50 : t_ns - 49) / 100;
  return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + unix_epoch_100ns));
}

inline core::Nanoseconds time_of_rawlog(const mrpt::Clock::time_point& time) {
  return (time.time_since_epoch().count() - unix_epoch_100ns) * 100;
}

inline bool has_time(const mrpt::Clock::time_point& time) { return time.time_since_epoch().count() != 0; }

}  // namespace helixnav::apps
