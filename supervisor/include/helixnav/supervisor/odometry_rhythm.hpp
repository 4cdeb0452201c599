// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/time.hpp"

namespace helixnav::supervisor {

/// The time that an increment of odometry covers.
struct TimeMoved {
  double seconds = 0.0;   ///< since the increment before it
  double silent_s = 0.0;  ///< of these, what is longer than usual: whether a gyro ran on meanwhile, nobody knows

  TimeMoved& operator+=(const TimeMoved& then) {
    seconds += then.seconds;
    silent_s += then.silent_s;
    return *this;
  }
};

/// How often odometry comes, and hence when it was silent: for more than ten times the mean interval between the increments of
/// this drive, gaps left out; not before twenty intervals are known. Test: supervisor/systematic/odometry_rhythm_test.cpp.
class OdometryRhythm {
 public:
  /// Of the increment that ends at this time. The first covers no time that is known.
  TimeMoved until(core::Nanoseconds t_ns) {
    constexpr int enough = 20;
    constexpr double longer = 10.0;
    TimeMoved time;
    if (last_ns_) {
      time.seconds = core::seconds(t_ns - *last_ns_);
      const double usual_s = intervals_ > 0 ? sum_s_ / intervals_ : 0.0;
      if (intervals_ >= enough && time.seconds > longer * usual_s) {
        time.silent_s = time.seconds - usual_s;
      } else {
        sum_s_ += time.seconds;
        ++intervals_;
      }
    }
    last_ns_ = t_ns;
    return time;
  }

  /// Nobody measured how long the next increment takes.
  void lose_last() { last_ns_.reset(); }

 private:
  std::optional<core::Nanoseconds> last_ns_;
  double sum_s_ = 0.0;
  int intervals_ = 0;
};

}  // namespace helixnav::supervisor
