// SPDX-License-Identifier: BSD-3-Clause
// After a closing: the drive is solved as a whole, over all its poses or, where it is long, on the atlas.
#include <memory>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/navigation_loop.hpp"
#include "smoothing/solve_on_atlas.hpp"

namespace helixnav::supervisor {

void NavigationLoop::solve_drive(core::StepReport& report) {
  if (options_.search.closing == ClosingMethod::restart)
    tape_.drop_drive();  // what came before the restart no longer constrains the map
  if (!belief_.drive && !tape_.holds_drive()) return;
  const core::Pose2 before = belief_.filter.pose().mean;
  Smoothing smoothing = solved_drive();
  if (smoothing.solved) {
    std::swap(belief_.filter, *smoothing.solved);
    if (!undo_.filter) undo_.filter.emplace(std::move(*smoothing.solved));
    tape_.append(Tape::Solved{smoothing.chi2});
    report.solved = std::move(smoothing.path);
  }
  core::SmoothingDecision decision;
  decision.accepted = smoothing.solved.has_value();
  decision.chi2 = smoothing.chi2;
  decision.limit = smoothing.limit;
  decision.poses = smoothing.poses;
  decision.iterations = smoothing.iterations;
  decision.moved_m = (belief_.filter.pose().mean.position_m() - before.position_m()).norm();
  report.decisions.emplace_back(decision);
}

/// Where the atlas cannot be solved, least squares over all poses has the last word as long as the tape holds them.
Smoothing NavigationLoop::solved_drive() {
  if (!is_for_atlas()) return smooth_drive(belief_.filter, start_, tape_);
  try {
    constexpr double phase_share = 2.0 / 3.0;  // 20 m where the sensor reaches 30 m
    auto drive = belief_.drive
                     ? std::make_shared<DriveMap>(*belief_.drive)
                     : std::make_shared<DriveMap>(start_, phase_share * view_.reach().value_or(reference_reach_m));
    Smoothing smoothing = solve_on_atlas(belief_.filter, tape_, *drive);
    become(std::move(drive));
    return smoothing;
  } catch (const core::NumericalError&) {
    if (tape_.holds_drive()) return smooth_drive(belief_.filter, start_, tape_);
    become(nullptr);
    tape_.drop_drive();
    return {};
  }
}

/// Least squares over all poses is the faster one on small maps and short drives.
bool NavigationLoop::is_for_atlas() const {
  return belief_.drive || belief_.filter.mapped_count() > options_.map.window;
}

void NavigationLoop::become(std::shared_ptr<const DriveMap> drive) {
  std::swap(belief_.drive, drive);
  if (!undo_.drive) undo_.drive.emplace(std::move(drive));
}

}  // namespace helixnav::supervisor
