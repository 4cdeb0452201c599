// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/acfr_recording.hpp"
#include "helixnav/mrpt_adapter/map_builder_options.hpp"
#include "reading/wheel_steering.hpp"

namespace helixnav::apps {

/// The vehicle for wheel_steering.hpp that belongs to a detector: car park with reflectors, else Victoria Park.
logs::AcfrSettings vehicle_for(const std::string& detector);

/// A whole rawlog in memory. InputError if it is damaged anywhere.
RawlogEntries read_entries(const std::string& path);

/// Every valid GPS fix, for evaluation: metres east and north of the first, for the antenna that the last one names.
void add_true_positions(const RawlogEntries& entries, const mrpt_adapter::MapBuilderOptions& options,
                        core::Recording& recording);

/// A rawlog, of frames or of single observations, as events in the order of the file; frames in their own order.
/// Movements and observations as in mrpt_adapter/conversions.hpp, with its options; landmarkIDs become labels if any are
/// present, GPS becomes positions for evaluation in metres east and north of the first fix. Observations of other
/// classes are skipped. An increment ends at the observation that follows it. InputError names the entry that cannot be
/// converted, or the observation without time. Test: mrpt_apps/convert_test.cpp.
core::Recording read_rawlog(const std::string& path, const mrpt_adapter::MapBuilderOptions& options);

}  // namespace helixnav::apps
