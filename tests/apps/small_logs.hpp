// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace helixnav::apps {

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// A small valid ACFR text release: two samples of dead reckoning, two scans, one fix, and their order.
NamedTexts small_release();

std::filesystem::path write_zip(const std::filesystem::path& path, const NamedTexts& files);

/// A landmark graph as text: `steps` motions along a circle of 20 m with one landmark at its centre, seen from each pose.
std::string circle_graph(int steps);

}  // namespace helixnav::apps
