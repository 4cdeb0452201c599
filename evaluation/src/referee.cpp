// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/referee.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "helixnav/core/errors.hpp"
#include "identities.hpp"
#include "rigid_fit.hpp"

namespace helixnav::evaluation {
namespace {

using core::Label;
using core::LandmarkId;
using core::MapLandmark;
using core::StepReport;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double relative_reach_m = 80.0;  // old landmarks farther than that say nothing about here
constexpr std::size_t least_relative = 3;

PoseError error_between(const core::Pose2& estimate, const core::Pose2& truth) {
  return {(estimate.position_m() - truth.position_m()).norm(),
          std::abs(core::wrap_to_pi(estimate.heading_rad - truth.heading_rad))};
}

double nees_of(const core::PoseGaussian& estimate, const core::Pose2& truth) {
  Eigen::Vector3d e = estimate.mean.vector() - truth.vector();
  e.z() = core::wrap_to_pi(e.z());
  const Eigen::LLT<Eigen::Matrix3d> factor(estimate.covariance);
  return factor.info() == Eigen::Success ? factor.matrixL().solve(e).squaredNorm() : no_number;
}

double sight_m(const core::Recording& recording) {
  double range_m = 0.0;
  for (const core::Event& event : recording.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      range_m = std::max(range_m, scan->field_of_view.max_range_m);
    }
  }
  return std::isfinite(range_m) ? 1.5 * range_m : 0.0;
}

double median(std::vector<double> values) {
  if (values.empty()) return no_number;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int count(const StepReport& report, const char* kind, const char* verdict) {
  return static_cast<int>(std::count_if(report.decisions.begin(), report.decisions.end(), [&](const core::Decision& d) {
    return d.kind == kind && d.verdict == verdict;
  }));
}

double number(const core::Decision& decision, const char* name) {
  const auto found = std::find_if(decision.numbers.begin(), decision.numbers.end(),
                                  [&](const auto& number) { return number.first == name; });
  return found == decision.numbers.end() ? no_number : found->second;
}

}  // namespace

/// An estimated pose and the true one.
struct Judgeable {
  core::PoseGaussian estimate;
  core::Pose2 truth;
};

/// What was seen so far.
struct Referee::Book {
  const core::Recording& recording;
  std::vector<double> returns_at_m;
  RefereeOptions options;
  double in_sight_m;
  Identities identities;
  std::vector<std::set<Label>> seen_until_return;  ///< trees, by then
  std::set<Label> seen;
  std::set<Label> old_trees;  ///< at the present return
  double driven_m = 0.0;
  double reentered_at_m = no_number;  ///< of the present return
  bool triggered = false;             ///< since the present return
  int wrong_so_far = 0;               ///< wrong old matches since the present return, while nothing triggered
  bool on_old_ground = false;         ///< in the present scan
  std::size_t steps = 0;
  core::PoseGaussian pose;
  std::optional<Judgeable> last_on_old_ground;  ///< or at a closing behind it
  RunScore score;

  Book(const core::Recording& run, std::vector<double> returns_m, const RefereeOptions& how)
      : recording(run),
        returns_at_m(std::move(returns_m)),
        options(how),
        in_sight_m(sight_m(run)),
        identities(how.old_sightings) {}

  const core::Pose2& truth() const { return recording.true_poses[steps - 1].T_world_robot; }
  bool is_wrong(const PoseError& error) const {
    return error.position_m > options.wrong_position_m || error.heading_rad > options.wrong_heading_rad;
  }
  bool too_many_wrong(int wrong, int all) const {
    return wrong >= options.least_wrong_pairs && wrong > options.most_wrong_share * all;
  }

  void drive_on(const StepReport& report, const Map& map_now);
  void begin_return(bool searching);
  void note_triggers(const StepReport& report);
  void look_out(const std::vector<Label>& labels);
  void count_matches(const StepReport& report, const std::vector<Label>& labels);
  void revise(const StepReport& report);
  void judge_closure(const StepReport& report, const std::vector<MapLandmark>& map);
  JudgedPose judge(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const;
  PoseError relative_error(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const;
  double spacing_m() const;
  void score_map(const std::vector<MapLandmark>& map, RunScore& result) const;
  void pass_verdict(RunScore& result) const;
};

Referee::Referee(const core::Recording& recording, std::vector<double> returns_at_m, const RefereeOptions& options)
    : book_(std::make_unique<Book>(recording, std::move(returns_at_m), options)) {
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
  book.look_out(labels);
  book.pose = report.pose;
  if (book.on_old_ground) book.last_on_old_ground = {report.pose, book.truth()};
  book.note_triggers(report);
  book.count_matches(report, labels);
  book.score.refused += count(report, "closure", "refused");
  book.score.undecided += count(report, "closure", "undecided");
  if (count(report, "closure", "accepted") == 0) return;
  book.judge_closure(report, map_now());
  book.last_on_old_ground = {report.pose, book.truth()};  // what was wrong before the closing is no longer believed
}

RunScore Referee::score(const std::vector<MapLandmark>& map) const {
  RunScore result = book_->score;
  if (book_->steps > 0) {
    const Judgeable end{book_->pose, book_->truth()};
    result.end = book_->judge(end, map);
    result.end_on_old_ground = book_->judge(book_->last_on_old_ground.value_or(end), map);
  }
  if (!result.returns.empty()) result.returns.back().left_behind = result.end_on_old_ground;
  result.wrong_without_trigger += book_->wrong_so_far;
  result.spacing_m = book_->spacing_m();
  result.trees_seen = static_cast<int>(book_->seen.size());
  book_->score_map(map, result);
  book_->pass_verdict(result);
  return result;
}

void Referee::Book::drive_on(const StepReport& report, const Map& map_now) {
  ++steps;
  if (steps > 1) {
    driven_m += (truth().position_m() - recording.true_poses[steps - 2].T_world_robot.position_m()).norm();
  }
  const std::size_t next = score.returns.size();
  if (next < returns_at_m.size() && driven_m >= returns_at_m[next] - in_sight_m) {
    if (next > 0 && last_on_old_ground) score.returns.back().left_behind = judge(*last_on_old_ground, map_now());
    begin_return(report.mode == core::Mode::searching && count(report, "trigger", "started") == 0);
  }
}

void Referee::Book::begin_return(bool searching) {
  score.returns.emplace_back();
  identities.fix_unseen(driven_m - options.left_behind_m);
  old_trees = identities.old_trees();
  seen_until_return.push_back(seen);
  reentered_at_m = no_number;
  triggered = searching;
  score.wrong_without_trigger += std::exchange(wrong_so_far, 0);
}

void Referee::Book::note_triggers(const StepReport& report) {
  const int rewound = count(report, "trigger", "rewound");
  const int started = count(report, "trigger", "started");
  score.rewound += rewound;
  score.triggers += started;
  if (rewound > 0) revise(report);
  if (rewound == 0 && started == 0) return;
  triggered = true;
  score.wrong_before_trigger += std::exchange(wrong_so_far, 0);
}

/// Notes which trees come into view, and when they are old ones. `pose` still is that of the scan before.
void Referee::Book::look_out(const std::vector<Label>& labels) {
  int old = 0;
  for (const Label label : labels) {
    if (label == core::no_label) continue;
    seen.insert(label);
    old += old_trees.count(label) > 0 ? 1 : 0;
  }
  on_old_ground = old >= options.reentry_observations;
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
  for (const core::AssociationReport& a : report.associations) {
    const bool matched = a.outcome == core::Outcome::matched;
    if (!matched && a.outcome != core::Outcome::augmented) continue;
    const Label label = labels.at(static_cast<std::size_t>(a.observation));
    identities.fix_if_unseen(a.landmark, driven_m - options.old_after_m);
    if (matched && identities.is_old(a.landmark)) {
      const int wrong = identities.identity(a.landmark) == label ? 0 : 1;
      ++score.old_matches;
      score.wrong_old_matches += wrong;
      if (!triggered) wrong_so_far += wrong;
      if (!score.returns.empty()) ++score.returns.back().old_matches;
      if (!score.returns.empty()) score.returns.back().wrong_old_matches += wrong;
    }
    identities.add_sighting(a.landmark, label, driven_m);
  }
}

/// Landmarks that earlier scans began when they were gone through again; and poses believed in between are no more.
void Referee::Book::revise(const StepReport& report) {
  for (const core::RevisedScan& scan : report.revised) {
    const std::vector<Label>& labels = recording.labels.at(static_cast<std::size_t>(scan.step));
    for (const core::AssociationReport& a : scan.associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (used) identities.add_sighting(a.landmark, labels.at(static_cast<std::size_t>(a.observation)), driven_m);
    }
  }
  last_on_old_ground = {report.pose, truth()};
}

void Referee::Book::judge_closure(const StepReport& report, const std::vector<MapLandmark>& map) {
  ClosureScore closure;
  closure.step = report.step;
  if (!score.returns.empty() && !score.returns.back().closed) closure.after_reentry_m = driven_m - reentered_at_m;
  closure.pairs = static_cast<int>(report.merged.size());
  for (const core::MergedLandmarks& pair : report.merged) {
    const Label kept = identities.identity(pair.kept);
    if (kept == core::no_label || kept != identities.identity(pair.removed)) ++closure.wrong_pairs;
  }
  for (const core::Decision& decision : report.decisions) {
    if (decision.kind == "constellation") closure.rival_share = number(decision, "rival_share");
  }
  closure.pose = judge({pose, truth()}, map);
  closure.is_false =
      score.returns.empty() || is_wrong(closure.pose.relative) || too_many_wrong(closure.wrong_pairs, closure.pairs);
  if (!score.returns.empty()) score.returns.back().closed = true;
  score.closures.push_back(closure);
}

JudgedPose Referee::Book::judge(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const {
  return {error_between(pose_at.estimate.mean, pose_at.truth), relative_error(pose_at, map),
          nees_of(pose_at.estimate, pose_at.truth)};
}

PoseError Referee::Book::relative_error(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const {
  const core::Pose2& estimate = pose_at.estimate.mean;
  std::vector<std::pair<double, PlacedTwice>> near;
  for (const MapLandmark& landmark : map) {
    if (landmark.state != core::LandmarkState::mature || !identities.is_old(landmark.id)) continue;
    const auto tree = static_cast<std::size_t>(identities.identity(landmark.id));
    const Eigen::Vector2d& map_m = landmark.point.mean_m;
    near.push_back({(map_m - estimate.position_m()).norm(), {map_m, recording.true_landmarks.at(tree).point_m}});
  }
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() < least_relative || near[least_relative - 1].first > relative_reach_m) {
    return error_between(estimate, pose_at.truth);
  }
  near.resize(std::min(near.size(), static_cast<std::size_t>(options.relative_landmarks)));
  std::vector<PlacedTwice> points;
  for (const auto& [distance_m, point] : near) points.push_back(point);
  return error_between(core::compose(rigid_fit(points), estimate), pose_at.truth);
}

double Referee::Book::spacing_m() const {
  const std::set<Label>& trees = seen_until_return.empty() ? seen : seen_until_return.front();
  std::vector<double> nearest_m;
  for (const Label a : trees) {
    double best_m = std::numeric_limits<double>::infinity();
    for (const Label b : trees) {
      if (a == b) continue;
      best_m = std::min(best_m, (recording.true_landmarks.at(static_cast<std::size_t>(a)).point_m -
                                 recording.true_landmarks.at(static_cast<std::size_t>(b)).point_m)
                                    .norm());
    }
    if (std::isfinite(best_m)) nearest_m.push_back(best_m);
  }
  return median(std::move(nearest_m));
}

void Referee::Book::score_map(const std::vector<MapLandmark>& map, RunScore& result) const {
  std::set<Label> placed;
  std::vector<PlacedTwice> points;
  for (const MapLandmark& landmark : map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    ++result.mature_landmarks;
    const Label tree = identities.identity(landmark.id);
    if (tree == core::no_label) continue;
    if (!placed.insert(tree).second) ++result.duplicates;
    points.push_back({landmark.point.mean_m, recording.true_landmarks.at(static_cast<std::size_t>(tree)).point_m});
  }
  result.map_rms_m = rms_after_fit(points);
}

void Referee::Book::pass_verdict(RunScore& result) const {
  bool wrong = std::any_of(result.closures.begin(), result.closures.end(),
                           [](const ClosureScore& closure) { return closure.is_false; });
  if (returns_at_m.empty()) {
    result.closed_by_association = result.closures.empty() && result.wrong_old_matches >= options.association_matches;
    wrong = wrong || result.closed_by_association;
  }
  for (ReturnScore& one : result.returns) {
    if (one.closed || one.old_matches < options.association_matches) continue;
    one.closed = result.closed_by_association = true;
    wrong = wrong || is_wrong(one.left_behind.relative) || too_many_wrong(one.wrong_old_matches, one.old_matches);
  }
  const bool all_closed =
      !returns_at_m.empty() && result.returns.size() == returns_at_m.size() &&
      std::all_of(result.returns.begin(), result.returns.end(), [](const ReturnScore& one) { return one.closed; });
  result.verdict = wrong ? RunVerdict::false_closure : all_closed ? RunVerdict::closed : RunVerdict::undecided;
  result.late =
      result.verdict == RunVerdict::closed && result.end_on_old_ground.relative.position_m > options.wrong_position_m;
}

}  // namespace helixnav::evaluation
