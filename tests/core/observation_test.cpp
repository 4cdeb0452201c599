// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/observation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "central_differences.hpp"
#include "helixnav/core/errors.hpp"
#include "random_states.hpp"

namespace helixnav::core {
namespace {

using helixnav::testing::central_differences;
using testing::random_heading;
using testing::random_pose;
using testing::states;

constexpr ObservationKind kinds[] = {ObservationKind::range_bearing, ObservationKind::cartesian,
                                     ObservationKind::bearing, ObservationKind::range};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Situation {
  Pose2 T_world_robot;
  Pose2 T_robot_sensor;
  Eigen::Vector2d landmark_world_m;
};

/// A landmark 0.5 to 60 m from the sensor; every third bearing is behind the sensor, at the cut.
Situation random_situation(RandomStream& random) {
  Situation s;
  s.T_world_robot = random_pose(random);
  s.T_robot_sensor = random_pose(random, 4.0);
  const double range_m = random.uniform(0.5, 60.0);
  const double bearing_rad = random_heading(random);
  s.landmark_world_m = transform(compose(s.T_world_robot, s.T_robot_sensor),
                                 range_m * Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
  return s;
}

TEST(PredictObservation, JacobiansEqualCentralDifferencesForAllKinds) {
  RandomStream random(1, "observation");
  for (int i = 0; i < states; ++i) {
    const Situation s = random_situation(random);
    for (const ObservationKind kind : kinds) {
      const auto difference = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
        return Eigen::VectorXd(innovation(kind, a, b));
      };
      const auto by_pose = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        return predict_observation(kind, Pose2(Eigen::Vector3d(v)), s.T_robot_sensor, s.landmark_world_m).z_hat;
      };
      const auto by_landmark = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        return predict_observation(kind, s.T_world_robot, s.T_robot_sensor, v).z_hat;
      };
      const PredictedObservation p = predict_observation(kind, s.T_world_robot, s.T_robot_sensor, s.landmark_world_m);
      ASSERT_EQ(p.z_hat.size(), dimension(kind));
      const Eigen::MatrixXd H_pose = central_differences(by_pose, s.T_world_robot.vector(), difference);
      const Eigen::MatrixXd H_landmark = central_differences(by_landmark, s.landmark_world_m, difference);
      EXPECT_LT((H_pose - p.H_pose).norm(), 1e-6 * (1.0 + p.H_pose.norm())) << static_cast<int>(kind);
      EXPECT_LT((H_landmark - p.H_landmark).norm(), 1e-6 * (1.0 + p.H_landmark.norm())) << static_cast<int>(kind);
    }
  }
}

TEST(PredictObservation, AgreesWithWhatTheNamesSay) {
  const Pose2 T_world_robot(10.0, 0.0, pi / 2.0);
  const Pose2 T_robot_sensor(2.0, 0.0, 0.0);
  const Eigen::Vector2d landmark_m(7.0, 6.0);  // 4 m ahead of the sensor, 3 m to its left
  const auto predict = [&](ObservationKind kind) {
    return predict_observation(kind, T_world_robot, T_robot_sensor, landmark_m).z_hat;
  };
  EXPECT_LT((predict(ObservationKind::cartesian) - Eigen::Vector2d(4.0, 3.0)).norm(), 1e-12);
  EXPECT_LT((predict(ObservationKind::range_bearing) - Eigen::Vector2d(5.0, std::atan2(3.0, 4.0))).norm(), 1e-12);
  EXPECT_NEAR(predict(ObservationKind::bearing)[0], std::atan2(3.0, 4.0), 1e-12);
  EXPECT_NEAR(predict(ObservationKind::range)[0], 5.0, 1e-12);
}

TEST(PredictObservation, RefusesALandmarkAtTheSensorWhereTheDerivativeDoesNotExist) {
  const Pose2 T_world_robot(1.0, 2.0, 0.3);
  for (const ObservationKind kind :
       {ObservationKind::range_bearing, ObservationKind::bearing, ObservationKind::range}) {
    EXPECT_THROW(predict_observation(kind, T_world_robot, {}, {1.0, 2.0}), NumericalError);
  }
  EXPECT_NO_THROW(predict_observation(ObservationKind::cartesian, T_world_robot, {}, {1.0, 2.0}));
}

TEST(Innovation, WrapsBearingsAndNothingElse) {
  const ObsVector near_pi = ObsVector::Constant(1, pi - 0.01);
  const ObsVector near_minus_pi = ObsVector::Constant(1, -pi + 0.01);
  EXPECT_NEAR(innovation(ObservationKind::bearing, near_minus_pi, near_pi)[0], 0.02, 1e-12);
  EXPECT_NEAR(innovation(ObservationKind::range, near_pi, near_minus_pi)[0], 2.0 * pi - 0.02, 1e-12);
  const ObsVector z = Eigen::Vector2d(9.0, -pi + 0.01);
  const ObsVector z_hat = Eigen::Vector2d(2.0, pi - 0.01);
  EXPECT_LT((innovation(ObservationKind::range_bearing, z, z_hat) - Eigen::Vector2d(7.0, 0.02)).norm(), 1e-12);
  EXPECT_LT((innovation(ObservationKind::cartesian, z, z_hat) - (z - z_hat)).norm(), 1e-12);
}

TEST(LocateLandmark, InvertsThePrediction) {
  RandomStream random(2, "observation");
  for (int i = 0; i < states; ++i) {
    const Situation s = random_situation(random);
    for (const ObservationKind kind : {ObservationKind::range_bearing, ObservationKind::cartesian}) {
      Observation observation;
      observation.kind = kind;
      observation.z = predict_observation(kind, s.T_world_robot, s.T_robot_sensor, s.landmark_world_m).z_hat;
      observation.R = Eigen::Matrix2d::Identity();
      const LocatedLandmark located = locate_landmark(observation, s.T_world_robot, s.T_robot_sensor);
      EXPECT_LT((located.point_world_m - s.landmark_world_m).norm(), 1e-11);
    }
  }
}

TEST(LocateLandmark, JacobiansEqualCentralDifferences) {
  RandomStream random(3, "observation");
  for (int i = 0; i < states; ++i) {
    const Situation s = random_situation(random);
    for (const ObservationKind kind : {ObservationKind::range_bearing, ObservationKind::cartesian}) {
      Observation observation;
      observation.kind = kind;
      observation.z = predict_observation(kind, s.T_world_robot, s.T_robot_sensor, s.landmark_world_m).z_hat;
      observation.R = Eigen::Matrix2d::Identity();
      const LocatedLandmark located = locate_landmark(observation, s.T_world_robot, s.T_robot_sensor);
      const auto by_pose = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        return locate_landmark(observation, Pose2(Eigen::Vector3d(v)), s.T_robot_sensor).point_world_m;
      };
      const auto by_z = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        Observation moved = observation;
        moved.z = v;
        return locate_landmark(moved, s.T_world_robot, s.T_robot_sensor).point_world_m;
      };
      EXPECT_LT((central_differences(by_pose, s.T_world_robot.vector()) - located.G_pose).norm(), 1e-6);
      EXPECT_LT((central_differences(by_z, observation.z) - located.G_z).norm(), 1e-6);
    }
  }
}

TEST(LocateLandmark, RefusesWhatDoesNotFixAPoint) {
  EXPECT_THROW(locate_landmark(make_bearing(0.1, 0.1), {}, {}), PreconditionError);
  EXPECT_THROW(locate_landmark(make_range(3.0, 0.1), {}, {}), PreconditionError);
}

TEST(CheckObservation, AcceptsWhatTheMakersMake) {
  EXPECT_NO_THROW(check_observation(make_range_bearing(5.0, -3.0, 0.1, 0.02)));
  EXPECT_NO_THROW(check_observation(make_cartesian({-3.0, 0.0}, Eigen::Matrix2d::Identity())));
  EXPECT_NO_THROW(check_observation(make_bearing(0.0, 0.01)));
  EXPECT_NO_THROW(check_observation(make_range(0.01, 1.0)));
}

TEST(CheckObservation, RefusesWhatIsNotFinite) {
  EXPECT_THROW(check_observation(make_range_bearing(nan, 0.0, 0.1, 0.02)), PreconditionError);
  EXPECT_THROW(check_observation(make_range_bearing(1.0, infinity, 0.1, 0.02)), PreconditionError);
  EXPECT_THROW(check_observation(make_bearing(0.0, nan)), PreconditionError);
  EXPECT_THROW(check_observation(make_range(1.0, infinity)), PreconditionError);
}

TEST(CheckObservation, RefusesRangesThatAreNotPositive) {
  EXPECT_THROW(check_observation(make_range_bearing(0.0, 0.0, 0.1, 0.02)), PreconditionError);
  EXPECT_THROW(check_observation(make_range(-1.0, 0.1)), PreconditionError);
}

TEST(CheckObservation, RefusesShapesThatDoNotFitTheKind) {
  Observation observation = make_range_bearing(5.0, 0.0, 0.1, 0.02);
  observation.kind = ObservationKind::range;
  EXPECT_THROW(check_observation(observation), PreconditionError);
  observation = make_range_bearing(5.0, 0.0, 0.1, 0.02);
  observation.R = ObsMatrix::Constant(1, 1, 0.1);
  EXPECT_THROW(check_observation(observation), PreconditionError);
  EXPECT_THROW(check_observation(Observation{}), PreconditionError);
}

TEST(CheckObservation, RefusesAnRThatIsNotSymmetricPositiveDefinite) {
  EXPECT_THROW(check_observation(make_range(1.0, 0.0)), PreconditionError);
  Eigen::Matrix2d R;
  R << 1.0, 2.0, 2.0, 1.0;  // indefinite
  EXPECT_THROW(check_observation(make_cartesian({1.0, 1.0}, R)), PreconditionError);
  R << 1.0, 0.1, 0.2, 1.0;  // not symmetric
  EXPECT_THROW(check_observation(make_cartesian({1.0, 1.0}, R)), PreconditionError);
  R << -1.0, 0.0, 0.0, -1.0;  // negative, with a positive determinant
  EXPECT_THROW(check_observation(make_cartesian({1.0, 1.0}, R)), PreconditionError);
  R << 1.0, 1.0, 1.0, 1.0;  // singular
  EXPECT_THROW(check_observation(make_cartesian({1.0, 1.0}, R)), PreconditionError);
}

TEST(CheckObservation, SaysWhatIsWrongWithWhichValues) {
  try {
    check_observation(make_range(-1.5, 0.1));
    FAIL() << "accepted a negative range";
  } catch (const PreconditionError& error) {
    EXPECT_NE(std::string(error.what()).find("range must be positive"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("-1.5"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace helixnav::core
