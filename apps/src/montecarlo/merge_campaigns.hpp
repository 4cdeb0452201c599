// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// Makes one campaign folder of parts that were driven anywhere (montecarlo --seeds), as one machine would have written it except for the wall
/// clock; prints its summary. InputError, before anything is written, for parts of different scenarios, settings or builds, for a seed that two
/// parts hold or that none holds between the first and the last, and for a part that has not driven all its seeds.
/// Test: apps/montecarlo/campaign_parts_test.cpp.
void merge_campaigns(const std::vector<std::string>& parts, const std::string& out, bool overwrite);

}  // namespace helixnav::apps
