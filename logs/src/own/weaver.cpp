// SPDX-License-Identifier: BSD-3-Clause
#include "weaver.hpp"

#include <utility>

#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {

void Weaver::move(const Motion& motion, core::Nanoseconds t_ns) {
  if (!now_ns_ || *now_ns_ < motion.begin_ns) now_ns_ = motion.begin_ns;
  const bool instantaneous = motion.end_ns == motion.begin_ns;
  const bool nothing = motion.twist.isZero(0.0) && motion.covariance.isZero(0.0);
  if (instantaneous && (nothing || t_ns != motion.end_ns)) return;
  if (!instantaneous && t_ns <= *now_ns_) return;
  const double share =
      instantaneous ? 1.0 : core::seconds(t_ns - *now_ns_) / core::seconds(motion.end_ns - motion.begin_ns);
  const core::Odometry part = part_of(motion, share, t_ns, T_vehicle_odometry_);
  pending_ = pending_ ? core::chain(*pending_, part) : part;
  now_ns_ = t_ns;
}

void Weaver::add(core::Scan scan) {
  flush();
  events_.emplace_back(std::move(scan));
}

void Weaver::lose(core::Nanoseconds t_ns) {
  flush();
  events_.emplace_back(core::Lost{t_ns});
}

void Weaver::flush() {
  if (pending_) events_.emplace_back(*pending_);
  pending_.reset();
}

}  // namespace helixnav::logs
