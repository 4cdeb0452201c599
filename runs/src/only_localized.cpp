// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/only_localized.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>

namespace helixnav::runs {

bool only_localized(const Run& run) {
  std::istringstream words(run.manifest.command);
  return std::any_of(std::istream_iterator<std::string>(words), {},
                     [](const std::string& word) { return word == "--localize"; });
}

}  // namespace helixnav::runs
