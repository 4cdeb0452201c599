// SPDX-License-Identifier: BSD-3-Clause
// If odometry was wrong by more than its noise, no prior contains the vehicle's place: the whole map is asked.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "association/revisit_ambiguity.hpp"
#include "closing/branch_pairs.hpp"
#include "closing/close_against_odometry.hpp"
#include "closing/tied_by_view.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/relocalize/repetition.hpp"
#include "loop/navigation_loop.hpp"
#include "placing/question_landmarks.hpp"
#include "placing/session_question.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::WholeMapDecision;

WholeMapDecision::Verdict whole_map_verdict(relocalize::Verdict verdict) {
  if (verdict == relocalize::Verdict::closed) return WholeMapDecision::Verdict::refused;  // until it is closed there
  const bool ambiguous = verdict == relocalize::Verdict::ambiguous;
  return ambiguous ? WholeMapDecision::Verdict::ambiguous : WholeMapDecision::Verdict::not_here;
}

WholeMapDecision figures_of(const relocalize::Answer& answer) {
  WholeMapDecision decision;
  decision.verdict = whole_map_verdict(answer.verdict);
  decision.lead = answer.gap;
  if (answer.places.empty()) return decision;
  decision.pairs = static_cast<int>(answer.places.front().pairs.size());
  decision.evidence = answer.places.front().evidence;
  return decision;
}

std::vector<pf_relocalize::ConstellationPair> constellation_of(const relocalize::Place& place) {
  std::vector<pf_relocalize::ConstellationPair> pairs;
  for (const relocalize::Pair& pair : place.pairs) pairs.push_back({pair.branch, pair.map});
  return pairs;
}

/// The places that may be the true one, where the vehicle is surely on the map: the best one, and those that it is not ahead of by what
/// chance leaves. None if some may not have been found.
std::vector<std::vector<pf_relocalize::ConstellationPair>> places_left(const relocalize::Answer& answer,
                                                                       const relocalize::AskOptions& how,
                                                                       bool may_have_slipped) {
  if (answer.verdict == relocalize::Verdict::closed) return {constellation_of(answer.places.front())};
  if (answer.verdict == relocalize::Verdict::not_here || answer.capped || answer.crowded) return {};
  const double least =
      answer.places.front().evidence + (may_have_slipped ? 1.0 : answer.rival_scale) * std::log(how.alpha);
  if (answer.places.back().evidence > least && answer.places.size() == relocalize::most_places) return {};
  std::vector<std::vector<pf_relocalize::ConstellationPair>> found;
  for (const relocalize::Place& place : answer.places) {
    if (place.evidence > least) found.push_back(constellation_of(place));
  }
  return found;
}

/// Of what the branch's landmarks say: a row of posts fits any other row of the same spacing.
double independent_share_of(const std::vector<pf_relocalize::ConstellationPair>& pairs,
                            const cekf::CompressedEkf& filter, const relocalize::IndexOptions& lengths) {
  std::vector<Eigen::Vector2d> in_branch_m;
  for (const auto& pair : pairs) in_branch_m.push_back(filter.landmark_mean(pair.branch));
  return relocalize::independent_share(in_branch_m, relocalize::same_to_m(lengths));
}

}  // namespace

/// As much of it as the filter holds: of a large map, the part around the vehicle.
bool NavigationLoop::asks_whole_map() const {
  return options_.search.enabled && options_.search.whole_map &&
         options_.search.acceptance == Acceptance::constellation && !apart_.any();
}

LandmarksAbout NavigationLoop::branch_about() const {
  const double born_after_m = searching()->search.begun_path_m() - options_.search.old_after_m;
  return landmarks_about(belief_, options_.search.branch_seen_within_m, born_after_m);
}

/// What was mapped before everything vanished is elsewhere: only what came since.
LandmarksAbout NavigationLoop::untied_about() const {
  return landmarks_about(belief_, options_.search.branch_seen_within_m, *belief_.untied_since_m);
}

/// Before a search ends undecided: closes the map if the answer allows it.
AskedWholeMap NavigationLoop::ask_whole_map(const core::Scan& scan, core::StepReport& report) {
  LandmarksAbout about = branch_about();
  if (!asks_whole_map() || !questions_.asked.is_due(about.ids)) return {};
  const Searching& open = *searching();
  AskedWholeMap asked = ask(about, open.search, scan);
  if (asked.is_closed() && close_at(asked.pairs, open.search, open.trigger, scan, asked.decision, report)) return asked;
  if (asked.is_asked()) report.decisions.emplace_back(asked.decision);
  return asked;
}

/// Attempts to find the place within the prior may go on and on if the prior does not contain it: a search that has
/// long seen enough asks the whole map as well. That ends it only at a place that odometry as measured forbids: it
/// finds any other by itself, and whether nothing fits is asked at its end. A vehicle that nothing ties to the map has no prior
/// that could find it: it asks from the first landmarks on, and whatever the map decides for is believed.
void NavigationLoop::ask_meanwhile(const core::Scan& scan, core::StepReport& report) {
  const double path_m = belief_.existence.path_m();
  const bool is_untied = belief_.untied_since_m.has_value();
  const bool is_time = is_untied || searching()->search.goes_on(path_m);
  if (!asks_whole_map() || !is_time || path_m < questions_.next_path_m) return;
  questions_.next_path_m = path_m + options_.search.ask_again_m;
  LandmarksAbout about = is_untied ? untied_about() : branch_about();
  const Asked before = questions_.asked;
  questions_.asked.with = questions_.asked_meanwhile;
  constexpr double somebody_waits = 0.2, nobody_waits = 0.5;  // see Asked::is_due
  const double least_new = is_untied ? somebody_waits : nobody_waits;
  const bool is_due = questions_.asked.is_due(about.ids, least_new);
  questions_.asked.with = before.with;
  if (!is_due) return;
  const Searching& open = *searching();
  AskedWholeMap asked = ask(about, open.search, scan);
  questions_.asked_meanwhile = std::exchange(questions_.asked.with, before.with);
  pending_.seeks_part = is_untied && !asked.is_closed() && std::isfinite(belief_.window.radius_m);
  if (is_untied && asked.is_closed()) {
    if (close_at(asked.pairs, open.search, open.trigger, scan, asked.decision, report)) return;
  } else if (asked.is_closed()) {
    const ClosingView view{open.search, belief_.existence,     belief_.coverage,
                           scan,        {open.trigger, tape_}, tied_if_slipping_m()};
    cekf::CompressedEkf trial = belief_.filter;
    if (close_map(trial, view, asked.pairs, options_.search).accepted) return;
    if (close_at(asked.pairs, open.search, open.trigger, scan, asked.decision, report)) return;
  }
  const bool is_news = asked.is_asked() && asked.decision.verdict != WholeMapDecision::Verdict::not_here;
  if (is_news) report.decisions.emplace_back(asked.decision);
}

/// For a place that a search has found with certain pairs: what the landmarks say without the prior it was found with.
AskedWholeMap NavigationLoop::ask_about_place(const core::Scan& scan) {
  LandmarksAbout about = branch_about();
  if (!asks_whole_map() || about.ids.size() < Asked::least_to_ask) return {};
  return ask(about, searching()->search, scan);
}

/// On new ground, where no search has begun: is it new?
void NavigationLoop::ask_whether_new(const core::Scan& scan, core::StepReport& report) {
  const double path_m = belief_.existence.path_m();
  if (!asks_whole_map() || std::get_if<Mapping>(&mode_) == nullptr || path_m < questions_.next_path_m) return;
  if (belief_.seen_again.is_suspicious()) return;  // it may be elsewhere since
  questions_.next_path_m = path_m + options_.search.ask_again_m;
  // A landmark not seen for longer is old, and would be compared with itself.
  const double within_m = std::min(options_.search.branch_seen_within_m, options_.search.old_after_m);
  LandmarksAbout about = landmarks_about(belief_, within_m, path_m - within_m);
  constexpr double least_new = 0.5;
  if (!questions_.asked.is_due(about.ids, least_new)) return;
  const Search search = search_from(belief_.existence, old_landmarks(belief_.existence, options_.search.old_after_m));
  AskedWholeMap asked = ask(about, search, scan);
  const auto is_closed_from = [&](const Checkpoint& now) {
    return close_at(asked.pairs, search, now, scan, asked.decision, report);
  };
  if (!asked.is_closed() || !is_closed_from(take_checkpoint(belief_, tape_))) {
    const bool is_news = asked.decision.verdict != WholeMapDecision::Verdict::not_here;
    if (is_news) report.decisions.emplace_back(asked.decision);
    return;
  }
  trust(take_checkpoint(belief_, tape_));
  report.active_landmarks = belief_.filter.active_count();
  report.mapped_landmarks = static_cast<int>(belief_.existence.records().size());
}

/// A copy, since a call that fails goes on with the previous one.
const relocalize::MapIndex& NavigationLoop::follow_old_ground(const Search& search) {
  const auto& before = questions_.old_ground;
  auto old_ground = std::make_shared<OldGroundIndex>(before ? *before : OldGroundIndex(index_lengths()));
  old_ground->follow(belief_.filter, belief_.existence.appearance(), search.old_landmarks());
  questions_.old_ground = std::move(old_ground);
  return questions_.old_ground->index();
}

/// Counts as a question, unless there is nothing to ask.
AskedWholeMap NavigationLoop::ask(LandmarksAbout& about, const Search& search, const core::Scan& scan) {
  const relocalize::MapIndex& index = follow_old_ground(search);
  // If the drive was rolled back past a question, some that were old then belong to the branch now.
  const auto is_old = [&](LandmarkId id) { return index.contains(id); };
  about.ids.erase(std::remove_if(about.ids.begin(), about.ids.end(), is_old), about.ids.end());
  const relocalize::Question question =
      session_question(belief_, about, scan.field_of_view, index.options(), options_.search.branch_seen_within_m);
  if (question.landmarks.empty() || question.looked.empty() || !(index.looked_at_m2() > 0.0)) return {};
  const relocalize::AskOptions how = session_options(questions_.asked.next_alpha());
  const relocalize::Answer answer = relocalize::ask(index, question, how);
  AskedWholeMap asked{figures_of(answer), {}};
  asked.decision.old_landmarks = static_cast<int>(index.size());
  asked.decision.landmarks = static_cast<int>(question.landmarks.size());
  asked.decision.questions = questions_.asked.questions + 1;
  asked.decision.needed = relocalize::evidence_needed(how);
  if (answer.verdict == relocalize::Verdict::closed) asked.pairs = constellation_of(answer.places.front());
  asked.may_be = places_left(answer, how, belief_.slips.count > 0);
  questions_.asked.note(about.ids);
  return asked;
}

/// The atlas of a drive whose odometry is trusted less than it was. False if it cannot be solved.
bool NavigationLoop::begin_drive_anew(const Tape& tape, const cekf::CompressedEkf& filter) {
  try {
    auto drive = begun_drive();
    if (belief_.drive) drive->remember(*belief_.drive);
    drive->take(tape, filter);
    drive->settle();
    become(std::move(drive), belief_.window);
    return true;
  } catch (const core::NumericalError&) {
    ++pending_.numerics.refused;
    return false;
  }
}

/// With the odometry as it was measured if it allows that, else against it.
bool NavigationLoop::close_at(const std::vector<pf_relocalize::ConstellationPair>& pairs, const Search& search,
                              const Checkpoint& trigger, const core::Scan& scan, WholeMapDecision& decision,
                              core::StepReport& report) {
  ClosingView view{search, belief_.existence, belief_.coverage, scan, {trigger, tape_}, tied_if_slipping_m()};
  const core::Pose2 before = belief_.filter.pose().mean;
  ForbiddenPlace place{pairs, fitted_to_pairs(belief_.filter, kept_removed(pairs)), {}, belief_.untied_since_m};
  decision.displaced_m = (core::compose(place.T_map_branch, before).position_m() - before.position_m()).norm();
  Closing closing = close_map(belief_.filter, view, pairs, options_.search);
  decision.cost = closing.cost;
  decision.dof = closing.dof;
  decision.limit = closing.limit;
  if (!closing.accepted) {
    report.numerics.note(closing.numerics);
    if (was_no_noise(closing) && pause_before(pairs)) {
      pending_.forbidden = pairs;  // a pause tells when it was carried, matches only since when nothing fitted
      return false;
    }
    decision.needed = (decision.needed + nats_against_odometry(closing)) /
                      independent_share_of(pairs, belief_.filter, index_lengths());
    if (std::min(decision.evidence, decision.lead) < decision.needed) return false;
    // Where the drive is not kept the jump could be put no earlier than where the search began, and what was mapped between it and
    // there would stay where it never was.
    const std::optional<SightingGap> gap = tape_.holds_drive() ? std::nullopt : gap_before(pairs);
    if (gap && gap->first_m < trigger.existence.path_m()) {
      pending_.forbidden = pairs;
      return false;
    }
    place.as_measured = closing;
    view.tied_since_m = tied_since_m(tape_, belief_.existence.path_m(), options_.search.old_after_m);
    Reconciled reconciled = close_against_odometry(belief_.filter, start_, view, place, options_.search);
    if (!reconciled.closing.accepted) {
      pending_.forbidden = pairs;
      return false;
    }
    const bool changes_drive = belief_.drive && tape_.holds_drive();  // else only what came after the trigger
    if (changes_drive && !begin_drive_anew(*reconciled.tape, *reconciled.filter)) return false;
    decision.odometry_factor = reconciled.odometry_factor;
    decision.loop_m = reconciled.loop_m;
    pending_.odd_closing = {place.as_measured.cost - place.as_measured.dof, reconciled.odometry_factor,
                            reconciled.loop_m};
    // Odometry had the vehicle elsewhere all along: landmarks begun there may be copies, old or not when the search
    // began.
    belief_.left_open.push_back({belief_.existence.path_m() - reconciled.loop_m, belief_.existence.path_m()});
    closing = std::move(reconciled.closing);
    report.numerics.note(belief_.filter.take_health());
    std::swap(belief_.filter, *reconciled.filter);
    if (!undo_.filter) undo_.filter.emplace(std::move(*reconciled.filter));
    std::swap(tape_, *reconciled.tape);
    if (!undo_.tape) undo_.tape.emplace(std::move(*reconciled.tape));
  }
  decision.verdict = WholeMapDecision::Verdict::accepted;
  report.decisions.emplace_back(decision);
  report_closing(closing, pairs.size(), belief_.existence.path_m() - search.begun_path_m(), before, report);
  accept(closing, view, report);
  return true;
}

}  // namespace helixnav::supervisor
