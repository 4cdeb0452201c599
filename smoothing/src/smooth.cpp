// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/smooth.hpp"

#include <utility>

#include "factors.hpp"
#include "helixnav/smoothing/grow_start.hpp"

namespace helixnav::smoothing {

Report smooth(Problem& problem, const SmoothOptions& options) {
  Problem started = problem;
  if (options.start == Start::grown) grow_start(started, options.poses_per_stage);
  if (options.start == Start::softened) {
    Problem softened = problem;
    soften_odometry(softened, options.soften_sigma);
    optimize(softened, options.solver);
    put_state(state_of(softened.graph), started.graph);
  }
  Report report = optimize(started, options.solver);
  problem.graph = std::move(started.graph);
  return report;
}

}  // namespace helixnav::smoothing
