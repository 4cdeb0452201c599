// SPDX-License-Identifier: BSD-3-Clause
#include "loop/navigation_loop.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "association/appearance_evidence.hpp"
#include "association/association_report.hpp"
#include "association/candidates.hpp"
#include "association/doubtful_matches.hpp"
#include "association/expected_landmarks.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/thin_scan.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/fit_to_sensor.hpp"
#include "loop/judge_fix.hpp"
#include "loop/recover.hpp"
#include "search/trigger.hpp"
#include "slip/update_after_slip.hpp"

namespace helixnav::supervisor {

using core::LandmarkId;
using core::Outcome;
using core::Scan;
using core::StepReport;

NavigationLoop::NavigationLoop(const core::PoseGaussian& start, const NavigatorOptions& options)
    : options_(options),
      start_(start),
      belief_{cekf::CompressedEkf(start, options.filter),
              association::LandmarkLife(options.life),
              CoverageTrace(options.search.coverage_spacing_m),
              {},
              0,
              {}},
      tape_(options.search.enabled ? options.search.smooth_up_to_scans : 0),
      mode_(Mapping{{}, take_checkpoint(belief_, tape_), {}}) {}

void NavigationLoop::move(const core::Odometry& measured) {
  const SystematicErrors& errors = noise_.systematic.learner.taken_out();
  const TimeMoved time = odometry_rhythm_.until(measured.t_ns);
  core::Odometry odometry = without(errors, measured, time);
  odometry.covariance *= noise_.scale.odometry();
  pending_.motion = pending_.motion ? core::chain(*pending_.motion, odometry) : odometry;
  pending_.driven_m += odometry.T_before_after.position_m().norm();
  pending_.time += time;
}

/// To the first sensor that reports how far it sees.
void NavigationLoop::fit_to(const core::FieldOfView& view) {
  if (view_.reach() || !view.reach()) return;
  if (fit_to_sensor(view, belief_.step == 0, options_, belief_.filter)) {
    std::get<Mapping>(mode_).trust(take_checkpoint(belief_, tape_));
  }
  belief_.existence.set_lengths(options_.life.look_distance_m, options_.life.tentative_patience_m);
  belief_.coverage.set_spacing(options_.search.coverage_spacing_m);
  view_ = view;
}

StepReport NavigationLoop::observe(const Scan& measured) {
  fit_to(measured.field_of_view);
  const SystematicErrors& errors = noise_.systematic.learner.taken_out();
  return errors.are_zero() ? observe_anywhere(measured) : observe_anywhere(without(errors, measured));
}

StepReport NavigationLoop::observe_anywhere(const Scan& scan) {
  const IntegrityLimits& limits = options_.search.integrity;
  const std::optional<UnsurePause> pause = pause_to_weigh(scan);
  const StillThere there = pause ? weigh_pause(scan, pause->path_m) : StillThere{};
  const double driven_m = pending_.driven_m;
  const double turn_rad2 = pending_.motion ? pending_.motion->covariance(2, 2) : 0.0;
  const bool is_open = is_monitored() && rhythm_.leaves_heading_open(turn_rad2);
  const bool is_carried = there.is_elsewhere(limits);
  const bool has_paused = pause && rhythm_.is_pause(scan.t_ns, driven_m);
  pauses_.reserve(pauses_.size() + 1);  // nothing throws once the scan has been taken
  const bool is_elsewhere = is_carried || is_open;
  StepReport report = is_carried ? observe_elsewhere(scan, there, *pause)
                      : is_open  ? begin_part_with(scan, without_odometry())
                                 : observe_somewhere(scan);
  rhythm_.note(scan.t_ns, driven_m, turn_rad2);
  forget_pauses(report);
  if (is_elsewhere) pauses_.clear();
  if (has_paused && !is_elsewhere && !there.is_surely_here()) pauses_.push_back(*pause);
  pause_ = is_elsewhere || there.is_here(limits) ? std::nullopt : pause;
  return report;
}

StepReport NavigationLoop::observe_here(const Scan& scan) {
  const bool is_thinned = scan.observations.size() > core::most_observations_used;
  StepReport report = is_thinned ? observe_thinned(scan) : take_step(scan, nullptr);
  name_revised(report);
  used_.erase(used_.begin(), used_.lower_bound(checkpoint().step));  // nothing revises them any more
  return report;
}

/// `note` goes into the report.
StepReport NavigationLoop::take_step(const Scan& scan, const core::Decision* note) {
  return all_or_nothing([&] {
    if (note != nullptr) pending_.decisions.push_back(*note);
    pending_.forbidden.clear();
    pending_.seeks_part = false;
    pending_.odd_closing = {};
    predict();
    learn_noise(scan);
    StepReport report = take_as_assumed(scan);
    checkpoint_if_settled();
    hand_over_if_due();
    report_late(report);
    if (has_slipped_away()) return search_since_slip(std::move(report));
    if (has_lost_its_place()) return roll_back_and_relocalise(scan, std::move(report));
    ask_whether_new(scan, report);
    solve_with_learnt_noise(report);
    if (!report.merged.empty() || !report.solved.empty()) noise_.fixes.forget_offset();
    learn_systematic(report);
    report.pose = pose();
    if (apart_.any()) find_place(scan.field_of_view, report);
    if (!pending_.forbidden.empty()) {
      look_elsewhere(scan, report);
    } else if (pending_.seeks_part) {
      part_since_untied(scan, report);
    }
    report_late(report);
    return report;
  });
}

/// With the noise assumed by now.
StepReport NavigationLoop::take_as_assumed(const Scan& scan) {
  if (noise_.scale.observations() == 1.0) return step(scan);
  Scan assumed = scan;
  for (core::Observation& observation : assumed.observations) observation.R *= noise_.scale.observations();
  return step(assumed);
}

bool NavigationLoop::fix(const core::AbsoluteFix& fix) {
  if (apart_.part != 0) return false;  // the place of its frame is unknown
  return all_or_nothing([&] {
    predict();
    const FixInnovation before = innovation_of(belief_.filter.pose(), fix);
    learn_noise(fix, before);
    const bool accepted = use_fix(widened(fix, noise_.fixes));
    noise_.fixes.note_correction(before, innovation_of(belief_.filter.pose(), fix));
    return accepted;
  });
}

StepReport NavigationLoop::step(const Scan& scan) {
  StepReport report;
  predict();
  GatedScan gated = gate(scan);
  if (const auto trigger = find_trigger(gated, belief_.filter.pose(), options_.search)) {
    if (searching() != nullptr || belief_.seen_again.is_suspicious()) {
      leave_returns_unused(gated);
    } else if (leaves_one_place(gated.place, options_.search)) {
      leave_ambiguous_unused(options_.search, gated);
    } else {
      report.decisions.emplace_back(*trigger);
      begin_search(scan);
      gated = gate(scan);
    }
  }
  report_unfinished(gated, report);
  const Confirmation before = belief_.confirmation;
  report.associations = associate_gated(gated, scan);
  const bool slipped = allow_for_slip(scan, before, report);
  const std::vector<SeenPoint> seen = points_to_watch(scan);
  const std::vector<Mover> movers = watch_moving(scan, seen, report);
  belief_.slips.see(landmarks_with(Outcome::matched, report.associations).size());
  update(scan, slipped, report);
  augment(scan, report);
  if (!seen.empty()) belief_.moving.begin(scan.t_ns, seen, options_.moving, report.associations);
  note_seen_again(scan, slipped, report);
  std::vector<LandmarkId> died = update_existence(scan, report);
  drop_movers(movers, report, died);
  tape_.append(Tape::Scan{scan, report.associations, report.joint_nis, report.joint_dof, std::move(died), slipped});
  if (searching() != nullptr) search(scan, report);
  report.switched_region = belief_.filter.switch_region_if_due();
  return finish(scan, std::move(report));
}

void NavigationLoop::predict() {
  if (!pending_.motion) return;
  belief_.filter.predict(*pending_.motion);
  belief_.moving.move(*pending_.motion);
  noise_.moved += pending_.motion->covariance;
  if (Searching* open = searching()) open->search.move(*pending_.motion);
  belief_.existence.drive(pending_.driven_m);
  tape_.append(Tape::Motion{*pending_.motion, pending_.driven_m, pending_.time});
  const Eigen::Matrix3d unseen_slips = belief_.slips.drive(pending_.driven_m, options_.search.old_after_m);
  if (!unseen_slips.isZero(0.0)) move_unmeasured(unseen_slips, pending_.motion->t_ns);
  pending_.driven_m = 0.0;
  pending_.time = {};
  pending_.motion.reset();
}

bool NavigationLoop::use_fix(const WidenedFix& fix) {
  predict();
  const core::FixDecision decision = judge_fix(belief_.filter, fix, options_.fix_probability);
  tape_.append(Tape::Fix{fix, decision.nis, decision.accepted});
  if (decision.accepted) belief_.untied_since_m.reset();
  pending_.decisions.emplace_back(decision);
  return decision.accepted;
}

const std::vector<LandmarkId>& NavigationLoop::excluded() const {
  static const std::vector<LandmarkId> none;
  const Searching* open = searching();
  return open != nullptr ? open->search.old_landmarks() : none;
}

/// While a search is open the landmarks that were old when it began are not candidates. Others become old while it lasts.
GatedScan NavigationLoop::gate(const Scan& scan) const {
  const std::vector<LandmarkId> ids = candidates(belief_.filter, scan, options_.candidate_sigmas, excluded());
  GatedScan gated = gate_scan(belief_.filter, ids, scan, options_, belief_.existence.appearance());
  if (options_.search.enabled) look_for_returns(belief_.filter, belief_.existence, scan, options_, view_, gated);
  return gated;
}

std::vector<core::AssociationReport> NavigationLoop::associate_gated(const GatedScan& gated, const Scan& scan) {
  auto reports = associate_scan(gated, scan, options_, belief_.existence.path_m(), belief_.confirmation);
  leave_unplaced_unused(scan, reports);
  pending_.doubtful = leave_doubtful_unused(gated, belief_.existence, scan, options_, reports);
  return reports;
}

void NavigationLoop::report_unfinished(const GatedScan& gated, StepReport& report) const {
  if (!gated.assignment.budget_hit) return;
  report.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::association,
                                                        static_cast<double>(gated.assignment.observations.size()),
                                                        static_cast<double>(options_.association.node_budget)});
}

void NavigationLoop::update(const Scan& scan, bool slipped, StepReport& report) {
  const std::vector<cekf::Match> matched = matches(scan, report.associations);
  if (matched.empty()) return;
  const cekf::UpdateResult result =
      slipped ? update_after_slip(belief_.filter, matched, report.numerics) : belief_.filter.update(matched);
  report.joint_nis = result.nis;
  report.joint_dof = result.dof;
}

void NavigationLoop::augment(const Scan& scan, StepReport& report) {
  for (core::AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const core::Observation& observation = scan.observations[static_cast<std::size_t>(association.observation)];
    if (core::dimension(observation.kind) == 1) {
      association.outcome = Outcome::ambiguous;  // its sightings cannot be collected without a name
      continue;
    }
    association.landmark = belief_.filter.augment(observation, scan.T_robot_sensor);
  }
}

/// Removes the landmarks whose existence is refuted by what was seen and what should have been seen, and returns them.
std::vector<LandmarkId> NavigationLoop::update_existence(const Scan& scan, const StepReport& report) {
  std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, report.associations);
  const std::vector<LandmarkId> born = landmarks_with(Outcome::augmented, report.associations);
  std::vector<double> seen_nats = appearance_nats(belief_.existence.appearance(), scan, report.associations);
  const std::vector<association::UnusedSighting> unused = std::exchange(pending_.doubtful, {});
  std::vector<LandmarkId> expected;
  if (!has_unplaced(scan)) {
    expected = expected_unseen(belief_.filter, scan, options_.view_margin_m, report.associations);
  }
  const bool is_blinded = belief_.existence.note_if_blinded(scan.observations.size(), expected.size());
  if (is_blinded) expected.clear();
  if (Mapping* mapping = std::get_if<Mapping>(&mode_)) {
    mapping->monitor.observe(belief_.existence, expected, seen, options_.search.old_after_m);
  }
  std::vector<LandmarkId> at_rim;
  constexpr std::int64_t rim_stride = 4;  // a whole drive past is one miss: not every scan need look
  if (belief_.step % rim_stride == 0 && !has_unplaced(scan) && !is_blinded)
    at_rim = unseen_at_rim(belief_.filter, scan, report.associations, expected);
  const Searching* open = searching();
  const OldGround ground{options_.search.old_after_m, options_.life.tentative_patience_m, options_.view_margin_m};
  for (std::vector<LandmarkId>* ids : {&expected, &at_rim}) {
    drop_what_may_be_elsewhere(belief_.filter, belief_.existence, open != nullptr ? &open->search : nullptr, ground,
                               seen, *ids);
  }
  belief_.existence.pass(at_rim);
  const core::Pose2 T_world_sensor = core::compose(belief_.filter.pose().mean, scan.T_robot_sensor);
  const association::LifeChanges changes =
      belief_.existence.observe(T_world_sensor.position_m(), seen, born, expected, seen_nats, unused);
  look_at(scan, report.associations, belief_.existence);
  for (const LandmarkId id : changes.died) {
    if (belief_.filter.contains(id)) belief_.filter.remove(id);
  }
  belief_.coverage.pass(belief_.existence.path_m(), T_world_sensor);
  return changes.died;
}

/// Drops those of their landmarks that still exist: a search may have been closed since they were seen.
void NavigationLoop::drop_movers(const std::vector<Mover>& movers, StepReport& report, std::vector<LandmarkId>& died) {
  for (const Mover& mover : movers) {
    core::MovingDecision decision{0, mover.nats, mover.speed_mps};
    for (const LandmarkId id : mover.landmarks) {
      if (!belief_.existence.contains(id)) continue;
      belief_.existence.remove(id);
      if (belief_.filter.contains(id)) belief_.filter.remove(id);
      died.push_back(id);
      ++decision.landmarks;
    }
    if (decision.landmarks > 0) report.decisions.emplace_back(decision);
  }
}

StepReport NavigationLoop::finish(const Scan& scan, StepReport report) {
  report.step = belief_.step++;
  report.t_ns = scan.t_ns;
  forget_if_tied_again();
  report.pose = pose();
  report.active_landmarks = belief_.filter.active_count();
  report.mapped_landmarks = static_cast<int>(belief_.existence.records().size());
  std::vector<core::Decision> decisions = std::exchange(pending_.decisions, {});
  for (core::Decision& decision : report.decisions) decisions.push_back(std::move(decision));
  report.decisions = std::move(decisions);
  report_late(report);
  Mapping* mapping = std::get_if<Mapping>(&mode_);
  if (mapping != nullptr && !mapping->trusted) trust(take_checkpoint(belief_, tape_));
  return report;
}

/// What was done for this scan since its report was made.
void NavigationLoop::report_late(StepReport& report) {
  for (core::Decision& decision : pending_.decisions) report.decisions.push_back(std::move(decision));
  pending_.decisions.clear();
  report.numerics.note(std::exchange(pending_.numerics, {}));
  report.numerics.note(belief_.filter.take_health());
}

/// From here on, while mapping; the call can still be undone.
void NavigationLoop::trust(Checkpoint checkpoint) {
  Mapping& mapping = std::get<Mapping>(mode_);
  if (mapping.trusted && !undo_.mode && !undo_.trusted) {
    undo_.trusted = Trusted{*std::move(mapping.trusted), std::move(mapping.monitor_when_trusted)};
  }
  mapping.trust(std::move(checkpoint));
}

bool NavigationLoop::is_monitored() const { return options_.search.enabled && options_.search.integrity.enabled; }

/// The belief after this scan becomes the trusted checkpoint when the monitor is clear: at most every ten scans, but after
/// every region switch, so that the phase closed by it can be freed.
void NavigationLoop::checkpoint_if_settled() {
  Mapping* mapping = std::get_if<Mapping>(&mode_);
  if (mapping == nullptr) return;
  constexpr std::int64_t stride = 10;
  const std::int64_t scans = belief_.step - mapping->trusted->step;
  if (is_monitored() && scans > options_.search.integrity.reach) mapping->monitor = IntegrityMonitor();
  if (is_monitored() && !mapping->monitor.is_clear()) return;
  if (belief_.seen_again.is_suspicious()) return;
  const bool first_scan = mapping->trusted->step == 0;
  if (!first_scan && scans < stride && belief_.filter.phase() == mapping->trusted->filter.phase) return;
  trust(take_checkpoint(belief_, tape_));
}

}  // namespace helixnav::supervisor
