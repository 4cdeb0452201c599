// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/pf_relocalize/relocalizer.hpp"

namespace helixnav::pf_relocalize {

/// Who descends from whom, for the last `scans` scans, in memory taken at the start (28 bytes a particle and scan,
/// touched only as far as the cloud reaches).
class Lineage {
 public:
  Lineage(std::size_t scans, std::size_t most_particles);

  /// Adds the cloud of one scan. parents[i]: index in the cloud added before; empty: particle i comes from i. `best`:
  /// where trace() starts.
  void append(core::Nanoseconds t_ns, const Particles& particles, const std::vector<std::uint32_t>& parents,
              std::uint32_t best);

  /// Poses of the last `best` and its ancestors, oldest first.
  std::vector<LineagePose> trace() const;

 private:
  struct Cloud {
    core::Nanoseconds t_ns = 0;
    std::vector<double> x_m, y_m, heading_rad;
    std::vector<std::uint32_t> parents;
  };
  std::vector<Cloud> ring_;
  std::size_t appended_ = 0;
  std::uint32_t best_ = 0;
};

}  // namespace helixnav::pf_relocalize
