// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/referee.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "referee_book.hpp"

namespace helixnav::evaluation {
namespace {

using core::Label;
using core::LandmarkId;
using core::MapLandmark;
using core::StepReport;

double sight_m(const core::Recording& recording) {
  double range_m = 0.0;
  for (const core::Event& event : recording.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      range_m = std::max(range_m, scan->field_of_view.max_range_m);
    }
  }
  return std::isfinite(range_m) ? 1.5 * range_m : 0.0;
}

template <class Kind>
int count(const StepReport& report) {
  return static_cast<int>(
      std::count_if(report.decisions.begin(), report.decisions.end(),
                    [](const core::Decision& decision) { return std::holds_alternative<Kind>(decision); }));
}

int count_closings(const StepReport& report, bool accepted) {
  return static_cast<int>(
      std::count_if(report.decisions.begin(), report.decisions.end(), [&](const core::Decision& decision) {
        const auto* closure = std::get_if<core::ClosureDecision>(&decision);
        return closure != nullptr && closure->accepted == accepted;
      }));
}

/// The vehicle was carried and has found its place again.
bool has_found_place(const StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
  });
}

}  // namespace

Referee::Referee(const core::Recording& recording, std::vector<double> returns_at_m, const RefereeOptions& options)
    : book_(std::make_unique<Book>(recording, std::move(returns_at_m), options, sight_m(recording))) {
  if (recording.true_poses.size() != recording.labels.size()) {
    throw core::PreconditionError("Referee: expected labels and a true pose for every scan");
  }
}

Referee::~Referee() = default;
Referee::Referee(Referee&&) noexcept = default;
Referee& Referee::operator=(Referee&&) noexcept = default;

void Referee::watch(const StepReport& report, const Map& map_now) {
  Book& book = *book_;
  if (report.step != static_cast<std::int64_t>(book.steps) || book.steps >= book.recording.labels.size()) {
    throw core::PreconditionError("Referee: step " + std::to_string(report.step) + ", expected " +
                                  std::to_string(book.steps) + " of " + std::to_string(book.recording.labels.size()));
  }
  const std::vector<Label>& labels = book.recording.labels[book.steps];
  book.drive_on(report, map_now);
  book.note_carried(report);
  book.look_out(labels);
  book.pose = report.pose;
  book.note_triggers(report);
  book.note_slips(report);
  book.count_matches(report, labels);
  if (book.on_old_ground) {
    book.last_on_old_ground.open = {report.pose, book.truth(), book.recognised};
  } else {
    book.judge_if_open(book.last_on_old_ground, map_now);
  }
  if (!book.is_associated()) book.judge_if_open(book.last_associated, map_now);
  book.score.refused += count_closings(report, false);
  book.score.undecided += count<core::UndecidedDecision>(report);
  const int new_ground = count<core::NewGroundDecision>(report);
  book.score.new_ground += new_ground;
  if (book.on_old_ground) book.score.new_ground_wrong += new_ground;
  if (count_closings(report, true) > 0 || has_found_place(report)) {
    book.judge_closure(report, map_now());
    // What was wrong before the closing is no longer believed.
    book.last_on_old_ground.open = {report.pose, book.truth(), book.recognised};
  }
  if (!book.judges_at_once) return;
  book.judge_if_open(book.last_on_old_ground, map_now);
  book.judge_if_open(book.last_associated, map_now);
}

RunScore Referee::score(const std::vector<MapLandmark>& map) const {
  RunScore result = book_->score;
  if (book_->steps > 0) {
    const Judgeable end{book_->pose, book_->truth()};
    result.end = book_->judge(end, map);
    result.end_on_old_ground =
        book_->last_on_old_ground.is_known() ? book_->judge(book_->last_on_old_ground, map) : result.end;
  }
  if (!result.returns.empty()) result.returns.back().end_on_old_ground = result.end_on_old_ground;
  if (book_->last_associated.is_known()) result.returns.back().associated = book_->judge(book_->last_associated, map);
  result.wrong_without_trigger += book_->wrong_so_far;
  result.spacing_m = book_->spacing_m();
  result.trees_seen = static_cast<int>(book_->seen.size());
  book_->score_map(map, result);
  book_->pass_verdict(result);
  return result;
}

bool Referee::Book::is_carried(const core::Recording& recording) {
  if (!recording.true_carries_ns.empty()) return true;
  return std::any_of(recording.events.begin(), recording.events.end(),
                     [](const core::Event& event) { return std::holds_alternative<core::Lost>(event); });
}

void Referee::Book::note_carried(const StepReport& report) {
  if (count<core::CarriedDecision>(report) > 0) is_apart = true;
  if (has_found_place(report)) is_apart = false;
}

void Referee::Book::drive_on(const StepReport& report, const Map& map_now) {
  ++steps;
  if (steps > 1) {
    driven_m += (truth().position_m() - recording.true_poses[steps - 2].T_world_robot.position_m()).norm();
  }
  const std::size_t next = score.returns.size();
  if (next < returns_at_m.size() && driven_m >= returns_at_m[next] - in_sight_m) {
    if (next > 0 && last_on_old_ground.is_known()) {
      score.returns.back().end_on_old_ground = judge(last_on_old_ground, map_now());
    }
    if (next > 0 && last_associated.is_known()) score.returns.back().associated = judge(last_associated, map_now());
    begin_return(report.mode == core::Mode::searching && count<core::TriggerDecision>(report) == 0);
  }
}

void Referee::Book::begin_return(bool searching) {
  score.returns.emplace_back();
  last_associated = {};
  identities.fix_unseen(driven_m - options.old_ground_left_m);
  old_trees = identities.old_trees();
  seen_until_return.push_back(seen);
  reentered_at_m = std::numeric_limits<double>::quiet_NaN();
  triggered = searching;
  score.wrong_without_trigger += std::exchange(wrong_so_far, 0);
}

void Referee::Book::note_triggers(const StepReport& report) {
  const int rolled_back = count<core::RollbackDecision>(report);
  const int started = count<core::TriggerDecision>(report);
  score.rolled_back += rolled_back;
  score.triggers += started;
  if (rolled_back > 0) revise(report);
  if (rolled_back == 0 && started == 0) return;
  triggered = true;
  score.wrong_before_trigger += std::exchange(wrong_so_far, 0);
}

void Referee::Book::note_slips(const StepReport& report) {
  const std::vector<core::Nanoseconds>& slips_ns = recording.true_slips_ns;
  const auto until = std::upper_bound(slips_ns.begin(), slips_ns.end(), report.t_ns);
  const auto happened = static_cast<int>(until - slips_ns.begin());
  if (happened > score.slips) last_slip_m = driven_m;
  score.slips = happened;
  const int decided = count<core::SlipDecision>(report);
  score.slips_decided += decided;
  if (driven_m - last_slip_m > options.slip_known_m) score.slips_unfounded += decided;
}

/// Notes which trees come into view, and whether they are old ones. `pose` is still that of the previous scan.
void Referee::Book::look_out(const std::vector<Label>& labels) {
  int old = 0;
  for (const Label label : labels) {
    if (label == core::no_label) continue;
    seen.insert(label);
    old += old_trees.count(label) > 0 ? 1 : 0;
  }
  on_old_ground = !is_apart && old >= options.reentry_observations;
  if (score.returns.empty() || old == 0) return;
  ReturnScore& now = score.returns.back();
  if (std::isnan(now.error_before_m) && steps > 1) {
    now.error_before_m = error_between(pose.mean, recording.true_poses[steps - 2].T_world_robot).position_m;
  }
  if (now.reentry_step >= 0 || old < options.reentry_observations) return;
  now.reentry_step = static_cast<std::int64_t>(steps) - 1;
  reentered_at_m = driven_m;
}

void Referee::Book::count_matches(const StepReport& report, const std::vector<Label>& labels) {
  recognised.clear();
  for (const core::AssociationReport& a : report.associations) {
    const bool matched = a.outcome == core::Outcome::matched;
    if (!matched && a.outcome != core::Outcome::augmented) continue;
    const Label label = labels.at(static_cast<std::size_t>(a.observation));
    identities.fix_if_unseen(a.landmark, driven_m - options.old_after_m);
    if (matched && identities.is_old(a.landmark)) {
      const int wrong = identities.identity(a.landmark) == label ? 0 : 1;
      ++score.old_matches;
      recognised.insert(a.landmark);
      score.wrong_old_matches += wrong;
      if (!triggered) wrong_so_far += wrong;
      if (!score.returns.empty()) ++score.returns.back().old_matches;
      if (!score.returns.empty()) score.returns.back().wrong_old_matches += wrong;
    }
    identities.add_sighting(a.landmark, label, driven_m);
  }
  if (is_associated()) last_associated.open = {pose, truth(), recognised};
}

/// Landmarks that were started by earlier scans when these were replayed; and poses believed in between no longer
/// hold.
void Referee::Book::revise(const StepReport& report) {
  for (const core::RevisedScan& scan : report.revised) {
    const std::vector<Label>& labels = recording.labels.at(static_cast<std::size_t>(scan.step));
    for (const core::AssociationReport& a : scan.associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (used) identities.add_sighting(a.landmark, labels.at(static_cast<std::size_t>(a.observation)), driven_m);
    }
  }
  last_on_old_ground.open = {report.pose, truth()};
  last_associated = {};
}

}  // namespace helixnav::evaluation
