// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/team/team.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "book.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::team {
namespace {

void check_names(const core::Scan& scan, const std::vector<std::int64_t>& names) {
  if (!names.empty() && names.size() != scan.observations.size()) {
    throw core::PreconditionError("team: " + std::to_string(names.size()) + " names for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  for (const core::Observation& observation : scan.observations) {
    if (core::dimension(observation.kind) == 2) continue;
    throw core::PreconditionError("team: a range or a bearing alone does not fix a landmark");
  }
}

}  // namespace

Team::Team(const std::vector<std::optional<core::PoseGaussian>>& starts, const TeamOptions& options) {
  if (starts.empty()) throw core::PreconditionError("team: expected the start of one robot or more");
  for (const std::optional<core::PoseGaussian>& start : starts) {
    if (start) core::check_start(*start);
  }
  if (!(std::isfinite(options.looks_as_one) && options.looks_as_one >= 1.0)) {
    throw core::PreconditionError("team: looks_as_one: expected a number of looks from 1 on, found " +
                                  std::to_string(options.looks_as_one));
  }
  book_ = std::make_unique<Book>(starts, options);
}
Team::~Team() = default;
Team::Team(Team&&) noexcept = default;
Team& Team::operator=(Team&&) noexcept = default;

std::optional<core::StepReport> Team::take(int robot, const core::Event& event,
                                           const std::vector<std::int64_t>& names) {
  book_->check_robot(robot);
  core::check(event);
  const auto r = static_cast<std::size_t>(robot);
  if (const auto* scan = std::get_if<core::Scan>(&event)) {
    check_names(*scan, names);
    return book_->enter({r, NamedScan{*scan, names}});
  }
  if (const auto* motion = std::get_if<core::Odometry>(&event)) book_->move(r, *motion);
  if (std::holds_alternative<core::Lost>(event)) {
    throw core::PreconditionError("team: a robot that was carried is not found again by names");
  }
  if (std::holds_alternative<core::AbsoluteFix>(event)) {
    throw core::PreconditionError("team: takes Odometry and Scan; position fixes have no part in its graph");
  }
  return std::nullopt;
}

void Team::sight(int robot, const core::RobotSighting& sighting) {
  book_->check_robot(robot);
  book_->check_robot(sighting.seen);
  if (sighting.seen == robot) {
    throw core::PreconditionError("team: robot " + std::to_string(robot) + " sees itself; expected another one");
  }
  core::check_observation(sighting.observation);
  book_->sight(static_cast<std::size_t>(robot), sighting);
}

void Team::solve() { book_->solve_all(book_->entries.empty() ? 0 : book_->entries.back().t_ns()); }

core::PoseGaussian Team::pose(int robot) const {
  book_->check_robot(robot);
  State& state = book_->state;
  const auto r = static_cast<std::size_t>(robot);
  return state.of(r).filter.pose(state.robots[r].slot);
}

int Team::component(int robot) const {
  book_->check_robot(robot);
  const auto& robots = book_->state.of(static_cast<std::size_t>(robot)).robots;
  return static_cast<int>(*std::min_element(robots.begin(), robots.end()));
}

std::vector<core::MapLandmark> Team::map(int robot) const {
  book_->check_robot(robot);
  const JointFilter& filter = book_->state.of(static_cast<std::size_t>(robot)).filter;
  std::vector<core::LandmarkId> ids = filter.ids();
  std::sort(ids.begin(), ids.end());
  std::vector<core::MapLandmark> map;
  for (const core::LandmarkId id : ids) {
    core::MapLandmark& landmark = map.emplace_back();
    landmark.id = id;
    landmark.point = filter.landmark(id);
    landmark.observations = book_->state.observations[static_cast<std::size_t>(id)];
    landmark.state = landmark.observations > 1 ? core::LandmarkState::mature : core::LandmarkState::tentative;
  }
  return map;
}

std::vector<core::StampedPose> Team::path(int robot) const {
  book_->check_robot(robot);
  std::vector<core::StampedPose> path;
  for (const Clone& clone : book_->state.robots[static_cast<std::size_t>(robot)].clones) {
    path.push_back({clone.t_ns, clone.T_component_robot});
  }
  return path;
}

core::LandmarkId Team::landmark_of(int robot, std::int64_t name) const {
  const auto id = book_->state.id_of_name.find({static_cast<std::size_t>(robot), name});
  return id == book_->state.id_of_name.end() ? core::no_landmark : book_->state.resolve(id->second);
}

const std::vector<TeamJoin>& Team::joins() const { return book_->state.joins; }
const std::vector<TakenBackJoin>& Team::joins_taken_back() const { return book_->taken_back; }

std::vector<JudgedSighting> Team::sightings() const {
  const State& state = book_->state;
  std::vector<JudgedSighting> judged;
  for (const SightingRow& row : state.sighting_rows) {
    const Clone& from = state.robots[row.robot].clones[row.clone];
    const Clone& to = state.robots[row.seen].clones[row.seen_clone];
    JudgedSighting& one = judged.emplace_back();
    one.t_ns = from.t_ns;
    one.robot = static_cast<int>(row.robot);
    one.seen = static_cast<int>(row.seen);
    one.used = row.use == SightingRow::Use::used;
    if (state.robots[row.robot].component != state.robots[row.seen].component) continue;
    const core::PredictedObservation predicted = core::predict_observation(
        row.observation.kind, from.T_component_robot, row.T_robot_sensor, to.T_component_robot.position_m());
    one.residual = core::innovation(row.observation.kind, row.observation.z, predicted.z_hat);
  }
  return judged;
}

void Team::remove_join(std::size_t join) {
  if (join >= joins().size()) throw core::PreconditionError("remove_join: there is no join " + std::to_string(join));
  const TeamJoin removed = joins()[join];
  book_->refused.joins.insert({removed.by, removed.robot, removed.other});
  book_->taken_back.push_back({removed, book_->entries.back().t_ns(), 0, 0});
  book_->start_again();
}

const std::vector<RobotSlip>& Team::slips() const { return book_->state.slips; }

const std::vector<SameLandmarks>& Team::same_landmarks() const { return book_->state.same; }

void Team::remove_same(std::size_t same) {
  if (same >= same_landmarks().size()) {
    throw core::PreconditionError("remove_same: no landmarks were made one as number " + std::to_string(same));
  }
  const SameLandmarks removed = same_landmarks()[same];
  const std::vector<Birth>& births = book_->state.births;
  const BirthKey a = key_of(births[static_cast<std::size_t>(removed.kept)]);
  const BirthKey b = key_of(births[static_cast<std::size_t>(removed.removed)]);
  book_->refused_same.insert({std::min(a, b), std::max(a, b)});
  book_->start_again();
}

}  // namespace helixnav::team
