// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/time.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {

/// Reads the times of one sensor, in seconds, which never go back. Unix times are accepted, and all accepted
/// times fit into nanoseconds.
class ReadingTimes {
 public:
  core::Nanoseconds next(TextCursor& cursor) {
    constexpr double longest_log_s = 4e9;
    last_s_ = cursor.number_between_in_stream(last_s_, longest_log_s, "a time [s] that does not go backwards");
    return core::nanoseconds_from_seconds(last_s_);
  }

 private:
  double last_s_ = 0.0;
};

}  // namespace helixnav::logs
