// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "helixnav/fastslam/options.hpp"
#include "hypothesis.hpp"
#include "lineages.hpp"
#include "persistent_map.hpp"
#include "scan_model.hpp"

namespace helixnav::fastslam {

/// What one worker reuses, and what it finds on the way.
struct RealiseScratch {
  std::vector<LineageId> in_reach;                  ///< lineages that may be in view, for a block of particles
  std::vector<std::pair<LineageId, float>> growth;  ///< lineages whose reach has become too short, with the reach due
};

/// Brings the maps of particles, whose poses are drawn by now, up to a scan: landmarks matched are updated, landmarks
/// that should have been seen lose odds of existence, and new ones are born.
class MapUpdate {
 public:
  /// births[j]: the lineage that a landmark born from observation j belongs to. `look`: number of the robot's look.
  MapUpdate(const Options& options, const PreparedScan& scan, const Lineages& lineages,
            const std::vector<LineageId>& births, std::uint16_t look);

  /// Finds the lineages that may be in view of any of the poses.
  void look_around(const std::vector<Eigen::Vector3d>& poses, std::size_t begin, std::size_t end,
                   RealiseScratch& scratch) const;

  void apply(const Eigen::Vector3d& pose, const Choice* choices, PersistentMap& map, NodePool& pool,
             RealiseScratch& scratch) const;

 private:
  void update(const TurnedPose& pose, LineageId id, const PreparedObservation& z, PersistentMap& map, NodePool& pool,
              RealiseScratch& scratch) const;
  void count_hit(LandmarkRecord& landmark) const;
  void count_misses(const TurnedPose& pose, const Choice* choices, PersistentMap& map, NodePool& pool,
                    const RealiseScratch& scratch) const;
  bool is_seen_or_hidden(const TurnedPose& pose, const Choice* choices, LineageId id,
                         const Eigen::Vector2d& place_m) const;
  void give_birth(const TurnedPose& pose, LineageId id, const PreparedObservation& z, PersistentMap& map,
                  NodePool& pool, RealiseScratch& scratch) const;
  void note_reach(LineageId id, const LandmarkRecord& landmark, RealiseScratch& scratch) const;

  const Options& options_;
  const PreparedScan& scan_;
  const Lineages& lineages_;
  const std::vector<LineageId>& births_;
  std::uint16_t look_;
  ViewTest expected_;
  float hit_nats_, miss_nats_;
};

}  // namespace helixnav::fastslam
