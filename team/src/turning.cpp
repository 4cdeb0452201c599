// SPDX-License-Identifier: BSD-3-Clause
#include "turning.hpp"

#include <cmath>

namespace helixnav::team {
namespace {

Eigen::Index column_of_robot(std::size_t robot) { return static_cast<Eigen::Index>(3 * robot); }

Eigen::Index column_of_point(std::size_t landmark, const Turning& joint) {
  return static_cast<Eigen::Index>(3 * joint.poses.size() + 2 * landmark);
}

/// Variance of where the robot sees the landmark.
double relative_m2(std::size_t robot, std::size_t landmark, const Turning& joint) {
  const Eigen::Index p = column_of_robot(robot);
  const Eigen::Index l = column_of_point(landmark, joint);
  const Eigen::Vector2d arm_m = joint.points_m[landmark] - joint.poses[robot].position_m();
  Eigen::Matrix<double, 2, 5> J;
  J << -1.0, 0.0, arm_m.y(), 1.0, 0.0, 0.0, -1.0, -arm_m.x(), 0.0, 1.0;
  Eigen::Matrix<double, 5, 5> P;
  P << joint.covariance.block<3, 3>(p, p), joint.covariance.block<3, 2>(p, l), joint.covariance.block<2, 3>(l, p),
      joint.covariance.block<2, 2>(l, l);
  return (J * P * J.transpose()).trace();
}

/// The mean of all rotations from none to this one: the chord of an arc that begins along x, over its length.
Eigen::Matrix2d mean_rotation(double turn_rad) {
  const bool is_straight = std::abs(turn_rad) < 1e-8;
  const double along = is_straight ? 1.0 : std::sin(turn_rad) / turn_rad;
  const double across = is_straight ? 0.5 * turn_rad : (1.0 - std::cos(turn_rad)) / turn_rad;
  Eigen::Matrix2d mean;
  mean << along, -across, across, along;
  return mean;
}

/// A position that was moved, and the heading with which it turns.
struct Moved {
  Eigen::Index column;
  Eigen::Index heading;
  Eigen::Vector2d by_m;
};

Moved moved(Eigen::Index column, std::size_t robot, const Eigen::VectorXd& step) {
  const Eigen::Index heading = column_of_robot(robot) + 2;
  return {column, heading, mean_rotation(step[heading]) * step.segment<2>(column)};
}

void turn_covariance(const std::vector<Moved>& positions, Eigen::MatrixXd& covariance) {
  for (const Moved& one : positions) {
    covariance.row(one.column) -= one.by_m.y() * covariance.row(one.heading);
    covariance.row(one.column + 1) += one.by_m.x() * covariance.row(one.heading);
  }
  for (const Moved& one : positions) {
    covariance.col(one.column) -= one.by_m.y() * covariance.col(one.heading);
    covariance.col(one.column + 1) += one.by_m.x() * covariance.col(one.heading);
  }
}

/// Robots that turn about a place that is not known: the observer, and those that have landmarks of their own. One that is
/// only seen by others has a known position, however it is turned.
std::vector<bool> turning_robots(std::size_t observer, const std::vector<std::size_t>& with, std::size_t robots) {
  std::vector<bool> turns(robots, false);
  turns[observer] = true;
  for (const std::size_t r : with) {
    if (r < robots) turns[r] = true;
  }
  return turns;
}

}  // namespace

std::vector<std::size_t> turning_with(const Turning& joint) {
  std::vector<std::size_t> with(joint.points_m.size(), joint.poses.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    const Eigen::Index column = column_of_point(i, joint);
    double least_m2 = joint.covariance.block<2, 2>(column, column).trace();
    for (std::size_t r = 0; r < joint.poses.size(); ++r) {
      const double variance_m2 = relative_m2(r, i, joint);
      if (variance_m2 >= least_m2) continue;
      least_m2 = variance_m2;
      with[i] = r;
    }
  }
  return with;
}

void add_step(std::size_t observer, const Eigen::VectorXd& step, Turning joint) {
  const std::size_t robots = joint.poses.size();
  const std::vector<std::size_t> with = turning_with(joint);
  const std::vector<bool> turns = turning_robots(observer, with, robots);
  std::vector<Moved> turned;
  const auto shift = [&](Eigen::Index column, std::size_t robot) -> Eigen::Vector2d {
    if (robot == robots) return step.segment<2>(column);
    turned.push_back(moved(column, robot, step));
    return turned.back().by_m;
  };
  for (std::size_t r = 0; r < robots; ++r) {
    core::Pose2& pose = joint.poses[r];
    const Eigen::Index column = column_of_robot(r);
    const Eigen::Vector2d at_m = pose.position_m() + shift(column, turns[r] ? r : robots);
    pose = core::Pose2(at_m.x(), at_m.y(), pose.heading_rad + step[column + 2]);
  }
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    joint.points_m[i] += shift(column_of_point(i, joint), with[i]);
  }
  turn_covariance(turned, joint.covariance);
}

}  // namespace helixnav::team
