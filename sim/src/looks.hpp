// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/core/appearance.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/sim/scenario.hpp"
#include "helixnav/sim/world.hpp"

namespace helixnav::sim {

/// What the scanner reports of trees besides where they are. Draws from its own stream: with or without, scans are the
/// same.
class Looks {
 public:
  Looks(const LooksOptions& options, std::uint64_t seed) : options_(options), random_(seed, "sim.looks") {}

  core::Appearance of(const Tree& tree);
  core::Appearance of_clutter();  ///< looks like any tree

 private:
  LooksOptions options_;
  core::RandomStream random_;
};

}  // namespace helixnav::sim
