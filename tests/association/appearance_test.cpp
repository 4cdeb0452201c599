// SPDX-License-Identifier: BSD-3-Clause
// Class and size as evidence in the association of one scan.
#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/association/associate.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::association {
namespace {

core::Appearance looks(const char* name, double class_error) {
  core::Appearance seen;
  seen.name = core::ClassName(name);
  seen.class_error = class_error;
  return seen;
}

core::Appearance of_size(double size_m) {
  core::Appearance seen;
  seen.size_m = size_m;
  seen.sigma_size_m = 0.02;
  return seen;
}

core::Observation point_at(double x_m, double y_m, const core::Appearance& seen) {
  core::Observation observation = core::make_cartesian({x_m, y_m}, 0.01 * Eigen::Matrix2d::Identity());
  observation.appearance = seen;
  return observation;
}

/// Landmarks 0.3 m apart at 10 m, and their appearance.
struct Twins {
  Twins() {
    map.ids = {0, 1};
    map.points_m = {{10.0, 0.0}, {10.0, 0.3}};
    map.covariance = 0.01 * Eigen::MatrixXd::Identity(7, 7);
    map.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(0.04, 0.04, 1e-6).asDiagonal();
    for (int i = 0; i < 50; ++i) {
      appearance.count(looks(i % 2 == 0 ? "red" : "blue", 0.01));
      appearance.count(of_size(0.2 + 0.012 * i));
    }
  }

  InnovationProblem problem() const { return make_innovation_problem(map, scan, {}, &appearance); }
  Assignment assignment() const { return associate(Method::likelihood_ratio, problem()); }

  core::JointGaussian map;
  core::Scan scan;
  core::MapAppearance appearance;
};

TEST(AppearanceInAssociation, TwinsAreToldApartByTheirClasses) {
  Twins twins;
  twins.appearance.see(0, looks("red", 0.01));
  twins.appearance.see(1, looks("blue", 0.01));
  // Each is seen where the other is: without classes they are confused.
  twins.scan.observations = {point_at(10.0, 0.28, looks("red", 0.01)), point_at(10.0, 0.02, looks("blue", 0.01))};
  const Assignment by_class = twins.assignment();
  EXPECT_EQ(by_class.observations[0].landmark, 0);
  EXPECT_EQ(by_class.observations[1].landmark, 1);
  const Assignment by_place =
      associate(Method::likelihood_ratio, make_innovation_problem(twins.map, twins.scan, {}, nullptr));
  EXPECT_EQ(by_place.observations[0].landmark, 1);
  EXPECT_EQ(by_place.observations[1].landmark, 0);
}

TEST(AppearanceInAssociation, TwinsAreToldApartByTheirSizes) {
  Twins twins;
  twins.appearance.see(0, of_size(0.30));
  twins.appearance.see(1, of_size(0.45));
  twins.scan.observations = {point_at(10.0, 0.28, of_size(0.31)), point_at(10.0, 0.02, of_size(0.44))};
  const Assignment assignment = twins.assignment();
  EXPECT_EQ(assignment.observations[0].landmark, 0);
  EXPECT_EQ(assignment.observations[1].landmark, 1);
  EXPECT_EQ(assignment.observations[0].outcome, Outcome::matched);
}

TEST(AppearanceInAssociation, AClassThatIsNeverToldWronglyKeepsAPairOutOfItsGate) {
  Twins twins;
  twins.map.ids = {0};
  twins.map.points_m = {{10.0, 0.0}};
  twins.map.covariance = Eigen::MatrixXd(twins.map.covariance.topLeftCorner(5, 5));
  twins.appearance.see(0, looks("red", 1e-6));
  twins.scan.observations = {point_at(10.0, 0.0, looks("blue", 1e-6))};
  EXPECT_EQ(twins.assignment().observations[0].outcome, Outcome::new_landmark);
  twins.scan.observations = {point_at(10.0, 0.0, looks("red", 1e-6))};
  EXPECT_EQ(twins.assignment().observations[0].outcome, Outcome::matched);
}

TEST(AppearanceInAssociation, AClassThatMayBeWrongIsChargedAndNarrowsTheGate) {
  Twins twins;
  twins.map.ids = {0};
  twins.map.points_m = {{10.0, 0.0}};
  twins.map.covariance = Eigen::MatrixXd(twins.map.covariance.topLeftCorner(5, 5));
  twins.appearance.see(0, looks("red", 0.01));
  twins.scan.observations = {point_at(10.0, 0.0, looks("blue", 0.05))};
  const InnovationProblem wrong = twins.problem();
  ASSERT_EQ(wrong.pairs.size(), 1u);
  const core::AppearanceEvidence evidence = twins.appearance.compare(0, twins.scan.observations[0].appearance);
  EXPECT_DOUBLE_EQ(wrong.pairs[0].appearance_nats, evidence.nats);
  EXPECT_LT(evidence.nats, std::log(0.08));
  const AssignmentProblem costs = likelihood_ratio_costs(wrong, 0.9, {});
  EXPECT_NEAR(costs.cost[0], -wrong.pairs[0].log_likelihood - std::log(9.0) - evidence.nats, 1e-12);
  // At a distance at which a pair of the same class is inside the gate, by less than the class narrows it.
  const double variance_m2 = 0.04 + 0.01 + 0.01;
  const double nis = core::chi2_quantile(0.999, 2) - 0.5 * evidence.gate;
  twins.scan.observations = {point_at(10.0 + std::sqrt(nis * variance_m2), 0.0, looks("blue", 0.05))};
  EXPECT_TRUE(twins.problem().pairs.empty());
  twins.scan.observations[0].appearance = looks("red", 0.05);
  EXPECT_EQ(twins.problem().pairs.size(), 1u);
}

TEST(AppearanceInAssociation, ASizeIsOneMoreRowOfTheGate) {
  Twins twins;
  twins.map.ids = {0};
  twins.map.points_m = {{10.0, 0.0}};
  twins.map.covariance = Eigen::MatrixXd(twins.map.covariance.topLeftCorner(5, 5));
  twins.appearance.see(0, of_size(0.30));
  const core::Appearance unlike = of_size(0.60);
  const double size_nis = twins.appearance.compare(0, unlike).size_nis;
  ASSERT_GT(size_nis, 3.0);
  const double left_nis = core::chi2_quantile(0.999, 3) - size_nis;
  ASSERT_GT(left_nis, 0.0) << "one that says nothing";
  const double variance_m2 = 0.04 + 0.01 + 0.01;
  twins.scan.observations = {point_at(10.0 + std::sqrt(0.99 * left_nis * variance_m2), 0.0, unlike)};
  EXPECT_EQ(twins.problem().pairs.size(), 1u);
  twins.scan.observations = {point_at(10.0 + std::sqrt(1.01 * left_nis * variance_m2), 0.0, unlike)};
  EXPECT_TRUE(twins.problem().pairs.empty());
}

TEST(AppearanceInAssociation, TheJointSearchFindsWhatEnumerationOfBothMatchingsFinds) {
  Twins twins;
  twins.appearance.see(0, looks("red", 0.01));
  twins.appearance.see(1, looks("blue", 0.01));
  twins.scan.observations = {point_at(10.0, 0.28, looks("red", 0.01)), point_at(10.0, 0.02, looks("blue", 0.01))};
  const Assignment assignment = associate(Method::joint_likelihood_ratio, twins.problem());
  EXPECT_EQ(assignment.observations[0].landmark, 0);
  EXPECT_EQ(assignment.observations[1].landmark, 1);
}

TEST(AppearanceInExistence, AHitOfAnotherClassSpeaksAgainstTheLandmark) {
  LandmarkLife right, wrong, silent;
  for (LandmarkLife* life : {&right, &wrong, &silent}) life->observe({0.0, 0.0}, {}, {7}, {7});
  right.observe({1.0, 0.0}, {7}, {}, {7}, {0.7});
  wrong.observe({1.0, 0.0}, {7}, {}, {7}, {-1.5});
  silent.observe({1.0, 0.0}, {7}, {}, {7});
  EXPECT_NEAR(right.record(7).log_odds - silent.record(7).log_odds, 0.7, 1e-12);
  EXPECT_NEAR(wrong.record(7).log_odds - silent.record(7).log_odds, -1.5, 1e-12);
}

TEST(AppearanceInExistence, GoesWithItsLandmark) {
  LandmarkLife life;
  life.observe({0.0, 0.0}, {}, {1, 2}, {1, 2});
  life.look(1, looks("red", 0.01));
  life.look(2, looks("red", 0.01));
  life.look(5, looks("blue", 0.01));  // not recorded: counts for the population alone
  EXPECT_FALSE(life.appearance().of(5).is_given());
  life.merge(1, 2);
  EXPECT_FALSE(life.appearance().of(2).is_given());
  life.remove(1);
  EXPECT_TRUE(life.appearance().is_empty());
}

}  // namespace
}  // namespace helixnav::association
