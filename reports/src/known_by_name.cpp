// SPDX-License-Identifier: BSD-3-Clause
#include "known_by_name.hpp"

#include <sstream>
#include <string>
#include <utility>

namespace helixnav::reports {

bool known_by_name(const runs::Run& run) {
  if (!run.names.empty()) return true;
  std::istringstream words(run.manifest.command);
  std::string before, word;
  while (words >> word) {
    if (word == "--association=known" || (before == "--association" && word == "known")) return true;
    before = std::exchange(word, {});
  }
  return false;
}

}  // namespace helixnav::reports
