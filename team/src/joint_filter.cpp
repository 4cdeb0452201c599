// SPDX-License-Identifier: BSD-3-Clause
#include "joint_filter.hpp"

#include <algorithm>
#include <string>

#include <Eigen/Cholesky>

#include "helixnav/core/errors.hpp"
#include "turning.hpp"

namespace helixnav::team {

JointFilter::JointFilter(std::vector<core::Pose2> poses, std::vector<core::LandmarkId> ids,
                         std::vector<Eigen::Vector2d> points_m, Eigen::MatrixXd covariance)
    : poses_(std::move(poses)),
      ids_(std::move(ids)),
      points_m_(std::move(points_m)),
      covariance_(std::move(covariance)) {
  const auto columns = static_cast<Eigen::Index>(3 * poses_.size() + 2 * ids_.size());
  if (points_m_.size() != ids_.size() || covariance_.rows() != columns || covariance_.cols() != columns) {
    throw core::PreconditionError("team: the parts of a joint estimate do not fit each other");
  }
}

std::size_t JointFilter::index_of(core::LandmarkId id) const {
  return static_cast<std::size_t>(std::find(ids_.begin(), ids_.end(), id) - ids_.begin());
}

Eigen::Index JointFilter::column_of(std::size_t landmark) const {
  return static_cast<Eigen::Index>(3 * poses_.size() + 2 * landmark);
}

bool JointFilter::contains(core::LandmarkId id) const { return index_of(id) < ids_.size(); }

void JointFilter::predict(std::size_t robot, const core::Odometry& motion) {
  const auto column = static_cast<Eigen::Index>(3 * robot);
  const core::ComposeJacobians J = core::compose_jacobians(poses_[robot], motion.T_before_after);
  poses_[robot] = core::compose(poses_[robot], motion.T_before_after);
  covariance_.middleRows<3>(column) = (J.J_first * covariance_.middleRows<3>(column)).eval();
  covariance_.middleCols<3>(column) = (covariance_.middleCols<3>(column) * J.J_first.transpose()).eval();
  covariance_.block<3, 3>(column, column) += J.J_second * motion.covariance * J.J_second.transpose();
}

JointFilter::Judged JointFilter::observe(std::size_t robot, core::LandmarkId id, const core::Pose2& T_robot_sensor,
                                         const core::Observation& observation, double gate) {
  const std::size_t landmark = index_of(id);
  if (landmark == ids_.size()) throw core::PreconditionError("team: there is no landmark " + std::to_string(id));
  return update(robot, {column_of(landmark), points_m_[landmark]}, T_robot_sensor, observation, gate);
}

JointFilter::Judged JointFilter::sight(std::size_t robot, std::size_t seen, const core::Pose2& T_robot_sensor,
                                       const core::Observation& observation, double gate) {
  return update(robot, {static_cast<Eigen::Index>(3 * seen), poses_[seen].position_m()}, T_robot_sensor, observation,
                gate);
}

JointFilter::Judged JointFilter::judge_sighting(std::size_t robot, std::size_t seen, const core::Pose2& T_robot_sensor,
                                                const core::Observation& observation, double gate) const {
  return innovation(robot, {static_cast<Eigen::Index>(3 * seen), poses_[seen].position_m()}, T_robot_sensor,
                    observation, gate)
      .judged;
}

JointFilter::Innovation JointFilter::innovation(std::size_t robot, const Point& point,
                                                const core::Pose2& T_robot_sensor, const core::Observation& observation,
                                                double gate) const {
  const auto pose = static_cast<Eigen::Index>(3 * robot);
  const core::PredictedObservation predicted =
      core::predict_observation(observation.kind, poses_[robot], T_robot_sensor, point.at_m);
  Innovation found;
  found.nu = core::innovation(observation.kind, observation.z, predicted.z_hat);
  found.PHt = covariance_.middleCols<3>(pose) * predicted.H_pose.transpose() +
              covariance_.middleCols<2>(point.column) * predicted.H_landmark.transpose();
  core::ObsMatrix S = predicted.H_pose * found.PHt.middleRows<3>(pose) +
                      predicted.H_landmark * found.PHt.middleRows<2>(point.column) + observation.R;
  S = (0.5 * (S + S.transpose())).eval();
  found.S.compute(S);
  if (found.S.info() != Eigen::Success)
    throw core::NumericalError("team: innovation covariance is not positive definite");
  found.judged = {found.nu.dot(found.S.solve(found.nu)), static_cast<int>(found.nu.size()), false};
  found.judged.accepted = found.judged.nis <= gate;
  return found;
}

JointFilter::Judged JointFilter::update(std::size_t robot, const Point& point, const core::Pose2& T_robot_sensor,
                                        const core::Observation& observation, double gate) {
  const Innovation found = innovation(robot, point, T_robot_sensor, observation, gate);
  if (!found.judged.accepted) return found.judged;
  const Eigen::MatrixXd W = found.S.matrixL().solve(found.PHt.transpose()).transpose();
  const Eigen::VectorXd step = found.PHt * found.S.solve(found.nu);
  covariance_.noalias() -= W * W.transpose();
  add_step(robot, step, {poses_, points_m_, covariance_});
  return found.judged;
}

void JointFilter::augment(std::size_t robot, core::LandmarkId id, const core::Pose2& T_robot_sensor,
                          const core::Observation& observation) {
  const core::LocatedLandmark located = core::locate_landmark(observation, poses_[robot], T_robot_sensor);
  const auto pose = static_cast<Eigen::Index>(3 * robot);
  const Eigen::Index n = covariance_.rows();
  const Eigen::MatrixXd rows = located.G_pose * covariance_.middleRows<3>(pose);
  covariance_.conservativeResize(n + 2, n + 2);
  covariance_.bottomLeftCorner(2, n) = rows;
  covariance_.topRightCorner(n, 2) = rows.transpose();
  covariance_.bottomRightCorner<2, 2>() =
      rows.middleCols<3>(pose) * located.G_pose.transpose() + located.G_z * observation.R * located.G_z.transpose();
  ids_.push_back(id);
  points_m_.push_back(located.point_world_m);
}

core::PoseGaussian JointFilter::pose(std::size_t robot) const {
  const auto column = static_cast<Eigen::Index>(3 * robot);
  const Eigen::Matrix3d P = covariance_.block<3, 3>(column, column);
  return {poses_[robot], 0.5 * (P + P.transpose())};
}

core::PointGaussian JointFilter::landmark(core::LandmarkId id) const {
  const std::size_t landmark = index_of(id);
  if (landmark == ids_.size()) throw core::PreconditionError("team: there is no landmark " + std::to_string(id));
  const Eigen::Index column = column_of(landmark);
  const Eigen::Matrix2d P = covariance_.block<2, 2>(column, column);
  return {points_m_[landmark], 0.5 * (P + P.transpose())};
}

core::JointGaussian JointFilter::joint(std::size_t robot, const std::vector<std::size_t>& landmarks) const {
  core::JointGaussian joint;
  joint.pose = poses_[robot];
  const auto pose = static_cast<Eigen::Index>(3 * robot);
  std::vector<Eigen::Index> columns{pose, pose + 1, pose + 2};
  for (const std::size_t landmark : landmarks) {
    joint.ids.push_back(ids_[landmark]);
    joint.points_m.push_back(points_m_[landmark]);
    columns.insert(columns.end(), {column_of(landmark), column_of(landmark) + 1});
  }
  joint.covariance = covariance_(columns, columns);
  return joint;
}

core::JointGaussian JointFilter::joint_of(std::size_t robot, const std::vector<core::LandmarkId>& ids) const {
  std::vector<std::size_t> places;
  for (const core::LandmarkId id : ids) places.push_back(index_of(id));
  return joint(robot, places);
}

void JointFilter::remove(const std::vector<core::LandmarkId>& ids) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(3 * poses_.size()); ++c) columns.push_back(c);
  std::vector<core::LandmarkId> kept;
  std::vector<Eigen::Vector2d> points_m;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (std::find(ids.begin(), ids.end(), ids_[i]) != ids.end()) continue;
    columns.insert(columns.end(), {column_of(i), column_of(i) + 1});
    kept.push_back(ids_[i]);
    points_m.push_back(points_m_[i]);
  }
  covariance_ = covariance_(columns, columns).eval();
  ids_ = std::move(kept);
  points_m_ = std::move(points_m);
}

}  // namespace helixnav::team
