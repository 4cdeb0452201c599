// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/likelihood_ratio.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "enumeration.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/core/errors.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

/// The same problem with its observations written in other units: `row_units` is the old unit in the new one.
InnovationProblem in_units(InnovationProblem problem, const Eigen::Vector2d& row_units) {
  const Eigen::Matrix2d U = row_units.asDiagonal();
  for (Prediction& p : problem.predictions) {
    p.z_hat = U * p.z_hat;
    p.H_pose = U * p.H_pose;
    p.H_landmark = U * p.H_landmark;
    p.C_pose = U * p.C_pose;
    p.P_vm_Hm = p.P_vm_Hm * U;
    p.P_mm_Hm = p.P_mm_Hm * U;
    p.HPHt = U * p.HPHt * U;
  }
  for (GatedPair& pair : problem.pairs) {
    pair.nu = U * pair.nu;
    pair.S = U * pair.S * U;
    pair.log_likelihood -= std::log(row_units.prod());
  }
  return problem;
}

struct Decisions {
  int pairs = 0;
  int changed_by_ours = 0;
  int changed_by_published = 0;
};

/// Decides 400 scans twice: in metres and radians, and in other units.
Decisions decide_in_units(const Eigen::Vector2d& row_units) {
  core::RandomStream random(9, "units");
  Options plain;
  Options scaled = plain;
  scaled.extraneous.range_bearing_per_m_rad /= row_units.prod();
  Decisions decisions;
  for (int t = 0; t < 400; ++t) {
    const Scene scene = crowded_scene(random, 6, 8, 0.3);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const InnovationProblem other = in_units(problem, row_units);
    const auto differs = [&](Method method) {
      return associate(method, problem, plain).pairs != associate(method, other, scaled).pairs;
    };
    decisions.pairs += static_cast<int>(associate(Method::likelihood_ratio, problem, plain).pairs.size());
    decisions.changed_by_ours += differs(Method::likelihood_ratio) + differs(Method::ihgr_likelihood_ratio) +
                                 differs(Method::jcbb) + differs(Method::nearest_neighbour_unique);
    decisions.changed_by_published += differs(Method::ihgr_published);
  }
  return decisions;
}

TEST(LikelihoodRatio, DecidesTheSameInDegreesAndThePublishedCostDoesNot) {
  const Decisions decisions = decide_in_units({1.0, 180.0 / core::pi});
  EXPECT_GT(decisions.pairs, 1200);
  EXPECT_EQ(decisions.changed_by_ours, 0);
  EXPECT_GT(decisions.changed_by_published, 120);
}

TEST(LikelihoodRatio, DecidesTheSameInCentimetres) {
  const Decisions decisions = decide_in_units({100.0, 1.0});
  EXPECT_EQ(decisions.changed_by_ours, 0);
  EXPECT_GT(decisions.changed_by_published, 120);
}

TEST(LikelihoodRatio, TakesThePosteriorsModeAmongAllAssignmentsOfTenThousandScans) {
  core::RandomStream random(10, "posterior");
  Options options;
  options.joint_test = false;
  for (int t = 0; t < 10'000; ++t) {
    const Scene scene =
        crowded_scene(random, static_cast<int>(random.below(7)), static_cast<int>(random.below(7)), 0.2);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const Assignment assignment = associate(Method::likelihood_ratio, problem, options);
    // ln of the posterior, written out from P_D, λ and the Gaussians; landmarks not seen contribute 1 − P_D.
    const AssignmentProblem structure = likelihood_ratio_costs(problem, 0.5, {});
    const auto log_posterior = [&](const std::vector<int>& entry) {
      double sum = 0.0;
      int matched = 0;
      for (const int p : entry) {
        matched += p >= 0;
        sum += p >= 0 ? problem.pairs[p].log_likelihood : std::log(options.extraneous.range_bearing_per_m_rad);
      }
      return sum + matched * std::log(options.detection_probability) +
             (static_cast<double>(problem.ids.size()) - matched) * std::log(1.0 - options.detection_probability);
    };
    double best = -1e300;
    for_each_assignment(structure, [&](const std::vector<int>& e) { best = std::max(best, log_posterior(e)); });
    std::vector<int> chosen(problem.observations.size(), -1);
    for (const int p : assignment.pairs) chosen[problem.pairs[p].observation] = p;
    ASSERT_NEAR(log_posterior(chosen), best, 1e-9);
  }
}

TEST(LikelihoodRatio, SpreadsExtraneousObservationsEvenly) {
  const core::FieldOfView view{1.0, 31.0, -core::pi / 2, core::pi / 2};
  const ExtraneousDensity density = uniform_density(view, 3.0);
  EXPECT_NEAR(density.of(core::ObservationKind::range_bearing), 3.0 / (30.0 * core::pi), 1e-15);
  EXPECT_NEAR(density.of(core::ObservationKind::cartesian), 3.0 / (core::pi / 2 * (31.0 * 31.0 - 1.0)), 1e-15);
  EXPECT_NEAR(density.of(core::ObservationKind::bearing), 3.0 / core::pi, 1e-15);
  EXPECT_NEAR(density.of(core::ObservationKind::range), 0.1, 1e-15);
  EXPECT_THROW(uniform_density(core::FieldOfView{}, 3.0), core::PreconditionError);
  EXPECT_THROW(uniform_density(view, 0.0), core::PreconditionError);
}

core::Scan scan_of(const core::FieldOfView& view) {
  core::Scan scan;
  scan.field_of_view = view;
  scan.observations = {core::make_range_bearing(4.0, 0.3, 0.1, 0.01), core::make_bearing(1.0, 0.01),
                       core::make_cartesian({3.0, 4.0}, Eigen::Matrix2d::Identity())};
  return scan;
}

TEST(DensityInView, IsThatOfTheViewWhereTheViewIsBounded) {
  const core::FieldOfView view{1.0, 31.0, -1.0, 1.0};
  const ExtraneousDensity density = density_in_view(scan_of(view), 3.0, {});
  for (const auto kind : {core::ObservationKind::range_bearing, core::ObservationKind::cartesian,
                          core::ObservationKind::bearing, core::ObservationKind::range}) {
    EXPECT_EQ(density.of(kind), uniform_density(view, 3.0).of(kind));
  }
}

TEST(DensityInView, ReachesToTheFurthestPointSeenWhereNobodyKnowsTheView) {
  core::FieldOfView unknown;
  unknown.max_range_m = 0.0;
  const ExtraneousDensity density = density_in_view(scan_of(unknown), 2.0, {});
  EXPECT_NEAR(density.of(core::ObservationKind::cartesian), 2.0 / (core::pi * 25.0), 1e-15);
  EXPECT_NEAR(density.of(core::ObservationKind::range_bearing), 2.0 / (5.0 * 2.0 * core::pi), 1e-15);
}

TEST(DensityInView, IsTheCallersWhereNothingBoundsIt) {
  ExtraneousDensity given;
  given.cartesian_per_m2 = 0.123;
  EXPECT_EQ(density_in_view(scan_of(core::FieldOfView{}), 1.0, given).cartesian_per_m2, 0.123);
  core::Scan blind = scan_of({0.0, 0.0, -core::pi, core::pi});
  blind.observations = {core::make_bearing(1.0, 0.01)};
  EXPECT_EQ(density_in_view(blind, 1.0, given).cartesian_per_m2, 0.123);
  for (const core::FieldOfView& degenerate :
       {core::FieldOfView{5.0, 5.0, -1.0, 1.0}, core::FieldOfView{0.0, 5.0, 1.0, 1.0},
        core::FieldOfView{0.0, 1e200, -1.0, 1.0}, core::FieldOfView{0.0, 1e-200, -1.0, 1.0}}) {
    EXPECT_EQ(density_in_view(scan_of(degenerate), 1.0, given).cartesian_per_m2, 0.123) << degenerate.max_range_m;
  }
}

}  // namespace
}  // namespace helixnav::association
