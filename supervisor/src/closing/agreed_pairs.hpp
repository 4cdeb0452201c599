// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// The pairs that every likely way of pairing the branch about this place has. Where landmarks stand nearer to each other than places
/// are told apart (RivalOptions::apart_m), as posts of a fence or trees of a clump do, the branch also fits when it is shifted by the
/// way from one to the next, and tolerances let wrong neighbours pass. Each such shift that fits at least rival_match_share of the
/// pairs is fitted, paired one to one by distance, and weighed: ln 1000 for each pair less half of χ² of all, odometry included,
/// without pairs that contradict the rest. The best way is returned, without the pairs that another way does not have which is within
/// ln 1000 of it and pairs some of the same old landmarks with others of the branch: none where a row fits in two ways, and a closing
/// is refused then. `pairs` unchanged where nothing stands near; else ascending by old landmark. O(pairs · neighbours), and a χ² for
/// each way that differs. Source: docs/closing.md. Test: supervisor/closing/agreed_pairs_test.cpp.
std::vector<pf_relocalize::ConstellationPair> agreed_pairs(const cekf::CompressedEkf& filter, const Branch& branch,
                                                           const std::vector<core::LandmarkId>& old,
                                                           const std::vector<pf_relocalize::ConstellationPair>& pairs,
                                                           const SearchOptions& options);

}  // namespace helixnav::supervisor
