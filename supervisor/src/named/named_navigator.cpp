// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/named_navigator.hpp"

#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "association/association_report.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/thin_scan.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/fit_to_sensor.hpp"
#include "loop/judge_fix.hpp"
#include "named/contradicting_names.hpp"
#include "named/named_drive.hpp"

namespace helixnav::supervisor {

using core::AssociationReport;
using core::LandmarkId;
using core::Outcome;
using core::StepReport;

namespace {

core::Decision left_out_decision(std::size_t observations) {
  return core::OtherDecision{"scan", "left-out", {{"observations", static_cast<double>(observations)}}};
}

DelayedOptions delayed_of(const NavigatorOptions& options) {
  DelayedOptions delayed = options.delayed;
  delayed.names_may_be_wrong = options.names.wrong > 0.0;
  return delayed;
}

AssociationReport begun_by(int observation) {
  AssociationReport begun;
  begun.observation = observation;
  begun.outcome = Outcome::augmented;
  return begun;
}

/// One step with a scan's identities. If the mathematics fails on what they claim, one without any: no scan ends a
/// drive.
template <class StepWith>
StepReport with_identities_or_none(const std::vector<std::int64_t>& identities, const StepWith& step_with) {
  try {
    return step_with(identities, std::vector<core::Decision>());
  } catch (const core::NumericalError&) {
    constexpr std::int64_t no_identity = -1;
    return step_with(std::vector<std::int64_t>(identities.size(), no_identity),
                     std::vector<core::Decision>{left_out_decision(identities.size())});
  }
}

}  // namespace

NamedNavigator::NamedNavigator(const core::PoseGaussian& start, const NavigatorOptions& options)
    : options_(options),
      reach_m_(reference_reach_m),
      filter_(start, options.filter),
      delayed_(delayed_of(options)),
      drive_(NamedDrive(start, options.search.smooth_up_to_scans)) {
  core::check_start(start);
}

/// The strong guarantee: the call takes effect as a whole, or the previous state is rebuilt from the checkpoint.
template <class Call>
auto NamedNavigator::all_or_nothing(const Call& call) {
  if (!checkpoint_) checkpoint();
  const std::size_t events = taken_.size();
  Pending before = pending_;
  const NamedDrive::Mark mark = drive_->mark();
  const std::int64_t next_try = next_try_;
  try {
    auto result = call();
    constexpr std::int64_t stride = 10;
    const bool due = before_ || step_ - checkpoint_->step >= stride || filter_.phase() != checkpoint_->filter.phase;
    if (due) checkpoint_.reset();  // taken by the next call, before it changes anything
    before_.reset();
    return result;
  } catch (...) {
    take_back_hand_over();
    drive_->back_to(mark);
    next_try_ = next_try;
    recover(events, std::move(before));
    throw;
  }
}

std::optional<StepReport> NamedNavigator::take(const core::Event& event, const std::vector<std::int64_t>& identities) {
  if (const auto* scan = std::get_if<core::Scan>(&event)) return observe(*scan, identities);
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) move(*odometry);
  if (const auto* absolute = std::get_if<core::AbsoluteFix>(&event)) fix(*absolute);
  if (std::holds_alternative<core::Lost>(event)) {
    throw core::PreconditionError("take: a vehicle that was carried is not found again by identities");
  }
  return std::nullopt;
}

void NamedNavigator::move(const core::Odometry& odometry) {
  core::check(odometry);
  pending_.motion = pending_.motion ? core::chain(*pending_.motion, odometry) : odometry;
}

StepReport NamedNavigator::observe(const core::Scan& scan, const std::vector<std::int64_t>& identities) {
  core::check(scan);
  if (identities.size() != scan.observations.size()) {
    throw core::PreconditionError("observe: " + std::to_string(identities.size()) + " identities for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  fit_to(scan.field_of_view);
  if (scan.observations.size() > core::most_observations_used) return observe_thinned(scan, identities);
  return with_identities_or_none(identities, [&](const auto& used, const std::vector<core::Decision>& decisions) {
    return all_or_nothing([&] {
      pending_.decisions.insert(pending_.decisions.end(), decisions.begin(), decisions.end());
      return step({scan, used, {}});
    });
  });
}

/// As the Navigator's.
StepReport NamedNavigator::observe_thinned(const core::Scan& scan, const std::vector<std::int64_t>& identities) {
  const std::vector<std::size_t> used = core::observations_to_use(scan);
  std::vector<AssociationReport> all = core::reports_of_none(identities.size());
  const core::Scan thin = core::thinned(scan, used);
  std::vector<std::int64_t> of_thin;
  for (const std::size_t i : used) of_thin.push_back(identities[i]);
  StepReport report =
      with_identities_or_none(of_thin, [&](const auto& taken, const std::vector<core::Decision>& decisions) {
        return all_or_nothing([&] {
          pending_.decisions.push_back(core::thinning_decision(identities.size(), used.size()));
          pending_.decisions.insert(pending_.decisions.end(), decisions.begin(), decisions.end());
          return step({thin, taken, {}});
        });
      });
  core::name_in_whole_scan(used, all, report.associations);
  return report;
}

/// As the Navigator's.
void NamedNavigator::fit_to(const core::FieldOfView& view) {
  if (fitted_ || !view.reach()) return;
  if (fit_to_sensor(view, step_ == 0, options_, filter_)) checkpoint_.reset();
  delayed_.set_lengths(delayed_of(options_));
  reach_m_ = *view.reach();
  fitted_ = true;
}

bool NamedNavigator::fix(const core::AbsoluteFix& fix) {
  core::check(fix);
  return all_or_nothing([&] { return use_fix(fix); });
}

StepReport NamedNavigator::step(const NamedScan& named) {
  StepReport report;
  report.associations = associate(named);
  bring_into_filter(report.associations);
  predict();
  update(named.scan, report);
  augment(named, report);
  enter_names(named, report);
  report.switched_region = filter_.switch_region_if_due();
  report.step = step_++;
  report.t_ns = named.scan.t_ns;
  report.pose = filter_.pose();
  report.active_landmarks = filter_.active_count();
  report.mapped_landmarks = static_cast<int>(observations_.size());
  record(named.scan, report);
  go_on_with_drive();
  report_late(report);
  return report;
}

void NamedNavigator::report_late(StepReport& report) {
  report.decisions = std::exchange(pending_.decisions, {});
  report.numerics.note(std::exchange(pending_.numerics, {}));
  report.numerics.note(filter_.take_health());
}

bool NamedNavigator::use_fix(const core::AbsoluteFix& fix) {
  predict();
  taken_.emplace_back(fix);
  pending_.decisions.emplace_back(judge_fix(filter_, WidenedFix{fix}, options_.fix_probability));
  const bool accepted = std::get<core::FixDecision>(pending_.decisions.back()).accepted;
  if (accepted) record(fix);
  return accepted;
}

void NamedNavigator::predict() {
  if (!pending_.motion) return;
  filter_.predict(*pending_.motion);
  taken_.emplace_back(*pending_.motion);
  if (!recovering_) drive_->move(*pending_.motion);
  pending_.motion.reset();
}

std::vector<AssociationReport> NamedNavigator::associate(const NamedScan& named) const {
  std::vector<AssociationReport> reports(named.identities.size());
  std::set<std::int64_t> born;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const std::int64_t identity = named.identities[i];
    reports[i].observation = static_cast<int>(i);
    const auto known = landmark_of_identity_.find(identity);
    if (identity < 0) {
      reports[i].outcome = Outcome::rejected;
    } else if (known == landmark_of_identity_.end() || waits_anew(named.scan.observations[i], known->second)) {
      reports[i].outcome = born.insert(identity).second ? Outcome::augmented : Outcome::rejected;
    } else {
      reports[i].outcome = Outcome::matched;
      reports[i].landmark = known->second;
    }
  }
  return reports;
}

/// A range or a bearing alone of a misplaced landmark waits until several place it anew; sightings that place it
/// themselves begin it at once, in leave_wrong_names_out.
bool NamedNavigator::waits_anew(const core::Observation& observation, LandmarkId known) const {
  return core::dimension(observation.kind) == 1 && integrity_.is_misplaced(known);
}

std::vector<cekf::Match> NamedNavigator::matches_in_filter(const core::Scan& scan,
                                                           const std::vector<AssociationReport>& associations) const {
  std::vector<cekf::Match> matched = matches(scan, associations);
  for (cekf::Match& match : matched) match.landmark = names_.in_filter(match.landmark);
  return matched;
}

void NamedNavigator::update(const core::Scan& scan, StepReport& report) {
  std::vector<cekf::Match> matched = matches_in_filter(scan, report.associations);
  if (matched.empty()) return;
  const double most_nis = options_.names.wrong > 0.0 ? integrity_.noise_scale() * usual_nis(matched)
                                                     : std::numeric_limits<double>::infinity();
  std::optional<cekf::UpdateResult> result = filter_.update_within(matched, most_nis);
  if (result) {
    integrity_.note_nis(result->nis, result->dof);
    integrity_.agree(landmarks_with(Outcome::matched, report.associations));
  } else {
    leave_wrong_names_out(scan, matched, report.associations);
    matched = matches_in_filter(scan, report.associations);
    result = filter_.update(matched);
  }
  report.joint_nis = result->nis;
  report.joint_dof = result->dof;
}

void NamedNavigator::leave_wrong_names_out(const core::Scan& scan, const std::vector<cekf::Match>& matched,
                                           std::vector<AssociationReport>& associations) {
  const AssumedOfNames assumed{scan.field_of_view, reach_m_, options_.names.wrong, integrity_.noise_scale()};
  std::vector<AssociationReport> left_out = associations;
  std::vector<std::size_t> of_match;
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (left_out[i].outcome == Outcome::matched) of_match.push_back(i);
  }
  const std::vector<ContradictingName> wrong = contradicting_names(filter_, matched, assumed);
  std::vector<ContradictedName> contradicting;
  for (const ContradictingName& name : wrong) {
    AssociationReport& one = left_out[of_match[name.match]];
    contradicting.push_back(contradicted_name(filter_, matched[name.match], assumed.view, one.landmark));
    one.outcome = Outcome::rejected;
    one.nis = name.nis;
    one.dof = name.dof;
  }
  integrity_.note_unusual();
  const std::vector<LandmarkId> agreeing = landmarks_with(Outcome::matched, left_out);
  if (wrong.empty()) return integrity_.agree(agreeing);
  const NameIntegrity::AboutMotion about_motion{nats_for_slip(filter_, matched, wrong, assumed, options_.slip),
                                                agree_about_a_pose(filter_, matched, assumed)};
  if (!integrity_.blames_names(contradicting, agreeing, about_motion)) return;
  associations = std::move(left_out);
  for (const ContradictingName& name : wrong) {
    AssociationReport& one = associations[of_match[name.match]];
    const bool is_at_a_place = core::dimension(matched[name.match].observation.kind) == 2;
    if (is_at_a_place && integrity_.is_misplaced(one.landmark)) one = begun_by(one.observation);
  }
}

void NamedNavigator::augment(const NamedScan& named, StepReport& report) {
  std::vector<DelayedSighting> delayed;
  std::vector<std::size_t> of_delayed;
  for (AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const auto index = static_cast<std::size_t>(association.observation);
    const core::Observation& observation = named.scan.observations[index];
    if (core::dimension(observation.kind) == 2) {
      association.landmark = names_.in_map(filter_.augment(observation, named.scan.T_robot_sensor));
      continue;
    }
    association.outcome = Outcome::ambiguous;
    if (names_.is_part) continue;
    delayed.push_back({named.identities[index], observation});
    of_delayed.push_back(index);
  }
  const auto entered = delayed_.sight(filter_, delayed, named.scan.T_robot_sensor);
  for (std::size_t i = 0; i < entered.size(); ++i) {
    if (!entered[i]) continue;
    report.associations[of_delayed[i]].outcome = Outcome::augmented;
    report.associations[of_delayed[i]].landmark = *entered[i];
  }
}

void NamedNavigator::enter_names(const NamedScan& named, const StepReport& report) {
  taken_.emplace_back(named);
  std::vector<LandmarkId>& counted = std::get<NamedScan>(taken_.back()).counted;
  counted.reserve(report.associations.size());
  for (const AssociationReport& association : report.associations) {
    const std::int64_t identity = named.identities[static_cast<std::size_t>(association.observation)];
    if (association.outcome == Outcome::augmented) enter_name(identity, association.landmark);
    if (association.landmark == core::no_landmark || association.outcome == Outcome::rejected) continue;
    ++observations_[association.landmark];
    counted.push_back(association.landmark);
  }
}

void NamedNavigator::enter_name(std::int64_t identity, LandmarkId landmark) {
  const auto [name, is_new] = landmark_of_identity_.try_emplace(identity, landmark);
  if (is_new) return;
  integrity_.begin_anew(identity, name->second);
  name->second = landmark;
}

void NamedNavigator::checkpoint() {
  checkpoint_.emplace(Checkpoint{filter_.snapshot(), delayed_, integrity_, step_});
  taken_.clear();
}

/// Those learnt since the checkpoint.
void NamedNavigator::forget_names() {
  for (const Taken& taken : taken_) {
    const auto* scan = std::get_if<NamedScan>(&taken);
    if (scan == nullptr) continue;
    for (const LandmarkId id : scan->counted) {
      if (--observations_[id] == 0) observations_.erase(id);
    }
  }
  const LandmarkId first = names_.in_map(checkpoint_->filter.active.next_id);
  for (auto name = landmark_of_identity_.begin(); name != landmark_of_identity_.end();) {
    name = name->second >= first ? landmark_of_identity_.erase(name) : std::next(name);
  }
  const std::vector<NameIntegrity::BegunAnew>& begun = integrity_.begun_anew();
  for (std::size_t i = begun.size(); i > checkpoint_->integrity.begun_anew().size(); --i) {
    if (begun[i - 1].from < first) landmark_of_identity_[begun[i - 1].identity] = begun[i - 1].from;
  }
}

void NamedNavigator::recover(std::size_t events, Pending pending) {
  forget_names();
  std::vector<Taken> again = std::exchange(taken_, {});
  again.resize(events);
  filter_.restore(checkpoint_->filter);
  delayed_ = checkpoint_->delayed;
  integrity_ = checkpoint_->integrity;
  step_ = checkpoint_->step;
  pending_ = {};
  recovering_ = true;
  for (const Taken& taken : again) {
    if (const auto* motion = std::get_if<core::Odometry>(&taken)) pending_.motion = *motion;
    if (const auto* scan = std::get_if<NamedScan>(&taken)) step({scan->scan, scan->identities, {}});
    if (const auto* fix = std::get_if<core::AbsoluteFix>(&taken)) use_fix(*fix);
  }
  recovering_ = false;
  filter_.take_health();  // of the failed call, and of what was reported before
  pending_ = std::move(pending);
}

}  // namespace helixnav::supervisor
