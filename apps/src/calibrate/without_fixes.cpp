// SPDX-License-Identifier: BSD-3-Clause
#include "without_fixes.hpp"

#include <variant>

namespace helixnav::apps {

core::Recording without_fixes(const core::Recording& recording) {
  core::Recording rest;
  rest.start = recording.start;
  rest.name = recording.name;
  for (const core::Event& event : recording.events) {
    if (!std::holds_alternative<core::AbsoluteFix>(event)) rest.events.push_back(event);
  }
  return rest;
}

}  // namespace helixnav::apps
