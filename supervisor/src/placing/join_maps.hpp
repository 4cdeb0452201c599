// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/relocalize/answer.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Where a session is on an earlier map, as far as it is known before its landmarks are compared with the map's.
struct PlaceOnMap {
  core::PoseGaussian T_map_session;  ///< covariance (x, y, heading): of T given the errors of the map
  Eigen::MatrixXd by_map;            ///< errors of T per error of the map's landmarks, 3 rows, 2 columns a landmark
};

/// Session and earlier map as one joint Gaussian in the frame of the earlier one: the session moved by T_map_session, whose errors
/// its pose and landmarks share. First-order; pose first, then the landmarks of the session, then those of the map.
core::JointGaussian side_by_side(const core::JointGaussian& session, const core::JointGaussian& earlier,
                                 const PlaceOnMap& place);

/// A session that found its place.
struct JoinedMaps {
  cekf::CompressedEkf filter;  ///< frame of the earlier map
  Closing closing;             ///< what was merged, kept: the earlier map's landmark; refused unless accepted
  core::Pose2 T_map_session;   ///< in which the session was linearised
};

/// How far leftovers are merged: one by one, or also as segments where one alone is ambiguous. A drive that goes on decides these later,
/// by what it sees; maps of drives that have ended cannot.
enum class LeftTwice { one_by_one, in_segments };

/// One map of both. The session is linearised at the place's pose, and what is known of that pose comes from the pairs,
/// each of which says that two landmarks differ by no more than pair_noise_m. It enters with a covariance of a hundred
/// of its standard deviations around where the map's own landmarks of the pairs are: relative to these and not to the
/// frame, so that it says nothing about where in the frame they are, however little the map knows of it. Then further
/// pairs that the joint covariance leaves no doubt about are merged (SessionLeftovers). Refused if the cost of the pairs exceeds
/// options.closing_probability, whichever few were dropped.
/// confirmed: landmarks of the session that may be merged, unconfirmed: those that may be clutter; ascending.
/// Cost O(N²·pairs) for N landmarks in all. Test: supervisor/placing/join_maps_test.cpp (equal to least squares over
/// both maps).
JoinedMaps join_maps(const cekf::CompressedEkf& session, const core::JointGaussian& earlier,
                     const relocalize::Place& place, const std::vector<core::LandmarkId>& confirmed,
                     const std::vector<core::LandmarkId>& unconfirmed, double pair_noise_m,
                     const SearchOptions& options, LeftTwice left_twice = LeftTwice::one_by_one);

/// For pairs between two drives, of which a place has so many: they differ by more than the noise of one.
SearchOptions across_sessions(SearchOptions options, double pair_noise_m, std::size_t pairs);

}  // namespace helixnav::supervisor
