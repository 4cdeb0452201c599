// SPDX-License-Identifier: BSD-3-Clause
#include "weaver.hpp"

#include <algorithm>
#include <utility>

#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {

namespace {

/// An uncertain heading bends the path after it: in a gap, pieces of a tenth of a second are chained.
int pieces_of(core::Nanoseconds duration_ns) {
  constexpr core::Nanoseconds piece_ns = 100'000'000, most = 100;
  return static_cast<int>(std::clamp<core::Nanoseconds>(duration_ns / piece_ns, 1, most));
}

}  // namespace

void Weaver::append(const core::Odometry& part) { pending_ = pending_ ? core::chain(*pending_, part) : part; }

void Weaver::move(const Motion& motion, core::Nanoseconds t_ns) {
  if (!now_ns_ || *now_ns_ < motion.begin_ns) now_ns_ = motion.begin_ns;
  const bool instantaneous = motion.end_ns == motion.begin_ns;
  const bool nothing = motion.twist.isZero(0.0) && motion.covariance.isZero(0.0);
  if (instantaneous && (nothing || t_ns != motion.end_ns)) return;
  if (!instantaneous && t_ns <= *now_ns_) return;
  const core::Nanoseconds from_ns = instantaneous ? t_ns : *now_ns_;
  const int pieces = motion.may_change() ? pieces_of(t_ns - from_ns) : 1;
  const auto begin_of = [&](int piece) { return from_ns + (t_ns - from_ns) / pieces * piece; };
  for (int i = 0; i < pieces; ++i) {
    append(part_of(motion, begin_of(i), i + 1 < pieces ? begin_of(i + 1) : t_ns, T_vehicle_odometry_));
  }
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

/// After a gap of days nothing is known, however large the number that says so.
void Weaver::flush() {
  constexpr double most = 1e15;
  if (pending_) {
    Eigen::Matrix3d& covariance = pending_->covariance;
    if (covariance.diagonal().maxCoeff() > most) {
      const Eigen::Vector3d scale = (most * covariance.diagonal().cwiseInverse()).cwiseMin(1.0).cwiseSqrt();
      covariance = (scale.asDiagonal() * covariance * scale.asDiagonal()).eval();
    }
    events_.emplace_back(*pending_);
  }
  pending_.reset();
}

}  // namespace helixnav::logs
