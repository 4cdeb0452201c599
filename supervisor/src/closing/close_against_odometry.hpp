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

/// A place that the landmarks alone decide for, and that odometry as it was measured forbids.
struct ForbiddenPlace {
  std::vector<pf_relocalize::ConstellationPair> pairs;
  core::Pose2 T_map_branch;  ///< where the branch is, from where the filter has it
  Closing as_measured;       ///< refused
};

/// What made odometry and place agree.
struct Reconciled {
  Closing closing;
  std::optional<cekf::CompressedEkf> filter;  ///< closed; nothing when refused
  std::optional<Tape> tape;                   ///< that the filter agrees with, the merges not on it yet
  double odometry_factor = 1.0;               ///< on the covariance of motion; 0: a jump at the trigger
  double loop_m = 0.0;                        ///< length of that motion
};

/// Its noise would have to be a thousand times the variance that was assumed.
bool was_no_noise(const Closing& as_measured);

/// What a place has to be likelier by than without odometry, from how odometry as measured refused it: the likelihood of a scale is
/// factor^(−3/2), and that something else was wrong, with no pause in which the vehicle may have been carried, is expected of one drive
/// to a place in a million: rarer than ground that repeats itself, rows of trees and blocks of houses (docs/slips.md). Test: supervisor/placing/whole_map_test.cpp.
double nats_against_odometry(const Closing& as_measured);

/// Closes the map at a place that odometry forbids. χ² of the pairs at a free pose decides a place; what their cost with
/// odometry has beyond that, on three degrees of freedom, says only how wrong odometry was since the old landmarks of the
/// pairs were last seen. Its noise over this loop is taken to be as large as makes that excess what it should be; the drive
/// is solved with it, and the branch merged there as always, under the same limit. Where it would have to be a thousand
/// times the variance that was assumed the drive is cut instead, where the vehicle last saw what it had mapped before: a jump
/// there, as uncertain as it is large; or where the search began, when the drive is not kept as a whole. One scale for a long loop has a likelihood of
/// factor^(−3/2), 3e-5 there; a jump to any place of a map as large as the loop is not less likely.
/// Refused where the pairs contradict each other in any case. Cost: that of a closing and of solving the drive, each a few times.
/// Test: supervisor/placing/whole_map_test.cpp.
Reconciled close_against_odometry(const cekf::CompressedEkf& filter, const core::PoseGaussian& start,
                                  const ClosingView& view, const ForbiddenPlace& place, const SearchOptions& options);

}  // namespace helixnav::supervisor
