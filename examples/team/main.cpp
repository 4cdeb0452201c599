// SPDX-License-Identifier: BSD-3-Clause
// Two robots that do not know where the other one started. They drive towards each other; once each has seen the other
// they have one map.
#include <cmath>
#include <cstdio>
#include <optional>

#include "helixnav/team/team.hpp"

namespace {

using namespace helixnav;

/// Exact range and bearing of a point.
core::Observation seen_from(const core::Pose2& robot, const Eigen::Vector2d& point_m) {
  const core::PredictedObservation exact =
      core::predict_observation(core::ObservationKind::range_bearing, robot, core::Pose2(), point_m);
  return core::make_range_bearing(exact.z_hat[0], exact.z_hat[1], 0.1, 0.02);
}

core::Odometry forward(core::Nanoseconds t_ns) {
  core::Odometry motion;
  motion.t_ns = t_ns;
  motion.T_before_after = core::Pose2(0.5, 0.0, 0.0);
  motion.covariance = Eigen::Vector3d(1e-4, 1e-5, 1e-5).asDiagonal();
  return motion;
}

}  // namespace

int main() {
  const Eigen::Vector2d post_m(5.0, 3.0);
  core::Pose2 truth[2] = {{0.0, 0.0, 0.0}, {10.0, 0.5, core::pi}};
  team::Team team({std::nullopt, std::nullopt});  // nobody knows where they started

  for (int second = 1; second <= 8; ++second) {
    const core::Nanoseconds t_ns = core::nanoseconds_from_seconds(second);
    for (int robot : {0, 1}) {
      truth[robot] = core::compose(truth[robot], core::Pose2(0.5, 0.0, 0.0));
      team.take(robot, forward(t_ns));
    }
    for (int robot : {0, 1}) {
      const int other = 1 - robot;
      team.sight(robot, {t_ns, other, core::Pose2(), seen_from(truth[robot], truth[other].position_m())});
      core::Scan scan;
      scan.t_ns = t_ns;
      scan.observations.push_back(seen_from(truth[robot], post_m));
      team.take(robot, scan, {7});  // the post has the number 7 on it
    }
  }
  team.solve();

  for (const team::TeamJoin& join : team.joins()) {
    std::printf("robot %d came into the frame of robot %d by %s\n", join.other, join.robot, team::name_of(join.by));
  }
  const core::Pose2 second = team.pose(1).mean;
  std::printf("robot 1 is at %.2f m, %.2f m in the frame of robot 0; the map has %zu landmark\n", second.x_m,
              second.y_m, team.map(0).size());
  const bool right = (second.position_m() - truth[1].position_m()).norm() < 0.1 && team.map(0).size() == 1;
  return right ? 0 : 1;
}
