// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "closing/branch_pairs.hpp"
#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Copies that the vehicle left behind before the loop was closed. Their error is large beside the distance to the next
/// old landmark, so that none can be told alone, but they have it in common: a stretch of them is placed as a whole, and
/// what the wrong places cost grows with its size. Built before the closing moves the branch, asked after it.
class DuplicateSegment {
 public:
  DuplicateSegment(const cekf::CompressedEkf& filter, const Branch& branch);

  /// Pairs of the stretch around the copy that the closed map knows best, nothing when there is no such stretch or when a
  /// rival place is not a thousand times less likely. A place is weighed by log ∫ rᴹ(1 − r)ᵘ dr − (J − dof)/2: M
  /// landmarks stand where the other drive has one, u stand alone on ground that both looked at, at a rate r that nobody
  /// knows, and J is the cost of merging the M. J's expectation is its dof where the place is right, so that a place is
  /// not worse for having more pairs. `old` ascending. Some ms for 40 copies in a lattice.
  /// Measured: docs/closing.md. Test: supervisor/duplicate_segment_test.cpp, supervisor/lattice_test.cpp.
  KeptRemoved place(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& old,
                    const SearchOptions& options) const;

 private:
  /// The stretch around a landmark of the branch, in a frame there with the axes of the map before the closing, and the
  /// old ground within reach_m of where the landmark is now.
  pf_relocalize::Constellation ground_around(core::LandmarkId middle, double reach_m, const cekf::CompressedEkf& filter,
                                             const std::vector<core::LandmarkId>& old,
                                             const SearchOptions& options) const;

  std::vector<core::LandmarkId> confirmed_;
  std::map<core::LandmarkId, Eigen::Vector2d> before_m_;  ///< where the branch had them
  pf_relocalize::Coverage old_drive_, new_drive_;
};

}  // namespace helixnav::supervisor
