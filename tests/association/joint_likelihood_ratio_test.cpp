// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "enumeration.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

double joint_cost(const InnovationProblem& problem, const AssignmentProblem& costs, const std::vector<int>& entry) {
  std::vector<int> pairs;
  double cost = 0.0;
  for (std::size_t i = 0; i < entry.size(); ++i) {
    if (entry[i] < 0) {
      cost += costs.unassigned_cost[i];
    } else {
      pairs.push_back(entry[i]);
      cost -= std::log(0.9 / 0.1);
    }
  }
  return cost - joint_nis(problem, pairs).log_likelihood;
}

std::vector<int> entries(const InnovationProblem& problem, const Assignment& assignment) {
  std::vector<int> entry(problem.observations.size(), -1);
  for (const int p : assignment.pairs) entry[problem.pairs[p].observation] = p;
  return entry;
}

TEST(JointLikelihoodRatio, EqualsBruteForceOnTenThousandScansOfMixedKinds) {
  core::RandomStream random(21, "posterior");
  Options options;
  options.joint_test = false;
  int other_than_separate = 0;
  for (int t = 0; t < 10'000; ++t) {
    const Scene scene = crowded_scene(random, static_cast<int>(random.below(7)), static_cast<int>(random.below(7)), 0.2,
                                      10.0, t % 2 == 1);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const AssignmentProblem costs = likelihood_ratio_costs(problem, options.detection_probability, options.extraneous);
    double best = 1e300;
    for_each_assignment(costs,
                        [&](const std::vector<int>& e) { best = std::min(best, joint_cost(problem, costs, e)); });
    const Assignment found = associate(Method::joint_likelihood_ratio, problem, options);
    ASSERT_NEAR(joint_cost(problem, costs, entries(problem, found)), best, 1e-7);
    ASSERT_FALSE(found.budget_hit);
    other_than_separate += found.pairs != associate(Method::likelihood_ratio, problem, options).pairs;
  }
  EXPECT_GT(other_than_separate, 300);
}

TEST(JointLikelihoodRatio, MarginsEqualTheCostOfChangingOneObservation) {
  core::RandomStream random(22, "margins");
  Options options;
  options.joint_test = false;
  for (int t = 0; t < 300; ++t) {
    const Scene scene = crowded_scene(random, 5, 6, 0.2, 6.0);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const AssignmentProblem costs = likelihood_ratio_costs(problem, options.detection_probability, options.extraneous);
    const Assignment found = associate(Method::joint_likelihood_ratio, problem, options);
    const std::vector<int> chosen = entries(problem, found);
    std::vector<double> other(chosen.size(), std::numeric_limits<double>::infinity());
    for_each_assignment(costs, [&](const std::vector<int>& e) {
      std::vector<std::size_t> changed;
      for (std::size_t i = 0; i < e.size(); ++i) {
        if (e[i] != chosen[i]) changed.push_back(i);
      }
      if (changed.size() == 1) other[changed[0]] = std::min(other[changed[0]], joint_cost(problem, costs, e));
    });
    const double own = joint_cost(problem, costs, chosen);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (std::isinf(other[i])) continue;
      ASSERT_NEAR(found.observations[i].margin_nats, other[i] - own, 1e-7);
      ASSERT_GE(found.observations[i].margin_nats, -1e-9);
    }
  }
}

TEST(JointLikelihoodRatio, MatchesWhatItCanWhenTheBudgetEnds) {
  core::RandomStream random(23, "budget");
  const Scene scene = crowded_scene(random, 40, 40, 0.3, 2.0);
  const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
  Options options;
  options.node_budget = 1;
  const Assignment found = associate(Method::joint_likelihood_ratio, problem, options);
  EXPECT_TRUE(found.budget_hit);
  EXPECT_GT(found.pairs.size(), 10u);
}

}  // namespace
}  // namespace helixnav::association
