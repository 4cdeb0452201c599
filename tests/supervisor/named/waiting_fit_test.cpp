// SPDX-License-Identifier: BSD-3-Clause
#include "named/waiting_fit.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/odometry.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

using Index = Eigen::Index;

constexpr double sigma_rad = 1e-5;  // small, so that one linearisation is as good as another

/// A camera drives a bend, is cloned at eight places, and sees three landmarks from each.
class WaitingFit : public ::testing::Test {
 protected:
  WaitingFit() {
    core::RandomStream random(4, "waiting fit");
    core::Pose2 truth;
    for (int place = 0; place < 8; ++place) {
      core::Odometry odometry = core::no_motion(place);
      odometry.T_before_after = core::Pose2(1.5, 0.0, 0.1);
      odometry.covariance = 1e-10 * Eigen::Vector3d(4.0, 1.0, 2.0).asDiagonal();
      truth = core::compose(truth,
                            core::compose(odometry.T_before_after, core::Pose2(random.normal3(odometry.covariance))));
      filter_.predict(odometry);
      clones_.push_back(clone_sensor(filter_, T_robot_sensor_, 5.0, 1e-7));
      const core::Pose2 T_world_sensor = core::compose(truth, T_robot_sensor_);
      for (std::size_t k = 0; k < landmarks_m_.size(); ++k) {
        const Eigen::Vector2d seen_m = core::transform(core::inverse(T_world_sensor), landmarks_m_[k]);
        FitRow row;
        row.kind = core::ObservationKind::bearing;
        row.z = std::atan2(seen_m.y(), seen_m.x()) + sigma_rad * random.normal();
        row.variance = sigma_rad * sigma_rad;
        row.first = 3 * place;
        rows_[k].push_back(row);
      }
    }
    places_ = sensor_places(filter_, clones_);
    for (auto& rows : rows_) {
      for (FitRow& row : rows) row.sensor = places_.T_robot_sensor[static_cast<std::size_t>(row.first / 3)];
    }
  }

  std::vector<WaitingLandmark> waiting() const {
    std::vector<WaitingLandmark> all;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Eigen::Vector2d off_m(0.05, -0.04);
      all.push_back({static_cast<std::int64_t>(k), rows_[k],
                     core::transform(core::inverse(places_.joint.pose), landmarks_m_[k]) + off_m, false});
    }
    return all;
  }

  core::Pose2 T_robot_sensor_{0.4, 0.1, 0.2};
  std::vector<Eigen::Vector2d> landmarks_m_{{9.0, 12.0}, {14.0, 3.0}, {4.0, 16.0}};
  cekf::CompressedEkf filter_{core::PoseGaussian{}};
  std::vector<SensorClone> clones_;
  std::vector<std::vector<FitRow>> rows_ = std::vector<std::vector<FitRow>>(3);
  SensorPlaces places_;
};

/// The mean and covariance of (pose, clones, landmarks), landmarks unknown before: dense normal equations.
struct Dense {
  Eigen::VectorXd moved;  ///< by the sightings: pose and points of the clones
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Vector2d> landmarks_m;
};

Dense dense_posterior(const SensorPlaces& places, const std::vector<std::vector<FitRow>>& rows,
                      std::vector<Eigen::Vector2d> landmarks_m) {
  const Index known = places.joint.covariance.rows();
  const Index size = known + 2 * static_cast<Index>(rows.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(24, size);
  Eigen::VectorXd nu(24);
  Index next = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const core::Pose2& pose = places.joint.pose;
    const Eigen::Vector2d relative_m = core::transform(core::inverse(pose), landmarks_m[k]);
    const WhitenedRows white = *whiten(rows[k], relative_m);
    const Eigen::Matrix2d R = core::rotation(pose.heading_rad).transpose();
    for (Index i = 0; i < white.residual.size(); ++i, ++next) {
      H.row(next).head(known) =
          white.by_place.row(i) * places.by_map.middleRows<3>(rows[k][static_cast<std::size_t>(i)].first);
      const Eigen::RowVector2d by_point = white.by_point.row(i);
      H.row(next).head<2>() -= by_point * R;
      H(next, 2) += by_point.dot(Eigen::Vector2d(relative_m.y(), -relative_m.x()));
      H.row(next).segment<2>(known + 2 * static_cast<Index>(k)) = by_point * R;
      nu[next] = white.residual[i];
    }
  }
  Eigen::MatrixXd information = H.transpose() * H;
  information.topLeftCorner(known, known) += places.joint.covariance.inverse();
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::VectorXd step = covariance * H.transpose() * nu;
  for (std::size_t k = 0; k < rows.size(); ++k) landmarks_m[k] += step.segment<2>(known + 2 * static_cast<Index>(k));
  return {step.head(known), covariance, landmarks_m};
}

TEST_F(WaitingFit, PlacesAndPointsAreThoseOfTheDenseNormalEquations) {
  const auto fit =
      fit_jointly(rows_, places_.covariance, {*waiting()[0].guess_m, *waiting()[1].guess_m, *waiting()[2].guess_m});
  ASSERT_TRUE(fit);
  std::vector<Eigen::Vector2d> at_m;
  for (const Eigen::Vector2d& point_m : fit->points_m) at_m.push_back(core::transform(places_.joint.pose, point_m));
  const Dense dense = dense_posterior(places_, rows_, at_m);
  const core::Pose2 pose(Eigen::Vector3d(places_.joint.pose.vector() + dense.moved.head<3>()));
  for (std::size_t k = 0; k < at_m.size(); ++k) {
    EXPECT_LT((dense.landmarks_m[k] - core::transform(pose, fit->points_m[k])).norm(), 3e-6);
  }
  EXPECT_LT((places_.by_map * dense.moved - fit->moved).norm(), 1e-2 * fit->moved.norm());
}

/// The update of the places and the landmarks derived from them are together the update that all sightings would have
/// made at once.
TEST_F(WaitingFit, EnteringIsTheUpdateByAllSightings) {
  DelayedOptions options;
  const DeterminedLandmarks found = determined(waiting(), places_.covariance, options);
  ASSERT_EQ(found.landmarks.size(), 3u);
  EXPECT_EQ(found.noise_scale, 1.0);
  const Dense dense = dense_posterior(places_, rows_, landmarks_m_);

  filter_.update(rows_about_places(found, places_));
  const SensorPlaces now = sensor_places(filter_, clones_);
  std::vector<core::LandmarkId> ids;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(found.landmarks[k].enters);
    std::vector<FitRow> rows = rows_[k];
    for (FitRow& row : rows) row.sensor = now.T_robot_sensor[static_cast<std::size_t>(row.first / 3)];
    const auto point = derived_from_places(rows, found.fit.points_m[k], now, options.same_m);
    ASSERT_TRUE(point);
    ids.push_back(filter_.augment(*point));
  }
  std::vector<core::LandmarkId> all = places_.joint.ids;
  all.insert(all.end(), ids.begin(), ids.end());
  const core::JointGaussian joint = filter_.joint(all);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT((filter_.landmark_mean(ids[k]) - dense.landmarks_m[k]).norm(), 1e-6);
  }
  EXPECT_LT((joint.covariance - dense.covariance).norm(), 1e-3 * dense.covariance.norm());
}

/// Places that do not turn, and places known for certain.
TEST_F(WaitingFit, SettlesWhereTheCovarianceOfThePlacesIsSingular) {
  const std::vector<Eigen::Vector2d> starts_m{*waiting()[0].guess_m, *waiting()[1].guess_m, *waiting()[2].guess_m};
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(24, 24);
  const auto certain = fit_jointly(rows_, P, starts_m);
  ASSERT_TRUE(certain);
  EXPECT_EQ(certain->moved.norm(), 0.0);
  P.topLeftCorner<3, 3>() = places_.covariance.topLeftCorner<3, 3>();
  P.row(1).setZero();
  P.col(1).setZero();
  ASSERT_TRUE(fit_jointly(rows_, P, starts_m));
}

/// One of the landmarks is seen under a name that is another's half of the time.
TEST_F(WaitingFit, LeavesOutWhatItsSightingsContradict) {
  std::vector<WaitingLandmark> all = waiting();
  for (std::size_t i = 0; i < all[1].rows.size(); i += 2) all[1].rows[i].z += 0.2;
  const DeterminedLandmarks found = determined(all, places_.covariance, {});
  EXPECT_EQ(found.contradicted, std::vector<std::int64_t>{1});
  ASSERT_EQ(found.landmarks.size(), 2u);
  EXPECT_EQ(found.landmarks[0].identity, 0);
  EXPECT_EQ(found.landmarks[1].identity, 2);
}

}  // namespace
}  // namespace helixnav::supervisor
