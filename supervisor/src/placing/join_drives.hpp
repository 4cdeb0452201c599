// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "helixnav/core/map_factors.hpp"
#include "placing/join_maps.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {

struct JoinedDrives {
  JoinedMaps maps;
  std::shared_ptr<const core::MapFactors> factors;  ///< of both
};

/// Two maps that were joined to first order, solved together as drives, one behind the other. Where maps are bent against each other
/// by as much as a landmark's spacing, many pairs are found only now: they are merged as they become clear, and everything is
/// solved again, with what either map has twice. `of_map`, `of_session`: landmarks of each, ascending. `across`: for pairs of both maps (across_sessions), `within`: of one. Nothing if the drives cannot be solved together, or contradict
/// each other: the first-order join remains. Test: supervisor/placing/join_drives_test.cpp.
std::optional<JoinedDrives> join_drives(const DriveMap& map, const std::vector<core::LandmarkId>& of_map,
                                        const DriveMap& session, const std::vector<core::LandmarkId>& of_session,
                                        const JoinedMaps& joined, const SearchOptions& within,
                                        const SearchOptions& across);

}  // namespace helixnav::supervisor
