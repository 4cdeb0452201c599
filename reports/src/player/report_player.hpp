// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

constexpr std::size_t most_player_observations = 1'000'000;  ///< 7 MB; of longer drives every n-th scan is shown
constexpr std::size_t most_player_bytes = 12'000'000;        ///< likewise, where landmarks and paths leave less room

/// What the player of the page replays: every step's pose, the scans, the landmarks as they were known, the clouds. Packed
/// columns (packed.hpp), lengths in cm, headings in mrad, times in ms since the first step. Of a run read from its folder
/// the landmarks stand as known at the end, and scans are lines to landmarks.
Json player_data(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// The true landmarks, as they are ordered in the run, in the map frame.
std::vector<Eigen::Vector2d> true_landmarks_in_map(const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
