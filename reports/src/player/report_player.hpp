// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

constexpr std::size_t most_player_observations = 1'000'000;  ///< 7 MB; for longer drives every n-th scan is shown
constexpr std::size_t most_player_bytes = 12'000'000;        ///< likewise, if landmarks and paths leave less room

/// What the page's player replays: every step's pose, the scans, the landmarks as known at the time, the clouds. Packed
/// columns (packed.hpp), lengths in cm, headings in mrad, times in ms since the first step. For a run read from its folder
/// the landmarks are as known at the end, and scans are lines to landmarks.
Json player_data(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// The true landmarks, in the run's order, in the map frame.
std::vector<Eigen::Vector2d> true_landmarks_in_map(const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
