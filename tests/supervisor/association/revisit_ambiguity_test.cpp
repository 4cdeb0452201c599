// SPDX-License-Identifier: BSD-3-Clause
#include "association/revisit_ambiguity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "association/confirmation.hpp"
#include "association/gating.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double per_scan = 2.5;

/// A map of random landmarks around a vehicle whose pose has become uncertain, and a scan of some of them.
struct Scene {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> ids;
  core::Scan scan;

  Scene(std::uint64_t seed, double sigma_m, int landmarks = 12) {
    core::RandomStream random(seed, "scene");
    const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < landmarks; ++i) {
      points.emplace_back(28.0 * random.uniform() + 1.0, 20.0 * random.uniform() - 10.0);
      ids.push_back(filter.augment(core::make_cartesian(points.back(), R), {}));
    }
    core::Odometry odometry;
    odometry.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 1e-4 * sigma_m * sigma_m;
    filter.predict(odometry);
    scan.field_of_view = {1.0, 30.0, -core::pi / 2, core::pi / 2};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d& p = points[static_cast<std::size_t>(i)];
      scan.observations.push_back(core::make_range_bearing(p.norm(), std::atan2(p.y(), p.x()), 0.1, 0.02));
    }
  }
};

struct DensePrediction {
  core::ObsVector z_hat;
  Eigen::Matrix2d S;
};

DensePrediction predict_densely(const Scene& scene, core::LandmarkId id, const core::Observation& observation) {
  const core::JointGaussian joint = scene.filter.joint({id});
  const auto predicted =
      core::predict_observation(observation.kind, joint.pose, scene.scan.T_robot_sensor, joint.points_m[0]);
  Eigen::Matrix<double, 2, 5> H;
  H << predicted.H_pose, predicted.H_landmark;
  return {predicted.z_hat, H * joint.covariance * H.transpose() + observation.R};
}

/// η by its definition, from the dense joint covariance.
double expected_objects(const Scene& scene, core::LandmarkId id, const core::Observation& observation) {
  const auto [z_hat, S] = predict_densely(scene, id, observation);
  const double gate = core::chi2_quantile(0.95, 2);
  double objects = 0.0;
  for (const core::LandmarkId other : scene.ids) {
    if (other == id) continue;
    const auto [other_z_hat, other_S] = predict_densely(scene, other, observation);
    const Eigen::Vector2d apart = core::innovation(observation.kind, other_z_hat, z_hat);
    const Eigen::Vector2d nu = core::innovation(observation.kind, observation.z, other_z_hat);
    objects += apart.dot(S.inverse() * apart) < gate || nu.dot(other_S.inverse() * nu) < gate ? 1.0 : 0.0;
  }
  const double area_m2 = 0.5 * core::pi * (30.0 * 30.0 - 1.0);
  const double density = per_scan / area_m2 * z_hat[0];
  const double sensor_area = std::sqrt(Eigen::Matrix2d(observation.R).determinant());
  return objects + density * core::pi * gate * (std::sqrt(S.determinant()) - sensor_area);
}

TEST(RevisitAmbiguity, CountsForeignObjectsByTheirDefinition) {
  int checked = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Scene scene(seed, 0.1 * static_cast<double>(1 + seed % 30));
    const Gating gating(scene.filter, scene.ids, scene.scan, {});
    for (const RevisitAmbiguity& found :
         returns_in_gate(scene.filter, gating.problem, scene.scan, scene.ids, per_scan)) {
      double most = 0.0;
      EXPECT_GE(found.widening, 1.0);
      for (const association::GatedPair& pair : gating.problem.pairs) {
        if (gating.problem.ids[static_cast<std::size_t>(pair.candidate)] != found.landmark) continue;
        const auto& observation = scene.scan.observations[static_cast<std::size_t>(pair.observation)];
        most = std::max(most, expected_objects(scene, found.landmark, observation));
      }
      EXPECT_NEAR(found.expected_confusers, most, 1e-9 * (1.0 + most)) << seed;
      ++checked;
    }
  }
  EXPECT_GT(checked, 150);
}

/// 1.8 gates apart, an observation halfway: neither is in the gate of the other, and either may have been seen.
TEST(RevisitAmbiguity, CountsTheLandmarkOnTheOtherSideOfTheObservation) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  const Eigen::Matrix2d R = 1e-4 * Eigen::Matrix2d::Identity();
  std::vector<core::LandmarkId> ids;
  for (const double y_m : {-2.2, 2.2}) ids.push_back(filter.augment(core::make_cartesian({10.0, y_m}, R), {}));
  core::Odometry odometry;
  odometry.covariance.diagonal() << 1.0, 1.0, 1e-6;
  filter.predict(odometry);
  core::Scan scan;
  scan.field_of_view = {1.0, 30.0, -core::pi / 2, core::pi / 2};
  const auto confusers = [&](double y_m) {
    scan.observations = {core::make_range_bearing(10.0, std::atan2(y_m, 10.0), 0.01, 0.001)};
    const Gating gating(filter, ids, scan, {});
    return most_ambiguous(returns_in_gate(filter, gating.problem, scan, ids, per_scan))->expected_confusers;
  };
  EXPECT_GT(confusers(0.1), 1.0);
  EXPECT_GT(confusers(-0.1), 1.0);
  EXPECT_LT(confusers(-4.0), 0.2) << "beyond the gate of the farther one";
}

TEST(RevisitAmbiguity, IsNoneWhereThePoseIsCertainAndTreesStandApart) {
  const Scene scene(3, 1e-3, 3);
  const Gating gating(scene.filter, scene.ids, scene.scan, {});
  const auto found = returns_in_gate(scene.filter, gating.problem, scene.scan, scene.ids, per_scan);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_LT(most_ambiguous(found)->expected_confusers, 0.05);
}

TEST(RevisitAmbiguity, SpeaksOfOldLandmarksOnly) {
  const Scene scene(4, 2.0);
  const Gating gating(scene.filter, scene.ids, scene.scan, {});
  EXPECT_TRUE(returns_in_gate(scene.filter, gating.problem, scene.scan, {}, per_scan).empty());
  const std::vector<core::LandmarkId> one{scene.ids[1]};
  for (const RevisitAmbiguity& found : returns_in_gate(scene.filter, gating.problem, scene.scan, one, per_scan)) {
    EXPECT_EQ(found.landmark, one.front());
    EXPECT_EQ(found.neighbours, 0);
  }
  EXPECT_EQ(most_ambiguous({}), nullptr);
}

TEST(RevisitAmbiguity, SaysHowMuchWiderThePoseMakesTheGate) {
  const Scene certain(3, 1e-3, 3);
  const Gating gating(certain.filter, certain.ids, certain.scan, {});
  for (const RevisitAmbiguity& found :
       returns_in_gate(certain.filter, gating.problem, certain.scan, certain.ids, per_scan)) {
    EXPECT_LT(found.widening, 2.0) << "the landmarks are known as well as the sensor sees them";
  }
  const Scene uncertain(3, 2.0, 3);
  const Gating wide(uncertain.filter, uncertain.ids, uncertain.scan, {});
  for (const RevisitAmbiguity& found :
       returns_in_gate(uncertain.filter, wide.problem, uncertain.scan, uncertain.ids, per_scan)) {
    EXPECT_GT(found.widening, 10.0);
  }
}

IsolatedHit hit_on(core::LandmarkId landmark, double path_m, const Eigen::Vector2d& point_m = {0.0, 0.0},
                   double pose_m2 = 0.0) {
  constexpr double detector_m2 = 0.01;
  return {landmark, path_m, point_m, detector_m2 * Eigen::Matrix2d::Identity(), pose_m2 * Eigen::Matrix2d::Identity()};
}

TEST(Confirmation, IsGivenByTheLandmarkThatWasMetJustBefore) {
  Confirmation confirmation;
  EXPECT_FALSE(confirmation.confirms(hit_on(7, 100.0), 5.0));
  EXPECT_TRUE(confirmation.confirms(hit_on(7, 104.0), 5.0));
  EXPECT_TRUE(confirmation.confirms(hit_on(7, 109.0), 5.0));
  EXPECT_FALSE(confirmation.confirms(hit_on(8, 110.0), 5.0)) << "another one";
  EXPECT_FALSE(confirmation.confirms(hit_on(7, 111.0), 5.0));
  EXPECT_FALSE(confirmation.confirms(hit_on(7, 117.0), 5.0)) << "too long ago";
}

/// The gate of 9.21 times twice the detector's variance ends at 0.43 m.
TEST(Confirmation, IsGivenAtTheSamePlaceHoweverWideTheGate) {
  constexpr double drifted_m2 = 400.0;
  const auto confirms = [](const Eigen::Vector2d& second_m, double second_pose_m2) {
    Confirmation confirmation;
    EXPECT_FALSE(confirmation.confirms(hit_on(7, 100.0, {30.0, 40.0}, drifted_m2), 5.0));
    return confirmation.confirms(hit_on(7, 101.0, second_m, second_pose_m2), 5.0);
  };
  EXPECT_TRUE(confirms({30.4, 40.0}, drifted_m2));
  EXPECT_FALSE(confirms({30.5, 40.0}, drifted_m2)) << "clutter appears somewhere else";
  EXPECT_TRUE(confirms({32.5, 40.0}, drifted_m2 + 1.0)) << "driven by a metre of noise";
  EXPECT_TRUE(confirms({45.0, 40.0}, 1.0)) << "corrected in between";
}

TEST(RevisitAmbiguity, CallsOldWhatIsMatureAndLongUnseen) {
  association::LandmarkLife life;
  life.observe({0.0, 0.0}, {}, {1}, {});
  for (double x = 1.0; x <= 3.0; x += 1.0) life.observe({x, 0.0}, {1}, {}, {});
  life.drive(60.0);
  EXPECT_TRUE(old_landmarks(life, 60.0).empty());
  life.drive(0.5);
  life.observe({63.5, 0.0}, {}, {2}, {});
  EXPECT_EQ(old_landmarks(life, 60.0), std::vector<core::LandmarkId>{1}) << "2 is young and tentative";
}

}  // namespace
}  // namespace helixnav::supervisor
