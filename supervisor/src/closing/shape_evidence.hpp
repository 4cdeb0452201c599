// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "closing/branch_pairs.hpp"
#include "helixnav/core/decision.hpp"

namespace helixnav::supervisor {

/// χ² of the pairs with the branch free to be moved and turned as a whole: how well its shape agrees with the old map's, whatever was
/// believed of its place. Linearised where the branch is fitted to the pairs. Nothing if the covariance is not positive
/// definite. O(pairs³). Test: supervisor/closing/shape_evidence_test.cpp (a free pose by hand).
struct ShapeCost {
  double chi2 = 0.0;
  int dof = 0;
};
std::optional<ShapeCost> shape_cost(const cekf::CompressedEkf& filter, const KeptRemoved& pairs, double sigma_m);

/// Pairs that continue those of one place back along the branch, from its last landmark to its first: each is placed by the nearest
/// ones that have a pair, so that a drift along the branch does not matter. O(branch · pairs).
/// Test: supervisor/closing/shape_evidence_test.cpp.
struct AlongBranch {
  KeptRemoved pairs;
  int alone = 0;  ///< landmarks without a partner on ground that the old drive covered
};
AlongBranch continued_along(const cekf::CompressedEkf& filter, const Branch& branch,
                            const std::vector<core::LandmarkId>& old, const KeptRemoved& pairs,
                            const SearchOptions& options);

/// Which of several places that all explain the constellation around the vehicle the shape of the whole branch belongs to. On a track
/// or an avenue any few trees fit any others one pitch on; a bend in between does not. The place's χ² is within the limit of a closing,
/// and every other place is refuted: its χ² exceeds what one right place in a million has, or landmarks without a partner make it a
/// thousand times less likely; and it explains no more landmarks, since at the rim of an orchard, where most are on unmapped ground, a
/// few fit by themselves. Where places repeat exactly, the difference of two χ² that are both usual is chance. Nothing if that holds
/// for none. `place` of the answer is its index in `places`.
/// Source: docs/closing.md. Test: supervisor/closing/shape_evidence_test.cpp.
std::optional<core::ShapeDecision> decided_by_shape(const cekf::CompressedEkf& filter,
                                                    const std::vector<AlongBranch>& places,
                                                    const SearchOptions& options);

}  // namespace helixnav::supervisor
