// SPDX-License-Identifier: BSD-3-Clause
// Learning the noise: what a scan tells about it, and solving the drive again once it is known.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {

/// Before the scan is associated, with the covariances that it claims. What is learnt already applies to this scan:
/// otherwise the second scan of a drive would begin a second copy of every landmark if the assumed noise were far too
/// small.
void NavigationLoop::learn_noise(const core::Scan& scan) {
  const Eigen::Matrix3d Q = std::exchange(noise_.moved, Eigen::Matrix3d::Zero());
  if (!options_.noise.adapt || searching() != nullptr) return;
  noise_.sides.next_scan();
  const std::vector<NoisePair> found = noise_pairs(belief_.filter, scan);
  constexpr std::size_t least_pairs = 3;
  if (found.size() < least_pairs) return;

  std::vector<core::LandmarkId> ids;
  std::vector<SeenPoint> seen;
  for (const NoisePair& pair : found) {
    ids.push_back(pair.landmark);
    seen.push_back(pair.seen);
    seen.back().covariance_m2 *= noise_.scale.observations();
  }
  const RelativeGeometry geometry(belief_.filter.joint(ids));
  std::vector<PointPair> pairs;
  std::vector<Look> looks;
  for (std::size_t k = 0; k < found.size(); ++k) {
    pairs.push_back({k, k});
    const Eigen::Vector2d at_m = core::transform(belief_.filter.pose().mean, seen[k].point_m);
    const Eigen::Vector2d back_m = belief_.filter.pose().mean.position_m() - at_m;
    looks.push_back({ids[k], noise_.sides.is_new_side(ids[k], std::atan2(back_m.y(), back_m.x())),
                     is_fair(found[k], geometry.covariance_of(k, k) + seen[k].covariance_m2)});
  }
  noise_.scale.observe(PairEquations(geometry, seen, pairs, Eigen::Vector3d::Zero()), looks,
                       belief_.filter.pose().mean.heading_rad, Q);
}

/// While a search is open nothing is learnt: where the vehicle is is in question.
void NavigationLoop::learn_noise(const core::AbsoluteFix& fix, const FixInnovation& innovation) {
  if (!options_.noise.adapt || searching() != nullptr) return;
  noise_.fixes.observe(innovation, core::chi2_quantile(options_.fix_probability, 2), fix.t_ns);
}

/// What was processed with other noise before it was known is solved again with the noise as it is known now; if it
/// cannot be solved, everything stays as it was.
void NavigationLoop::solve_with_learnt_noise(core::StepReport& report) {
  constexpr double too_little = 1.25;   // overconfident: corrected at once
  constexpr double too_much = 1.0 / 3;  // merely cautious: rarely worth its cost
  constexpr double wider = 2.0;         // fixes: found out step by step, and each time the drive is solved
  const double observations = noise_.scale.observations() / noise_.scale.applied_observations;
  const double odometry = noise_.scale.odometry() / noise_.scale.applied_odometry;
  const auto is_worth_it = [&](double change) { return change > too_little || change < too_much; };
  const bool fixes_err_alike = noise_.fixes.in_update() > wider * noise_.fixes.applied;
  if (searching() != nullptr || !(is_worth_it(observations) || is_worth_it(odometry) || fixes_err_alike)) return;
  noise_.scale.applied_observations = noise_.scale.observations();
  noise_.scale.applied_odometry = noise_.scale.odometry();
  noise_.fixes.applied = std::max(noise_.fixes.applied, noise_.fixes.in_update());
  core::NoiseDecision decision{std::sqrt(noise_.scale.odometry()), std::sqrt(noise_.scale.observations()),
                               std::sqrt(noise_.fixes.applied), 0};
  if (is_drive_known()) {
    Tape again = tape_.rescaled(observations, odometry);
    if (fixes_err_alike) again = again.with_wider_fixes(noise_.fixes.applied);
    decision.solved_again = solve_again(std::move(again), report) ? 1 : 0;
  }
  report.decisions.emplace_back(decision);
}

/// The drive, had what the tape holds of it been `again`. False if it cannot be solved: everything is as it was.
bool NavigationLoop::solve_again(Tape again, core::StepReport& report) {
  auto drive = tape_.holds_drive() ? begun_drive() : std::make_shared<DriveMap>(*belief_.drive);
  if (belief_.drive) drive->remember(*belief_.drive);
  Smoothing smoothing;
  std::optional<cekf::CompressedEkf> solved;
  try {
    smoothing = smooth_drive(belief_.filter, again, *drive);
    if (!smoothing.accepted) return false;
    solved = filter_at_solution(*drive, belief_.filter);
  } catch (const core::NumericalError&) {
    ++report.numerics.refused;
    return false;
  }
  if (belief_.drive) become(std::move(drive), belief_.window);
  again.append(Tape::Solved{smoothing.chi2});
  Checkpoint trusted = take_checkpoint(belief_, again);
  trusted.filter = solved->snapshot();
  std::swap(belief_.filter, *solved);
  if (!undo_.filter) undo_.filter = std::move(solved);
  std::swap(tape_, again);
  if (!undo_.tape) undo_.tape = std::move(again);
  report.solved = std::move(smoothing.path);
  trust(std::move(trusted));
  return true;
}

}  // namespace helixnav::supervisor
