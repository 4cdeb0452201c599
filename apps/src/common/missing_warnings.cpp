// SPDX-License-Identifier: BSD-3-Clause
#include "missing_warnings.hpp"

#include <cstdio>

namespace helixnav::apps {

void warn_of_missing(const std::vector<std::string>& missing) {
  for (const std::string& what : missing) std::fprintf(stderr, "helixnav: warning: %s\n", what.c_str());
}

}  // namespace helixnav::apps
