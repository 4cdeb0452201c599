// SPDX-License-Identifier: BSD-3-Clause
#include "placing/gap_in_sightings.hpp"

#include <algorithm>
#include <vector>

namespace helixnav::supervisor {
namespace {

int count_below(const std::vector<double>& ascending, double path_m) {
  return static_cast<int>(std::lower_bound(ascending.begin(), ascending.end(), path_m) - ascending.begin());
}

}  // namespace

std::optional<SightingGap> gap_in_sightings(const association::LandmarkLife& existence, double from_m, double until_m) {
  std::vector<double> born_m, last_seen_m;
  for (const association::LandmarkRecord& record : existence.records()) {
    born_m.push_back(record.born_path_m);
    last_seen_m.push_back(record.last_seen_path_m);
  }
  std::sort(born_m.begin(), born_m.end());
  std::sort(last_seen_m.begin(), last_seen_m.end());
  std::optional<SightingGap> gap;
  for (auto at = std::upper_bound(born_m.begin(), born_m.end(), from_m); at != born_m.end() && *at <= until_m; ++at) {
    const int over = count_below(last_seen_m, *at);
    const int across = count_below(born_m, *at) - over;
    if (gap && across > gap->across) continue;
    if (!gap || across < gap->across) gap = SightingGap{*at, *at, across, 0};
    gap->last_m = *at;
    gap->since = static_cast<int>(last_seen_m.size()) - over;
  }
  return gap;
}

}  // namespace helixnav::supervisor
