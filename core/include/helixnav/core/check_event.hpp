// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::core {

/// The precondition of every estimator on an event, checked before anything changes; PreconditionError names the time and
/// the value. No allocation unless it throws. Test: core/check_event_test.cpp.
///
/// Beyond 1e8 metres, 1e6 radians and covariances of 1e16 (m², rad²) a number is garbage, whose squares and cells are
/// beyond what can be computed with: such a length, heading or covariance is refused like one that is not finite.
///
/// Odometry: finite increment, covariance finite, symmetric and positive semidefinite to 1e-9 of its largest element.
void check(const Odometry& odometry);
/// Scan: finite mounting, a field of view whose bounds are in order (its range may be infinite, or zero where it is
/// unknown), every observation as check_observation requires. O(observations).
void check(const Scan& scan);
/// Fix: finite position and antenna, covariance symmetric positive definite.
void check(const AbsoluteFix& fix);
/// Nothing about it can be wrong.
inline void check(const Lost&) {}
/// Whichever it is.
void check(const Event& event);

/// Where an estimator begins, held to the same limits: finite, the covariance symmetric and positive semidefinite.
void check_start(const PoseGaussian& start);

/// PreconditionError when an event at t_ns would go back before one at last_ns. Equal times are in order.
void check_order(Nanoseconds last_ns, Nanoseconds t_ns);

}  // namespace helixnav::core
