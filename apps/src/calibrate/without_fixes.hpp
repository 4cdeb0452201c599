// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// The events without fixes: what calibrate may see.
core::Recording without_fixes(const core::Recording& recording);

}  // namespace helixnav::apps
