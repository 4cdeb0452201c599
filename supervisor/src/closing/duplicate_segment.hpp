// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "closing/branch_pairs.hpp"
#include "closing/closing.hpp"
#include "closing/stretch.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Alignment of a segment of duplicates that was mapped before the loop was closed. Their error is large compared with the
/// distance between old landmarks, so that each one alone is ambiguous, but it is common to all: a segment is aligned as a
/// whole, and the cost of wrong alignments grows with its size. Built before the closing moves the branch, used after it.
class DuplicateSegment {
 public:
  DuplicateSegment(const cekf::CompressedEkf& filter, const Branch& branch);

  /// Pairs of the segment around the copy that the closed map knows best, nothing if there is no such segment or if a
  /// rival alignment is not a thousand times less likely. An alignment is weighed by log ∫ rᴹ(1 − r)ᵘ dr − (J − dof)/2: M
  /// landmarks coincide with one of the other drive, u have no partner on ground that both covered, at an unknown rate r
  /// with a uniform prior, and J is the cost of merging the M. E[J] = dof at the right alignment, so that more pairs do not
  /// make it worse. `old` ascending. Some ms for 40 copies in a lattice.
  /// Measured: docs/closing.md. Test: supervisor/closing/duplicate_segment_test.cpp, supervisor/lattice_test.cpp.
  KeptRemoved place(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& old,
                    const SearchOptions& options) const;

  /// The same for maps of two drives that are bent against each other, where any place on the map may hold copies: the segment around the
  /// best-known copy that was, before the closing, farther than half a segment from all of `tried`, to which it is added. Nothing
  /// in the list unless the segment is surely placed (closing/sure_placing.hpp); no list once all segments were tried.
  /// Test: supervisor/placing/session_leftovers_test.cpp.
  std::optional<KeptRemoved> place_next(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& old,
                                        const SearchOptions& options, std::vector<core::LandmarkId>& tried) const;

  /// Where a landmark was before the closing.
  const Eigen::Vector2d& before_m(core::LandmarkId id) const { return before_m_.at(id); }

  const core::MapAppearance& appearance() const { return appearance_; }

 private:
  /// The segment around a landmark of the branch, in a frame there with the axes of the map before the closing, and the
  /// old ground within reach_m of where the landmark is now.
  pf_relocalize::Constellation ground_around(core::LandmarkId middle, double reach_m, const cekf::CompressedEkf& filter,
                                             const std::vector<core::LandmarkId>& old,
                                             const SearchOptions& options) const;

  /// The segment around one of the copies; those beyond it are erased.
  Stretch stretch_about(core::LandmarkId middle, std::vector<Copy>& copies, const cekf::CompressedEkf& filter,
                        const std::vector<core::LandmarkId>& old, const SearchOptions& options) const;

  std::vector<core::LandmarkId> confirmed_;
  std::map<core::LandmarkId, Eigen::Vector2d> before_m_;  ///< where the branch had them
  pf_relocalize::Coverage old_drive_, new_drive_;
  core::MapAppearance appearance_;
};

}  // namespace helixnav::supervisor
