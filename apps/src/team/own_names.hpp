// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// Names for the observations of one robot without identities: its own navigator decides which landmark each is.
class OwnNames {
 public:
  OwnNames() : navigator_(core::PoseGaussian{}) {}

  /// For a scan: a name for each observation, below 0 if the navigator gave none.
  std::vector<std::int64_t> take(const core::Event& event);

 private:
  supervisor::Navigator navigator_;
};

}  // namespace helixnav::apps
