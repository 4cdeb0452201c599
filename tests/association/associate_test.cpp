// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/associate.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/core/errors.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

constexpr Method all_methods[] = {
    Method::nearest_neighbour,      Method::nearest_neighbour_unique, Method::likelihood_ratio,     Method::jcbb,
    Method::joint_likelihood_ratio, Method::ihgr_published,           Method::ihgr_likelihood_ratio};

core::Scan scan_at(std::initializer_list<std::pair<double, double>> ranges_and_bearings) {
  core::Scan scan;
  for (const auto& [r, b] : ranges_and_bearings) scan.observations.push_back(core::make_range_bearing(r, b, 0.1, 0.02));
  return scan;
}

TEST(Associate, MatchesBearingsAcrossPi) {
  core::JointGaussian map;
  map.ids = {7};
  map.points_m = {{-10.0, -0.05}};  // bearing just above −π
  map.covariance = Eigen::MatrixXd::Identity(5, 5) * 1e-4;
  const core::Scan scan = scan_at({{10.0, core::pi - 0.005}});
  for (const Method method : all_methods) {
    const InnovationProblem problem = make_innovation_problem(map, scan);
    const Assignment assignment = associate(method, problem);
    ASSERT_EQ(assignment.observations[0].outcome, Outcome::matched) << name(method);
    EXPECT_EQ(assignment.observations[0].landmark, 7);
    EXPECT_LT(assignment.observations[0].nis, 1.0);
    EXPECT_EQ(assignment.joint_dof, 2);
  }
}

TEST(Associate, GivesThreeOutcomes) {
  core::JointGaussian map;
  map.ids = {3};
  map.points_m = {{10.0, 0.0}};
  map.covariance = Eigen::MatrixXd::Identity(5, 5) * 1e-12;
  const core::Scan scan = scan_at({{10.05, 0.0}, {10.42, 0.0}, {11.0, 0.0}});
  for (const Method method : all_methods) {
    const Assignment a = associate(method, make_innovation_problem(map, scan));
    EXPECT_EQ(a.observations[0].outcome, Outcome::matched) << name(method);
    EXPECT_EQ(a.observations[1].outcome, Outcome::ambiguous) << name(method);
    EXPECT_NEAR(a.observations[1].nis, 17.64, 1e-6);
    EXPECT_EQ(a.observations[2].outcome, Outcome::new_landmark) << name(method);
    EXPECT_TRUE(std::isnan(a.observations[2].nis));
  }
}

TEST(Associate, AnswersAnEmptyScanAndAnEmptyMap) {
  core::JointGaussian empty_map;
  empty_map.covariance = Eigen::MatrixXd::Identity(3, 3);
  const core::Scan scan = scan_at({{10.0, 0.0}, {5.0, 1.0}});
  for (const Method method : all_methods) {
    const Assignment nothing = associate(method, make_innovation_problem(empty_map, core::Scan{}));
    EXPECT_TRUE(nothing.observations.empty());
    const Assignment fresh = associate(method, make_innovation_problem(empty_map, scan));
    ASSERT_EQ(fresh.observations.size(), 2u);
    EXPECT_EQ(fresh.observations[0].outcome, Outcome::new_landmark);
    EXPECT_EQ(fresh.joint_dof, 0);
  }
}

TEST(Associate, NearestNeighbourMayTakeALandmarkTwiceAndTheOthersNever) {
  core::JointGaussian map;
  map.ids = {0};
  map.points_m = {{10.0, 0.0}};
  map.covariance = Eigen::MatrixXd::Identity(5, 5) * 1e-3;
  const core::Scan scan = scan_at({{10.05, 0.0}, {9.95, 0.001}});
  for (const Method method : all_methods) {
    const Assignment a = associate(method, make_innovation_problem(map, scan));
    EXPECT_EQ(a.pairs.size(), method == Method::nearest_neighbour ? 2u : 1u) << name(method);
  }
}

TEST(Associate, EveryMatchedSetPassesTheJointTest) {
  core::RandomStream random(11, "joint");
  Options options;
  int dropped = 0;
  for (int t = 0; t < 500; ++t) {
    const Scene scene = crowded_scene(random, 8, 10, 0.3);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    for (const Method method : all_methods) {
      const Assignment a = associate(method, problem, options);
      const JointNis joint = joint_nis(problem, a.pairs);
      EXPECT_EQ(joint.dof, a.joint_dof);
      dropped += a.dropped_pairs;
      EXPECT_NEAR(joint.nis, a.joint_nis, 1e-9 * (1.0 + joint.nis));
      if (joint.dof == 0) continue;
      EXPECT_LE(a.joint_nis, core::chi2_quantile(options.joint_probability, a.joint_dof) + 1e-9);
    }
  }
  EXPECT_GT(dropped, 100);  // the test was put to work
}

TEST(Associate, RefusesOptionsOutOfRange) {
  core::JointGaussian map;
  map.covariance = Eigen::MatrixXd::Identity(3, 3);
  const InnovationProblem problem = make_innovation_problem(map, scan_at({{1.0, 0.0}}));
  const auto refused = [&](auto change) {
    Options options;
    change(options);
    EXPECT_THROW(associate(Method::likelihood_ratio, problem, options), core::PreconditionError);
  };
  refused([](Options& o) { o.detection_probability = 1.0; });
  refused([](Options& o) { o.detection_probability = std::numeric_limits<double>::quiet_NaN(); });
  refused([](Options& o) { o.extraneous.range_bearing_per_m_rad = 0.0; });
  refused([](Options& o) { o.joint_probability = 1.0; });
  refused([](Options& o) { o.node_budget = 0; });
  refused([](Options& o) { o.joint_alternatives = -1; });
  refused([](Options& o) { o.min_margin_nats = -1.0; });
}

}  // namespace
}  // namespace helixnav::association
