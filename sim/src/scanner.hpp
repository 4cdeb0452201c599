// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/random.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/sim/scenario.hpp"
#include "looks.hpp"
#include "tree_grid.hpp"

namespace helixnav::sim {

/// A scan with the label of each observation.
struct LabelledScan {
  core::Scan scan;
  std::vector<core::Label> labels;
};

/// Observes the trees of a world with range and bearing noise, misses, clutter and occlusion, and what moves among
/// them, whose draws come from a separate stream: the trees' observations are the same as without it.
class Scanner {
 public:
  Scanner(const Scenario& scenario, const World& world, std::uint64_t seed);

  /// `moving_m`: where moving objects are now; they are detected like trees and have no label.
  LabelledScan look(const core::Pose2& T_world_robot, double along_m, core::Nanoseconds t_ns,
                    const std::vector<Eigen::Vector2d>& moving_m = {});

 private:
  struct Sighting {
    double range_m;
    double bearing_rad;
    core::Label label;
  };

  std::vector<Sighting> visible_trees(const core::Pose2& T_world_sensor, double along_m) const;
  bool occluded(const Sighting& sighting, const std::vector<Sighting>& nearer_first) const;
  void add(const Sighting& truth, core::RandomStream& random, LabelledScan& into);
  void add_mover(const core::Pose2& T_sensor_world, const Eigen::Vector2d& point_m, LabelledScan& into);
  void add_clutter(LabelledScan& into);
  void shuffle(LabelledScan& scan);

  const World& world_;
  ScannerOptions options_;
  TreeGrid grid_;
  NoiseLevels true_noise_;
  NoiseLevels assumed_noise_;
  core::RandomStream random_;
  Looks looks_;
  core::RandomStream movers_random_;
};

}  // namespace helixnav::sim
