// SPDX-License-Identifier: BSD-3-Clause
#include "joint_filter.hpp"

#include <cmath>
#include <map>
#include <variant>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "small_team.hpp"

namespace helixnav::team {
namespace {

using testing::Message;
using testing::small_team;
using testing::SmallTeam;
using testing::SmallTeamOptions;
using testing::unknown_starts;

/// Dense normal equations of all poses and landmarks, linearised at the truth: robot 0 starts at its start, and the
/// starts of the others are known with information `others`.
class InformationForm {
 public:
  InformationForm(const SmallTeam& small, double others) : small_(small) {
    for (std::size_t r = 0; r < small.starts.size(); ++r)
      at_.push_back({3 * static_cast<Eigen::Index>(r), small.starts[r]});
    Eigen::Index columns = 3 * static_cast<Eigen::Index>(small.starts.size());
    for (std::size_t i = 0; i < small.landmarks.size(); ++i, columns += 2) landmark_.push_back(columns);
    H_ = Eigen::MatrixXd::Zero(columns, columns);
    constexpr double certain = 1e16;  // of m² and rad²
    H_.diagonal().head(3 * static_cast<Eigen::Index>(small.starts.size())).setConstant(others);
    H_.topLeftCorner<3, 3>().diagonal().setConstant(certain);
    for (const Message& message : small.messages) take(message);
    // What nobody saw carries no information; a one keeps the matrix regular.
    for (Eigen::Index i = 0; i < H_.rows(); ++i) H_(i, i) += H_(i, i) == 0.0 ? 1.0 : 0.0;
    P_ = H_.ldlt().solve(Eigen::MatrixXd::Identity(H_.rows(), H_.cols()));
  }

  Eigen::Matrix3d pose(std::size_t robot) const { return P_.block<3, 3>(at_[robot].column, at_[robot].column); }
  Eigen::Matrix2d landmark(std::size_t name) const { return P_.block<2, 2>(landmark_[name], landmark_[name]); }

 private:
  struct At {
    Eigen::Index column;
    core::Pose2 truth;
  };

  template <int rows, int cols>
  void add(Eigen::Index a, const Eigen::Matrix<double, rows, 3>& J_a, Eigen::Index b,
           const Eigen::Matrix<double, rows, cols>& J_b, const Eigen::Matrix<double, rows, rows>& W) {
    H_.block<3, 3>(a, a) += J_a.transpose() * W * J_a;
    H_.block<3, cols>(a, b) += J_a.transpose() * W * J_b;
    H_.block<cols, 3>(b, a) += J_b.transpose() * W * J_a;
    H_.block<cols, cols>(b, b) += J_b.transpose() * W * J_b;
  }

  void take(const Message& message) {
    At& at = at_[static_cast<std::size_t>(message.robot)];
    if (const auto* motion = std::get_if<core::Odometry>(&message.what)) {
      const core::ComposeJacobians J = core::compose_jacobians(at.truth, motion->T_before_after);
      const Eigen::Matrix3d W = (J.J_second * motion->covariance * J.J_second.transpose()).inverse();
      const Eigen::Index next = H_.rows();
      H_.conservativeResizeLike(Eigen::MatrixXd::Zero(next + 3, next + 3));
      add<3, 3>(at.column, -J.J_first, next, Eigen::Matrix3d::Identity(), W);
      at = {next, core::compose(at.truth, motion->T_before_after)};
    } else if (const auto* scan = std::get_if<core::Scan>(&message.what)) {
      for (std::size_t i = 0; i < message.names.size(); ++i) {
        const auto name = static_cast<std::size_t>(message.names[i]);
        const core::PredictedObservation h = core::predict_observation(scan->observations[i].kind, at.truth,
                                                                       scan->T_robot_sensor, small_.landmarks[name]);
        const Eigen::Matrix<double, 2, 3> H_pose = h.H_pose;
        const Eigen::Matrix2d H_landmark = h.H_landmark;
        const Eigen::Matrix2d W = Eigen::Matrix2d(scan->observations[i].R).inverse();
        add<2, 2>(at.column, H_pose, landmark_[name], H_landmark, W);
      }
    }
  }

  const SmallTeam& small_;
  std::vector<At> at_;
  std::vector<Eigen::Index> landmark_;
  Eigen::MatrixXd H_, P_;
};

template <class Matrix>
double relative(const Matrix& a, const Matrix& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// Every observation from a pose of its own: nothing approximated.
TeamOptions exact() {
  TeamOptions options;
  options.clone_sigma_m = options.clone_sigma_rad = 0.0;
  options.join.by_sightings = false;
  return options;
}

/// A joint EKF over both robots from the first second on, with a weak prior on where the second one starts: 1 m, 1 rad.
JointFilter joint_ekf(const SmallTeam& small, const Eigen::Vector3d& softening) {
  const Eigen::Matrix3d soft = softening.cwiseAbs2().asDiagonal();
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(6, 6);
  P.topLeftCorner<3, 3>() = soft;
  JointFilter filter({small.starts[0], small.starts[1]}, {}, {}, P);
  for (const Message& message : small.messages) {
    const auto r = static_cast<std::size_t>(message.robot);
    if (const auto* motion = std::get_if<core::Odometry>(&message.what)) {
      core::Odometry softened = *motion;
      softened.covariance += soft;
      filter.predict(r, softened);
    } else if (const auto* scan = std::get_if<core::Scan>(&message.what)) {
      for (std::size_t i = 0; i < message.names.size(); ++i) {
        const core::LandmarkId id = message.names[i];
        if (filter.contains(id)) {
          filter.observe(r, id, scan->T_robot_sensor, scan->observations[i], 1e9);
        } else {
          filter.augment(r, id, scan->T_robot_sensor, scan->observations[i]);
        }
      }
    }
  }
  return filter;
}

/// Noise-free data that state noise all the same: every filter stays at the truth, where the problem is linear.
SmallTeam exact_data() {
  SmallTeamOptions plain;
  plain.noise = 5.0;
  plain.drawn = 0.0;
  plain.see_each_other = false;
  return small_team(plain);
}

TEST(JointFilter, EqualsTheInformationFormWhereTheModelIsLinear) {
  const SmallTeam small = exact_data();
  const JointFilter filter = joint_ekf(small, Eigen::Vector3d::Zero());
  const InformationForm twin(small, 1.0);
  for (std::size_t r = 0; r < 2; ++r) EXPECT_LT(relative(filter.pose(r).covariance, twin.pose(r)), 1e-7) << r;
  for (const core::LandmarkId id : filter.ids()) {
    const Eigen::Matrix2d P = filter.landmark(id).covariance_m2;
    EXPECT_LT(relative(P, twin.landmark(static_cast<std::size_t>(id))), 1e-7) << id;
  }
}

TEST(JoinedMaps, EqualTheJointInformationFormWhereTheModelIsLinear) {
  const SmallTeam small = exact_data();
  TeamOptions options = exact();
  options.join.max_sigma_m = 2.0;
  options.join.max_sigma_rad = 0.5;
  Team team = testing::run(small, unknown_starts(small), options);
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_GT(team.joins()[0].t_ns, 2'000'000'000);  // there were two maps
  SmallTeam in_first = small;                      // in the frame of robot 0, as the team's is
  const core::Pose2 T = core::inverse(small.starts[0]);
  for (core::Pose2& start : in_first.starts) start = core::compose(T, start);
  for (Eigen::Vector2d& point_m : in_first.landmarks) point_m = core::transform(T, point_m);
  const InformationForm twin(in_first, 0.0);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_LT(relative(team.pose(static_cast<int>(r)).covariance, twin.pose(r)), 1e-7) << r;
  }
  std::map<core::LandmarkId, Eigen::Matrix2d> mapped;
  for (const core::MapLandmark& landmark : team.map(0)) mapped[landmark.id] = landmark.point.covariance_m2;
  for (std::int64_t name = 0; name < 12; ++name) {
    const core::LandmarkId id = team.landmark_of(1, name);
    if (id == core::no_landmark) continue;
    EXPECT_LT(relative(mapped.at(id), twin.landmark(static_cast<std::size_t>(name))), 1e-7) << name;
  }
}

TEST(JoinedMaps, EqualTheJointEkfAtSmallNoise) {
  SmallTeamOptions tiny;
  tiny.noise = 0.003;
  tiny.see_each_other = false;
  const SmallTeam small = small_team(tiny);
  Team team = testing::run(small, unknown_starts(small), exact());
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  const JointFilter ekf = joint_ekf(small, {2e-5, 2e-5, 2e-6});  // as the graph softens odometry
  for (std::size_t r = 0; r < 2; ++r) {
    const core::PoseGaussian joined = team.pose(static_cast<int>(r));
    EXPECT_LT(relative(joined.covariance, ekf.pose(r).covariance), 1e-4) << r;
    const double sigma_m = std::sqrt(joined.covariance(0, 0));
    EXPECT_LT(testing::difference(joined.mean, ekf.pose(r).mean).norm(), 1e-2 * sigma_m) << r;
  }
}

}  // namespace
}  // namespace helixnav::team
