// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "circuits.hpp"
#include "helixnav/evaluation/referee.hpp"

namespace helixnav::supervisor {

/// A navigator, with default or given options, drives the scenario and is judged by the truth.
inline evaluation::RunScore navigate_and_judge(const sim::Scenario& scenario, std::uint64_t seed,
                                               NavigatorOptions options = {}) {
  const sim::World world = sim::build_world(scenario.world, seed);
  const core::Recording run = sim::simulate_in(world, scenario, seed);
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  evaluation::Referee referee(run, world.returns_at_m);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) {
    referee.watch(navigator.observe(scan), [&] { return navigator.sketch(); });
  });
  return referee.score(navigator.map());
}

}  // namespace helixnav::supervisor
