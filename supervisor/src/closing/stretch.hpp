// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "closing/branch_pairs.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// A landmark of a stretch and what it may be a copy of.
struct Copy {
  core::LandmarkId id;
  std::vector<Leftover> may_be;
  double variance_m2;  ///< of its offset
};

/// A place of a stretch in the map, and the evidence for and against it.
struct Placing {
  core::Pose2 T_world_stretch;
  std::vector<pf_relocalize::ConstellationPair> pairs;
  double nats = 0.0;
};

/// Most of its pairs contradict the other's.
bool is_elsewhere(const Placing& placing, const Placing& other);

/// One stretch and the old ground around it. Its frame is the map before the closing, moved to the copy in its middle.
/// Test: supervisor/closing/duplicate_segment_test.cpp.
class Stretch {
 public:
  /// Places that are tried at most: ten times what orchards need. A stretch that may be almost anywhere is left to the whole map
  /// (search/whole_map).
  static constexpr std::size_t most_placings = 1000;

  Stretch(pf_relocalize::Constellation ground, const cekf::CompressedEkf& filter, const SearchOptions& options);

  const pf_relocalize::Constellation& ground() const { return ground_; }
  bool holds(core::LandmarkId id) const { return at_m_.count(id) > 0; }

  /// Where a landmark is in the stretch's frame.
  const Eigen::Vector2d& at_m(core::LandmarkId id) const { return at_m_.at(id); }

  /// Every place that brings two far-apart copies onto old landmarks that they may be; none if there are too many.
  std::vector<Placing> placings(const std::vector<Copy>& copies) const;

  /// The pairs that coincide there; `nats` is not set.
  Placing placed_at(const core::Pose2& T_world_stretch) const;

  /// ln of the likelihood of a placing: that of its partners, less (J − dof)/2 for the cost J of merging its pairs.
  double nats(const Placing& placing) const;

  /// ln of the likelihood that so many landmarks have a partner there, and so many have none, at an unknown rate.
  double nats_of_partners(const Placing& placing) const;

  /// Landmarks of either drive without a partner, on ground that both looked at.
  int count_alone(const Placing& placing) const;

 private:
  /// False if there are too many to try.
  bool add_placings(const Copy& a, const Copy& b, std::vector<Placing>& found, std::size_t& tried) const;

  pf_relocalize::Constellation ground_;
  const cekf::CompressedEkf& filter_;
  const SearchOptions& options_;
  std::map<core::LandmarkId, Eigen::Vector2d> at_m_;  ///< of the branch
};

}  // namespace helixnav::supervisor
