// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/robot_sighting.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/team/robot_slip.hpp"
#include "helixnav/team/same_landmarks.hpp"
#include "helixnav/team/team_join.hpp"
#include "helixnav/team/team_options.hpp"

namespace helixnav::team {

/// A robot that was seen by another, and the outcome.
struct JudgedSighting {
  core::Nanoseconds t_ns = 0;
  int robot = 0;
  int seen = 0;
  bool used = false;
  std::optional<Eigen::Vector2d> residual;  ///< z − ẑ at the last solution (range [m], bearing [rad], or x, y [m]);
                                            ///< nothing between robots that have no common frame
};

/// Several robots in one map. Each robot leaves poses where it saw something or was seen; landmarks, motions and sightings
/// of robots by one another tie them into one sparse least-squares problem, solved again every few seconds from where it
/// was. Between two solutions an EKF over the robots' present poses and the landmarks, started at the solution, takes
/// in what arrives. A robot that is seen is a clone of its pose at that time, interpolated along its motion, never a
/// landmark. Robots whose start is known share a frame; every other robot is a component of its own until common names,
/// sightings one each way or a constellation of landmarks place it in another's frame, and χ² of the joint solution
/// does not object.
///
/// The estimate is a function of the events in order of time: what arrives late is put in its place, and everything
/// since is reprocessed from the checkpoint before it, so that late messages give the same bytes. A sighting waits
/// until the motion of the robot seen has reached its time.
/// Cost: O(N²) per observation, N = 3 robots + 2 landmarks of the component; a solution is a few sparse factorisations.
/// Errors: PreconditionError for events that core::check refuses, fixes and carried robots, robots that do not exist or
/// see themselves, landmarks observed by range or bearing alone; NumericalError for broken mathematics.
/// Test: team/team_test.cpp.
class Team {
 public:
  /// [robot] its start in the common frame, nothing where it is unknown. PreconditionError for a team of none, a start that
  /// core::check_start refuses, and looks_as_one below 1.
  explicit Team(const std::vector<std::optional<core::PoseGaussian>>& starts, const TeamOptions& options = {});
  ~Team();
  Team(Team&&) noexcept;
  Team& operator=(Team&&) noexcept;

  /// Motion, or a scan with a name for each observation, below 0: none. With JoinOptions::by_names a name means the same
  /// landmark to all robots, else to this one. Without names at all the observations of a scan are associated with the
  /// landmarks of the robot's component, whichever robot began them (optimal assignment by likelihood ratio), or begin new
  /// ones. The report of a scan, nothing for motion and for a scan that came late. A robot that sent no motion is taken to have stood
  /// still: of a scan that arrives before the motion up to it, the report is wrong, and pose() is right once the motion is there.
  std::optional<core::StepReport> take(int robot, const core::Event& event,
                                       const std::vector<std::int64_t>& names = {});

  /// `robot` sees another one.
  void sight(int robot, const core::RobotSighting& sighting);

  /// Solves the graph with all that has arrived; at the end of a drive, or before something relies on the answer.
  void solve();

  /// T_component_robot after the last event.
  core::PoseGaussian pose(int robot) const;
  /// Number of the robot's component: the least of its robots.
  int component(int robot) const;
  /// Landmarks of the robot's component; tentative what was seen only once, as under a misread name.
  std::vector<core::MapLandmark> map(int robot) const;
  /// Where the robot was when it saw something or was seen, as known at the last solution, in its component's frame.
  std::vector<core::StampedPose> path(int robot) const;
  /// The landmark that a robot's name means now; no_landmark where the robot has not seen it.
  core::LandmarkId landmark_of(int robot, std::int64_t name) const;
  const std::vector<TeamJoin>& joins() const;
  /// Joins that held for a while and are no longer in joins(), in the order in which they were taken back.
  const std::vector<TakenBackJoin>& joins_taken_back() const;
  std::vector<JudgedSighting> sightings() const;
  /// Landmarks that were made one by their position (JoinOptions::by_place).
  const std::vector<SameLandmarks>& same_landmarks() const;

  /// Slips of robots found in scans without names, by time: those that hold, also where a scan was processed again.
  const std::vector<RobotSlip>& slips() const;

  /// Takes back a join and everything that followed from it; the same two are not joined by the same kind of evidence
  /// again. PreconditionError for one that does not exist; likewise for remove_same().
  void remove_join(std::size_t join);

  /// Makes two landmarks two again and undoes all that followed from their being one; these two are not made one by
  /// their places again.
  void remove_same(std::size_t same);

 private:
  struct Book;
  std::unique_ptr<Book> book_;
};

}  // namespace helixnav::team
