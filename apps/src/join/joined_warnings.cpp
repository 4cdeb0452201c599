// SPDX-License-Identifier: BSD-3-Clause
#include "joined_warnings.hpp"

#include <algorithm>
#include <cstddef>

namespace helixnav::apps {

std::vector<std::string> joined_warnings(const supervisor::JoinedSessions& joined,
                                         const std::vector<ChangedLandmark>& shared) {
  constexpr std::size_t few = 5, one_in = 20;
  std::vector<std::string> warnings;
  for (std::size_t number = 0; number < joined.components.size(); ++number) {
    const auto is_copy = [&](const ChangedLandmark& one) {
      return one.component == number && one.perhaps_copy_of != core::no_landmark;
    };
    const auto pairs = static_cast<std::size_t>(std::count_if(shared.begin(), shared.end(), is_copy)) / 2;
    const std::size_t landmarks = joined.components[number].joint.ids.size();
    if (pairs < few || pairs * one_in < landmarks) continue;
    warnings.push_back("component " + std::to_string(number + 1) + ": " + std::to_string(pairs) + " of its " +
                       std::to_string(landmarks) +
                       " landmarks stand where another one may stand that no common run saw: they are on the map "
                       "twice, since the runs do not tell them from their neighbours (perhaps_copy_of in changes.csv)");
  }
  return warnings;
}

}  // namespace helixnav::apps
