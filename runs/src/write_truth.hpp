// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"

namespace helixnav::runs {

/// Writes the truth_*.csv that the recording has something for.
void write_truth(const std::string& folder, const core::Recording& recording);

}  // namespace helixnav::runs
