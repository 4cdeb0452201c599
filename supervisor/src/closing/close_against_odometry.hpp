// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "closing/close_map.hpp"
#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// A place that the landmarks alone decide on, and that odometry as measured forbids.
struct ForbiddenPlace {
  std::vector<pf_relocalize::ConstellationPair> pairs;
  core::Pose2 T_map_branch;  ///< where the branch is, from where the filter has it
  Closing as_measured;       ///< refused
  /// Length of the drive after which everything in view vanished and nothing known has been seen again: it was carried there.
  std::optional<double> carried_m = {};
};

/// What made odometry and place agree.
struct Reconciled {
  Closing closing;
  std::optional<cekf::CompressedEkf> filter;  ///< closed; nothing when refused
  std::optional<Tape> tape;                   ///< in agreement with the filter, without the merges yet
  double odometry_factor = 1.0;               ///< on the covariance of motion; 0: a jump at the trigger
  double loop_m = 0.0;                        ///< length of that motion
};

/// Whether the noise of odometry would have to be a thousand times the assumed variance.
bool was_no_noise(const Closing& as_measured);

/// By how much likelier a place has to be than without odometry, given how odometry as measured refused it: the
/// likelihood of a scale is factor^(−3/2), and that something else was wrong, with no pause in which the vehicle may
/// have been carried, is expected of one drive to a place in a million: rarer than repetitive ground, rows of trees and
/// blocks of houses (docs/no_prior.md). Test: supervisor/placing/whole_map_test.cpp.
double nats_against_odometry(const Closing& as_measured);

/// Closes the map at a place that odometry forbids. χ² of the pairs at a free pose decides on a place; the excess of
/// their cost with odometry, on three degrees of freedom, only says how wrong odometry was since the old landmarks of
/// the pairs were last seen. Its noise over this loop is taken to be large enough to make that excess what it should
/// be; the drive is solved with it, and the branch merged there as always, under the same limit. If it would have to be
/// a thousand times the assumed variance, the drive is cut instead where the vehicle last saw what it had mapped
/// before: a jump there, as uncertain as it is large; or where the search began, if the drive is not kept as a whole. A
/// single scale for a long loop has a likelihood of factor^(−3/2), 3e-5 at that limit; a jump to any place of a map as
/// large as the loop is not less likely. Refused if the pairs contradict each other in any case. Cost: a few closings
/// and a few solutions of the drive.
/// Test: supervisor/placing/whole_map_test.cpp.
Reconciled close_against_odometry(const cekf::CompressedEkf& filter, const core::PoseGaussian& start,
                                  const ClosingView& view, const ForbiddenPlace& place, const SearchOptions& options);

}  // namespace helixnav::supervisor
