// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "helixnav/core/time.hpp"

namespace helixnav::supervisor {

/// A pause in which the vehicle may have been carried.
struct UnsurePause {
  double path_m = 0.0;    ///< length of the drive until it
  std::int64_t step = 0;  ///< of the first scan after it
};

/// How often scans come and how far the vehicle drives between two of them, and hence what counts as a pause.
class ScanRhythm {
 public:
  /// Ten times the mean interval between the scans of this drive, and driven no farther than twice the mean, pauses
  /// left out; not before twenty intervals are known.
  bool is_pause(core::Nanoseconds until_ns, double driven_m) const {
    constexpr double longer = 10.0, farther = 2.0;
    return last_ns_ && intervals_ >= enough && driven_m <= farther * driven_mean_m() &&
           static_cast<double>(until_ns - *last_ns_) > longer * sum_ns_ / intervals_;
  }

  /// Whether odometry leaves open which way the vehicle turned since the last scan: by more than an eighth of a turn,
  /// where everything computed to first order in the heading fails, and by ten times the usual; not before twenty
  /// intervals are known.
  bool leaves_heading_open(double heading_variance_rad2) const {
    constexpr double eighth_turn_rad = 0.785, larger = 10.0;
    return last_ns_ && intervals_ >= enough && heading_variance_rad2 > eighth_turn_rad * eighth_turn_rad &&
           heading_variance_rad2 > larger * larger * sum_rad2_ / intervals_;
  }

  double driven_mean_m() const { return intervals_ > 0 ? sum_m_ / intervals_ : 0.0; }

  /// A gap in the odometry is not usual, and one that counted would hide the next; two in succession do count.
  void note(core::Nanoseconds t_ns, double driven_m, double heading_variance_rad2) {
    const bool was_open = was_open_;
    was_open_ = leaves_heading_open(heading_variance_rad2);
    if (last_ns_ && !is_pause(t_ns, driven_m) && (was_open || !was_open_)) {
      sum_ns_ += static_cast<double>(std::max<core::Nanoseconds>(0, t_ns - *last_ns_));
      sum_m_ += driven_m;
      sum_rad2_ += heading_variance_rad2;
      ++intervals_;
    }
    last_ns_ = t_ns;
  }

  /// The time until the next scan is not a pause.
  void lose_last() { last_ns_.reset(); }

 private:
  static constexpr int enough = 20;

  std::optional<core::Nanoseconds> last_ns_;
  double sum_ns_ = 0.0;
  double sum_m_ = 0.0;
  double sum_rad2_ = 0.0;
  int intervals_ = 0;
  bool was_open_ = false;  ///< the interval before
};

}  // namespace helixnav::supervisor
