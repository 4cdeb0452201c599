// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"

namespace helixnav::core {

/// The increment that is `first` followed by `second`, with covariance J₁P₁J₁ᵀ + J₂P₂J₂ᵀ. Predicting an EKF with the
/// result equals predicting with the two in turn (the chain rule), so a filter may predict once per scan.
/// Test: core/odometry_test.cpp.
Odometry chain(const Odometry& first, const Odometry& second);

/// No motion, no uncertainty: the neutral element of chain.
inline Odometry no_motion(Nanoseconds t_ns) {
  Odometry none;
  none.t_ns = t_ns;
  return none;
}

}  // namespace helixnav::core
