// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Whether the run used --association known, which identifies landmarks by their names.
bool known_by_name(const runs::Run& run);

}  // namespace helixnav::reports
