// SPDX-License-Identifier: BSD-3-Clause
// After a closing: the drive is solved as a whole on its atlas, and the filter begins anew at the solution.
#include <memory>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "smoothing/smooth_drive.hpp"

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
  Smoothing smoothing = solve_on_atlas(report.numerics);
  core::SmoothingDecision decision;
  decision.accepted = smoothing.accepted;
  decision.chi2 = smoothing.chi2;
  decision.limit = smoothing.limit;
  decision.poses = smoothing.poses;
  decision.iterations = smoothing.iterations;
  decision.moved_m = (belief_.filter.pose().mean.position_m() - before.position_m()).norm();
  report.decisions.emplace_back(decision);
  if (!smoothing.accepted) return;
  tape_.append(Tape::Solved{smoothing.chi2});
  report.solved = std::move(smoothing.path);
}

/// A drive that should have been solved but was too long to be kept.
void NavigationLoop::report_unsolved(core::StepReport& report) const {
  const int most = options_.search.smooth_up_to_scans;
  if (belief_.drive || options_.search.closing == ClosingMethod::restart || most == 0 || tape_.stops() <= most) return;
  report.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::drive,
                                                        static_cast<double>(tape_.stops()), static_cast<double>(most)});
}

/// If it cannot be solved, everything stays as it is.
Smoothing NavigationLoop::solve_on_atlas(core::NumericalHealth& numerics) {
  Smoothing smoothing;
  try {
    auto drive = belief_.drive ? std::make_shared<DriveMap>(*belief_.drive) : begun_drive();
    smoothing = smooth_drive(belief_.filter, tape_, *drive);
    if (smoothing.accepted) {
      begin_window(std::move(drive), window_to_map());
    } else {
      become(std::move(drive), belief_.window);
    }
  } catch (const core::NumericalError&) {
    ++numerics.refused;
    smoothing = {};
  }
  return smoothing;
}

}  // namespace helixnav::supervisor
