// SPDX-License-Identifier: BSD-3-Clause
// After a closing: the drive is solved as a whole, over all its poses or, where it is long, on the atlas.
#include <memory>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "smoothing/solve_on_atlas.hpp"

namespace helixnav::supervisor {

void NavigationLoop::solve_drive(core::StepReport& report) {
  if (options_.search.closing == ClosingMethod::restart)
    tape_.drop_drive();  // what came before the restart no longer constrains the map
  const bool is_whole = belief_.drive ? tape_.holds_since(belief_.drive->end()) : tape_.holds_drive();
  if (!is_whole) {
    report_unsolved(report);
    return;
  }
  const core::Pose2 before = belief_.filter.pose().mean;
  report.numerics.note(belief_.filter.take_health());
  bool accepted = false;
  Smoothing smoothing = is_for_atlas() ? solve_by_atlas(accepted) : solve_by_poses(accepted);
  if (accepted) {
    tape_.append(Tape::Solved{smoothing.chi2});
    report.solved = std::move(smoothing.path);
  }
  report.numerics.refused += smoothing.failed ? 1 : 0;
  core::SmoothingDecision decision;
  decision.accepted = accepted;
  decision.chi2 = smoothing.chi2;
  decision.limit = smoothing.limit;
  decision.poses = smoothing.poses;
  decision.iterations = smoothing.iterations;
  decision.moved_m = (belief_.filter.pose().mean.position_m() - before.position_m()).norm();
  report.decisions.emplace_back(decision);
}

/// A drive that was to be solved and was too long to be kept.
void NavigationLoop::report_unsolved(core::StepReport& report) const {
  const int most = options_.search.smooth_up_to_scans;
  if (belief_.drive || options_.search.closing == ClosingMethod::restart || most == 0 || tape_.stops() <= most) return;
  report.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::drive,
                                                        static_cast<double>(tape_.stops()), static_cast<double>(most)});
}

Smoothing NavigationLoop::solve_by_poses(bool& accepted) {
  Smoothing smoothing = smooth_drive(belief_.filter, start_, tape_);
  accepted = smoothing.solved.has_value();
  if (!accepted) return smoothing;
  std::swap(belief_.filter, *smoothing.solved);
  if (!undo_.filter) undo_.filter.emplace(std::move(*smoothing.solved));
  return smoothing;
}

/// Where the atlas cannot be solved, least squares over all poses has the last word as long as the tape holds them.
Smoothing NavigationLoop::solve_by_atlas(bool& accepted) {
  try {
    auto drive = belief_.drive ? std::make_shared<DriveMap>(*belief_.drive) : begun_drive();
    AtlasSolution solution = solve_on_atlas(belief_.filter, tape_, *drive);
    if (solution.accepted) {
      begin_window(std::move(drive), window_to_map());
    } else {
      become(std::move(drive), belief_.window);
    }
    accepted = solution.accepted;
    return solution.figures;
  } catch (const core::NumericalError&) {
    Smoothing smoothing;
    smoothing.failed = true;
    if (!tape_.holds_drive()) return smoothing;
    smoothing = solve_by_poses(accepted);
    pending_.numerics.repaired += accepted ? 1 : 0;
    return smoothing;
  }
}

/// Least squares over all poses is the faster one on small maps and short drives.
bool NavigationLoop::is_for_atlas() const {
  return belief_.drive != nullptr || belief_.filter.mapped_count() > options_.map.solve_over_poses;
}

}  // namespace helixnav::supervisor
