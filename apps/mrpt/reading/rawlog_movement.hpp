// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CActionCollection.h>

#include "helixnav/core/events.hpp"

namespace helixnav::apps {

/// One movement with its full covariance, which MRPT keeps only for movements from scan matching.
mrpt::obs::CActionCollection movement_of(const core::Odometry& odometry);

}  // namespace helixnav::apps
