// SPDX-License-Identifier: BSD-3-Clause
#include "rate_changes.hpp"

#include <algorithm>

namespace helixnav::logs {

void RateChanges::take(core::Nanoseconds t_ns, const Eigen::Vector3d& rates) {
  constexpr double begun_turn_radps = 0.1;
  // White noise of the rows is a part of each change; over a second it is a small one.
  constexpr core::Nanoseconds least_ns = 1'000'000'000;
  if (!first_ns_) {
    first_ns_ = since_ns_ = t_ns;
    since_ = rates;
    squares_ = rates.cwiseAbs2();
    squares_.z() = std::max(squares_.z(), begun_turn_radps * begun_turn_radps);
  } else {
    intervals_ += 1.0;
  }
  last_ns_ = t_ns;
  if (t_ns - since_ns_ < least_ns) return;
  squares_ += (rates - since_).cwiseAbs2();
  changing_s_ += core::seconds(t_ns - since_ns_);
  since_ns_ = t_ns;
  since_ = rates;
}

bool RateChanges::is_gap(core::Nanoseconds interval_ns) const {
  if (intervals_ == 0.0) return false;
  constexpr double least_s = 1.0, longer = 10.0;
  const double mean_s = core::seconds(last_ns_ - *first_ns_) / intervals_;
  return core::seconds(interval_ns) > std::max(least_s, longer * mean_s);
}

Eigen::Vector3d RateChanges::variance_per_s() const { return squares_ / changing_s_; }

}  // namespace helixnav::logs
