// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/fastslam/options.hpp"
#include "helixnav/mrpt_adapter/map_builder_options.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::mrpt_adapter {

/// What the options mean for the navigator; InputError when they contradict its own limits.
supervisor::NavigatorOptions navigator_options(const MapBuilderOptions& options);

/// What of MapBuilderOptions FastSLAM has.
fastslam::Options fastslam_options(const MapBuilderOptions& options);

}  // namespace helixnav::mrpt_adapter
