// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drive.hpp"

namespace helixnav::apps {

/// InputError, before anything is written, if the requested drive is impossible with the recording: no labels where
/// association is known, detections that place nothing, a vehicle that was carried where it could not be relocalised.
void check_drive(const Drive& job);

}  // namespace helixnav::apps
