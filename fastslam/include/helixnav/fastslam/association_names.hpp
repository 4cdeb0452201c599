// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "helixnav/fastslam/options.hpp"

namespace helixnav::fastslam {

/// What configurations call the kinds of association.
inline const std::vector<std::pair<std::string, Association>>& association_names() {
  // never destroyed: a thread may still be here when the process ends
  static const auto& names = *new const std::vector<std::pair<std::string, Association>>{
      {"known", Association::known},
      {"nearest-neighbour", Association::nearest_neighbour},
      {"likelihood-ratio", Association::likelihood_ratio},
      {"sampled", Association::sampled},
      {"multiple-hypotheses", Association::multiple_hypotheses}};
  return names;
}

}  // namespace helixnav::fastslam
