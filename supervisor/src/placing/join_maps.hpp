// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/relocalize/answer.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Session and earlier map as one joint Gaussian in the frame of the earlier one, nothing in common yet: the session moved by
/// T_map_session, whose covariance (x, y, heading) its pose and landmarks share. First-order; pose first, then the landmarks
/// of the session, then those of the map.
core::JointGaussian side_by_side(const core::JointGaussian& session, const core::JointGaussian& earlier,
                                 const core::PoseGaussian& T_map_session);

/// A session that found its place.
struct JoinedMaps {
  cekf::CompressedEkf filter;  ///< frame of the earlier map
  Closing closing;             ///< what was merged, kept: the earlier map's landmark; refused unless accepted
  core::Pose2 T_map_session;   ///< in which the session was linearised
};

/// One map of both. The place's pose enters with a covariance of a hundred of its standard deviations: it is where the
/// session is linearised, and what is known of it comes from the pairs, each of which says that two landmarks differ by no
/// more than pair_noise_m. Then further pairs that the joint covariance leaves no doubt of are merged. Refused when the cost
/// of the pairs exceeds options.closing_probability, whatever few were dropped.
/// confirmed: landmarks of the session that may be merged, unconfirmed: those that may be clutter; ascending.
/// Cost O(N²·pairs) for N landmarks in all. Test: supervisor/placing/join_maps_test.cpp (equal to least squares over both maps).
JoinedMaps join_maps(const cekf::CompressedEkf& session, const core::JointGaussian& earlier,
                     const relocalize::Place& place, const std::vector<core::LandmarkId>& confirmed,
                     const std::vector<core::LandmarkId>& unconfirmed, double pair_noise_m,
                     const SearchOptions& options);

}  // namespace helixnav::supervisor
