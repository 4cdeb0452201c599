// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// Sets what suits the format of the log where neither command line nor configuration file said anything. DLR: a marker
/// every 4 m², seen over a few metres, wants cells of 4 m; with those of a park the whole building is one region (a run of
/// 3 s takes 40 s; the map is the same to round-off). Its `search` gets the distances and densities of markers 0.85 m
/// apart in a view of 1 to 3 m (the car park's that of reflectors); the defaults, for trees 8 m apart in a half disc of 30 m, close no loop here. Only fields
/// that no setting names are touched. Figures: docs/ihgr.md. Test: apps/associate_test.cpp (a whole run and its labels).
void suit_to_log(CLI::App& command, const std::filesystem::path& log, supervisor::SearchOptions& search);

/// For logs whose covariances promise too much or too little: of odometry and observations, by a factor.
void scale_covariances(core::Recording& recording, double scale);

}  // namespace helixnav::apps
