// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>

#include <mrpt/obs/CObservation.h>
#include <mrpt/system/datetime.h>

#include "helixnav/mrpt_adapter/conversions.hpp"

namespace helixnav::mrpt_adapter {

std::optional<core::Nanoseconds> time_of(const mrpt::obs::CObservation& observation) {
  constexpr std::int64_t ticks_1601_to_1970 = 116'444'736'000'000'000;
  constexpr std::int64_t ns_per_tick = 100;
  constexpr std::int64_t most_ticks = std::numeric_limits<std::int64_t>::max() / ns_per_tick;
  if (observation.timestamp == INVALID_TIMESTAMP) return std::nullopt;
  const std::int64_t since_1601 = observation.timestamp.time_since_epoch().count();
  // What lies further from 1970 than nanoseconds can count is no time stamp either; the lower bound comes first, so that
  // the difference cannot overflow.
  if (since_1601 < 0 || since_1601 - ticks_1601_to_1970 > most_ticks) return std::nullopt;
  if (since_1601 - ticks_1601_to_1970 < -most_ticks) return std::nullopt;
  return (since_1601 - ticks_1601_to_1970) * ns_per_tick;
}

}  // namespace helixnav::mrpt_adapter
