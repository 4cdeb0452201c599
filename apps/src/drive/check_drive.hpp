// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drive.hpp"

namespace helixnav::apps {

/// InputError, before anything is written, for a recording that the drive asked for cannot be made of: no labels where
/// association is known, detections that place nothing, a vehicle that was carried where it could not be found again.
void check_drive(const Drive& job);

}  // namespace helixnav::apps
