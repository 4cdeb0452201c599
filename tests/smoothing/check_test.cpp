// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "helixnav/smoothing/marginals.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/problem.hpp"
#include "input_error.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

Problem good_problem() { return testing::random_problem(1, {6, 3, 1.0}).problem; }

template <class Change>
std::string error_after(Change&& change) {
  Problem problem = good_problem();
  change(problem);
  const std::string message = helixnav::testing::input_error_of([&] { check_problem(problem); });
  EXPECT_EQ(message, helixnav::testing::input_error_of([&] { optimize(problem); }));
  EXPECT_EQ(message, helixnav::testing::input_error_of([&] { landmark_covariances(problem); }));
  return message;
}

TEST(CheckProblem, AcceptsAGoodOne) { EXPECT_NO_THROW(check_problem(good_problem())); }

TEST(CheckProblem, NamesALandmarkThatNobodySees) {
  EXPECT_EQ(error_after([](Problem& p) {
              p.graph.landmarks.push_back({17, {1.0, 1.0}});
            }),
            "smoothing: landmark 17 is not observed by any measurement");
}

TEST(CheckProblem, NamesAPoseThatNothingSpeaksOf) {
  EXPECT_EQ(error_after([](Problem& p) {
              p.graph.poses.push_back({203, {}});
            }),
            "smoothing: pose 203 is not observed by any measurement");
}

TEST(CheckProblem, NamesALandmarkWithOneBearing) {
  EXPECT_EQ(error_after([](Problem& p) {
              p.graph.landmarks.push_back({17, {1.0, 1.0}});
              p.graph.landmark_edges.push_back({0, 3, {}, core::make_bearing(0.1, 0.1)});
            }),
            "smoothing: landmark 17 has 2 unknowns but only 1 row of measurements");
}

TEST(CheckProblem, NamesAPoseWithoutGauge) {
  EXPECT_EQ(
      error_after([](Problem& p) { p.fixed_poses.clear(); }),
      "smoothing: no gauge: nothing fixes pose 100 and the 8 variables tied to it in the world; fix a pose or give "
      "a prior");
}

TEST(CheckProblem, NamesASecondPartWithoutGauge) {
  const std::string error = error_after([](Problem& p) {
    p.graph.poses.push_back({500, {}});
    p.graph.poses.push_back({501, {}});
    p.graph.pose_edges.push_back({6, 7, {}, Eigen::Matrix3d::Identity()});
  });
  EXPECT_NE(error.find("no gauge: nothing fixes pose 500 and the 1 variables"), std::string::npos) << error;
}

TEST(CheckProblem, WantsMoreThanOneFixForGauge) {
  const std::string error = error_after([](Problem& p) {
    p.fixed_poses.clear();
    p.graph.fix_edges.push_back({0, {}});
  });
  EXPECT_NE(error.find("no gauge"), std::string::npos) << error;
}

TEST(CheckProblem, NamesOdometryWithASingularCovariance) {
  EXPECT_EQ(error_after([](Problem& p) {
              p.graph.pose_edges[2].covariance.row(1).setZero(), p.graph.pose_edges[2].covariance.col(1).setZero();
            }),
            "smoothing: the covariance of the odometry from pose 102 to pose 103 is not symmetric positive definite");
}

TEST(CheckProblem, NamesAnObservationThatIsNone) {
  const std::string error = error_after(
      [](Problem& p) { p.graph.landmark_edges[0].observation.z[0] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(error.rfind("smoothing: pose 100 sees landmark ", 0), 0u) << error;
}

TEST(CheckProblem, NamesAStartThatIsNotFinite) {
  EXPECT_EQ(error_after([](Problem& p) { p.graph.landmarks[1].point_m.x() = std::numeric_limits<double>::infinity(); }),
            "smoothing: the start of landmark 1 is not finite");
}

TEST(CheckProblem, RefusesIndicesOutOfRange) {
  EXPECT_EQ(error_after([](Problem& p) { p.graph.landmark_edges[0].landmark = 3; }),
            "smoothing: an observation's landmark has index 3 but there are 3");
  EXPECT_EQ(error_after([](Problem& p) { p.fixed_poses = {-1}; }),
            "smoothing: a fixed pose has index -1 but there are 6");
}

TEST(SoftenOdometry, MakesACovarianceOfRankTwoInvertible) {
  Problem problem = good_problem();
  problem.graph.pose_edges[2].covariance = Eigen::Vector3d(0.01, 0.0, 0.01).asDiagonal();
  soften_odometry(problem, {1e-3, 1e-3, 1e-4});
  EXPECT_NO_THROW(optimize(problem));
}

}  // namespace
}  // namespace helixnav::smoothing
