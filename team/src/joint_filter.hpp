// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::team {

/// An EKF over the poses of several robots and the landmarks of their map, all correlated: what is known between two
/// solutions of the graph. A robot that has lost its heading does not find it again in what it has begun since
/// (turning.hpp). Columns of the covariance: (x, y, heading) of each robot, then (x, y) of each landmark. Dense:
/// an observation costs O(N²) for N columns. Robots are counted from 0.
/// Test: team/joint_filter_test.cpp (equal to the information form of the same linear problem).
class JointFilter {
 public:
  struct Judged {
    double nis = 0.0;
    int dof = 0;
    bool accepted = false;
  };

  JointFilter() = default;
  JointFilter(std::vector<core::Pose2> poses, std::vector<core::LandmarkId> ids, std::vector<Eigen::Vector2d> points_m,
              Eigen::MatrixXd covariance);

  void predict(std::size_t robot, const core::Odometry& motion);

  bool contains(core::LandmarkId id) const;

  /// Updates unless the NIS exceeds gate. PreconditionError for a landmark that is not there.
  Judged observe(std::size_t robot, core::LandmarkId id, const core::Pose2& T_robot_sensor,
                 const core::Observation& observation, double gate);

  /// A landmark's first observation.
  void augment(std::size_t robot, core::LandmarkId id, const core::Pose2& T_robot_sensor,
               const core::Observation& observation);

  /// `robot` sees the reference point of `seen`.
  Judged sight(std::size_t robot, std::size_t seen, const core::Pose2& T_robot_sensor,
               const core::Observation& observation, double gate);

  /// The same without an update: whether it would be accepted.
  Judged judge_sighting(std::size_t robot, std::size_t seen, const core::Pose2& T_robot_sensor,
                        const core::Observation& observation, double gate) const;

  std::size_t robots() const { return poses_.size(); }
  core::PoseGaussian pose(std::size_t robot) const;
  core::PointGaussian landmark(core::LandmarkId id) const;
  /// The robot's pose with landmarks by their place in ids(): what data association asks for.
  core::JointGaussian joint(std::size_t robot, const std::vector<std::size_t>& landmarks) const;
  /// The same by their ids, all of which are there.
  core::JointGaussian joint_of(std::size_t robot, const std::vector<core::LandmarkId>& ids) const;
  /// Leaves landmarks out. O(N²).
  void remove(const std::vector<core::LandmarkId>& ids);
  const std::vector<core::LandmarkId>& ids() const { return ids_; }
  /// Trace of the covariance of a landmark by its place in ids().
  double variance_m2(std::size_t landmark) const {
    const Eigen::Index column = column_of(landmark);
    return covariance_(column, column) + covariance_(column + 1, column + 1);
  }
  const std::vector<Eigen::Vector2d>& points_m() const { return points_m_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  struct Point {
    Eigen::Index column;
    Eigen::Vector2d at_m;
  };
  struct Innovation {
    core::ObsVector nu;
    Eigen::MatrixXd PHt;
    Eigen::LLT<core::ObsMatrix> S;
    Judged judged;
  };
  Innovation innovation(std::size_t robot, const Point& point, const core::Pose2& T_robot_sensor,
                        const core::Observation& observation, double gate) const;
  std::size_t index_of(core::LandmarkId id) const;
  Eigen::Index column_of(std::size_t landmark) const;
  Judged update(std::size_t robot, const Point& point, const core::Pose2& T_robot_sensor,
                const core::Observation& observation, double gate);

  std::vector<core::Pose2> poses_;
  std::vector<core::LandmarkId> ids_;
  std::vector<Eigen::Vector2d> points_m_;
  Eigen::MatrixXd covariance_;
};

}  // namespace helixnav::team
