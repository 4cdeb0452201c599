// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <vector>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::evaluation {

/// Which tree each landmark is, by the labels of its observations: the majority, until the landmark is old. Then it is
/// fixed: later wrong matches must not turn it into another tree.
class Identities {
 public:
  explicit Identities(int old_sightings) : old_sightings_(old_sightings) {}

  void add_sighting(core::LandmarkId id, core::Label label, double driven_m);

  /// Fixes those that have not been seen since `seen_before_m`, all of them or a single one.
  void fix_unseen(double seen_before_m);
  void fix_if_unseen(core::LandmarkId id, double seen_before_m);

  /// A fixed landmark that was a tree when it was fixed, and not just a few false detections.
  bool is_old(core::LandmarkId id) const;

  /// no_label for false detections and for landmarks never seen.
  core::Label identity(core::LandmarkId id) const;

  /// Trees represented by old landmarks.
  std::set<core::Label> old_trees() const;

 private:
  struct Record {
    std::map<core::Label, int> votes;
    double last_seen_m = 0.0;
    bool fixed = false;
  };
  static core::Label majority(const Record& record);

  int old_sightings_;
  std::map<core::LandmarkId, Record> records_;
};

}  // namespace helixnav::evaluation
