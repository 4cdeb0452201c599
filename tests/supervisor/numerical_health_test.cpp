// SPDX-License-Identifier: BSD-3-Clause
// What a step reports about its arithmetic and about work that a budget left out.
#include <algorithm>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {
namespace {

std::vector<core::StepReport> steps_of(const core::Recording& run, const NavigatorOptions& options) {
  Navigator navigator(run.start, options);
  std::vector<core::StepReport> steps;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { steps.push_back(navigator.observe(scan)); });
  return steps;
}

std::ptrdiff_t postponed(const std::vector<core::StepReport>& steps, core::PostponedDecision::Work work) {
  std::ptrdiff_t count = 0;
  for (const core::StepReport& step : steps) {
    count += std::count_if(step.decisions.begin(), step.decisions.end(), [&](const core::Decision& decision) {
      const auto* one = std::get_if<core::PostponedDecision>(&decision);
      return one != nullptr && one->work == work;
    });
  }
  return count;
}

TEST(NumericalHealth, OfAnOrdinaryDriveIsFarFromItsLimits) {
  const std::vector<core::StepReport> steps = steps_of(sim::simulate(wide_circuit(), 1), {});
  core::NumericalHealth sum;
  for (const core::StepReport& step : steps) {
    sum.note(step.numerics);
    if (step.joint_dof == 0) {
      EXPECT_EQ(step.numerics.least_pivot, 1.0) << step.step;
    }
  }
  EXPECT_EQ(sum.repaired, 0);
  EXPECT_EQ(sum.refused, 0);
  EXPECT_FALSE(core::is_near_limit(sum));
  EXPECT_LT(sum.least_pivot, 1.0);
  EXPECT_GT(sum.least_pivot, 1e-8);
  EXPECT_LT(sum.asymmetry, 1e-10);
  EXPECT_EQ(postponed(steps, core::PostponedDecision::Work::association), 0);
}

TEST(PostponedWork, OfAnAssociationThatItsBudgetEndedIsInTheReport) {
  NavigatorOptions options;
  options.method = association::Method::jcbb;
  options.association.node_budget = 1;
  const std::vector<core::StepReport> steps = steps_of(sim::simulate(wide_circuit(), 1), options);
  EXPECT_GT(postponed(steps, core::PostponedDecision::Work::association), 100);
}

// Only if the pose was never certain until then is the drive not yet in the atlas when the tape no longer holds it.
TEST(PostponedWork, OfADriveThatIsTooLongToBeSolvedAsAWholeIsInTheReportOfItsClosing) {
  NavigatorOptions options;
  options.search.smooth_up_to_scans = 5;
  const std::vector<core::StepReport> steps = steps_of(sim::simulate(sim::named_scenario("large-loop"), 1), options);
  std::ptrdiff_t accepted = 0;
  for (const core::StepReport& step : steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      accepted += closure != nullptr && closure->accepted ? 1 : 0;
      EXPECT_FALSE(std::holds_alternative<core::SmoothingDecision>(decision));
    }
  }
  ASSERT_GT(accepted, 0);
  EXPECT_EQ(postponed(steps, core::PostponedDecision::Work::drive), accepted);
  options.search.smooth_up_to_scans = 0;  // not asked for
  EXPECT_EQ(postponed(steps_of(sim::simulate(sim::named_scenario("large-loop"), 1), options),
                      core::PostponedDecision::Work::drive),
            0);
}

}  // namespace
}  // namespace helixnav::supervisor
