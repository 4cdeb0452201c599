// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

namespace helixnav::apps {

/// Style of plans, for the <style> of a page that defines --line and --ink.
extern const char* const plan_style;

/// HTML of a drawing of a map from above, with a grid, ticks and axes in metres. `low_m` and `high_m` (y up) are the corners of what it
/// must show. `body`: SVG elements in metres, with y negated. Test: apps/plan_test.cpp.
std::string plan_html(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, const std::string& body,
                      const std::string& label);

}  // namespace helixnav::apps
