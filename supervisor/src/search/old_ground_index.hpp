// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/relocalize/map_index.hpp"

namespace helixnav::supervisor {

/// The old landmarks of the present map, ready to be asked for a place. They stay in it where they were when they
/// became old: a closing moves a part of the map as a whole, and a place is decided by pairs.
/// Test: supervisor/placing/whole_map_test.cpp.
class OldGroundIndex {
 public:
  explicit OldGroundIndex(const relocalize::IndexOptions& lengths) : index_(lengths) {}

  /// Adds those of `old` (ascending) that it lacks and drops those that the filter no longer has. A joint covariance
  /// for every forty new ones with their neighbours.
  void follow(const cekf::CompressedEkf& filter, const core::MapAppearance& appearance,
              const std::vector<core::LandmarkId>& old);

  bool contains(core::LandmarkId id) const { return index_.contains(id); }
  const relocalize::MapIndex& index() const { return index_; }

 private:
  void insert(const std::vector<core::LandmarkId>& added, const cekf::CompressedEkf& filter,
              const core::MapAppearance& appearance, const std::vector<core::LandmarkId>& old);

  relocalize::MapIndex index_;
  std::vector<core::LandmarkId> ids_;  ///< ascending
};

}  // namespace helixnav::supervisor
