// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/duplicate_segment.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// How many of so many pairs of two maps may be dropped because the others contradict them.
int most_dropped_of(std::size_t pairs);

/// What of a session is still on an earlier map twice once the first pairs are merged. Built before these move the session, used after.
class SessionLeftovers {
 public:
  /// `filter`: both maps side by side; `confirmed`: landmarks of the session that may be merged, ascending. O(N²).
  SessionLeftovers(const cekf::CompressedEkf& filter, const core::JointGaussian& earlier,
                   std::vector<core::LandmarkId> confirmed, const SearchOptions& across);

  /// Merges pairs that the joint covariance leaves no doubt about, nearest first: each ties the session's drive more
  /// firmly to the map where it was long before, and so helps the next one. Every pass removes a landmark.
  /// Test: supervisor/placing/join_maps_test.cpp.
  void merge_one_by_one(cekf::CompressedEkf& filter, Closing& closing) const;

  /// Then, where the two maps are bent against each other by as much as a landmark's spacing and each copy alone may be several
  /// landmarks: aligns segments of copies as a whole (DuplicateSegment::place_next), and after each merges what has become
  /// clear one by one, as far as the pairs around it agree. A segment one of whose landmarks would become a landmark that the
  /// session has already stays, as does what the ground repeats. Test: supervisor/placing/session_leftovers_test.cpp.
  void merge_segments(cekf::CompressedEkf& filter, Closing& closing) const;

 private:
  template <class MayBe>
  void merge_those(cekf::CompressedEkf& filter, Closing& closing, MayBe may_be) const;
  double distance_m(core::LandmarkId a, core::LandmarkId b) const;  ///< before the join
  KeptRemoved merged_around(core::LandmarkId id, const Closing& closing) const;
  bool agrees(const cekf::CompressedEkf& filter, const cekf::CompressedEkf::LandmarkPair& pair,
              const Closing& closing) const;
  SearchOptions for_segment(std::size_t pairs) const;

  SearchOptions across_;
  std::vector<core::LandmarkId> confirmed_, old_;
  double spacing_m_;  ///< of the earlier map's landmarks
  DuplicateSegment segments_;
};

}  // namespace helixnav::supervisor
