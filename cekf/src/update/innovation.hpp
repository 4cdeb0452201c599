// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "helixnav/cekf/filter_options.hpp"
#include "helixnav/cekf/match.hpp"
#include "helixnav/cekf/update_workspace.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::cekf {

/// Throws PreconditionError naming the verb and the landmark when the observation cannot be used.
void check_observation_of(const Match& match, const char* verb);
void check_fix(const core::AbsoluteFix& fix, const char* verb);

/// "<verb>: <what>; landmarks <ids involved>".
std::string problem_with(const UpdateWorkspace& w, const char* verb, const char* what);

/// Sorts out which landmarks are involved: w.ids and w.landmark_of_row.
void name_landmarks(const std::vector<Match>& matches, UpdateWorkspace& w);

/// H, R and ν at w.pose and w.points_m, for sightings, for an absolute fix, and for pairs of landmarks taken to be the
/// same (landmark_of_row names first and second of each pair in turn).
void linearise_sightings(const std::vector<Match>& matches, UpdateWorkspace& w, const char* verb);
void linearise_fix(const core::AbsoluteFix& fix, UpdateWorkspace& w);
void linearise_pairs(double sigma_m, UpdateWorkspace& w);

/// An update with so many landmarks that the sparsity of H is used: zero except for the vehicle and one or two landmarks
/// per row. Maps are joined this way. No scan is this large (core::most_observations_used aside), and nothing is allocated
/// for others.
bool is_wide(const UpdateWorkspace& w);
struct Nonzero {
  Eigen::Index row;
  Eigen::Index column;
  double value;
};
/// Row by row.
std::vector<Nonzero> nonzeros_of(const ReservedMatrix& H);

/// S = H·P·Hᵀ + R = L·Lᵀ, G = L⁻¹H unless the update is wide, y = L⁻¹ν, gain = HᵀS⁻¹ν; returns νᵀS⁻¹ν. NumericalError when S
/// is not positive definite. Noted in w.health.
double solve_innovation(UpdateWorkspace& w, const char* verb);

}  // namespace helixnav::cekf
