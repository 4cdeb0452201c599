// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// Reports on stderr what a run that was read has lost, one warning each. Test:
/// apps/hostile/hostile_run_test.cpp.
void warn_of_missing(const std::vector<std::string>& missing);

}  // namespace helixnav::apps
