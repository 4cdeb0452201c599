// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "helixnav/core/errors.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::sim {
namespace {

std::string refusal(const Scenario& scenario) {
  try {
    check_scenario(scenario);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NamedScenario, EachNameGivesAValidScenarioWithADescriptionOfOneLine) {
  std::set<std::string> descriptions;
  for (const std::string& name : scenario_names()) {
    const Scenario scenario = named_scenario(name);
    EXPECT_EQ(scenario.name, name);
    EXPECT_EQ(refusal(scenario), "") << name;
    EXPECT_EQ(scenario.description.find('\n'), std::string::npos) << name;
    EXPECT_TRUE(descriptions.insert(scenario.description).second) << name;
  }
  EXPECT_EQ(scenario_names().front(), "large-loop");
}

TEST(NamedScenario, ProposesTheNearestNameForAnUnknownOne) {
  try {
    named_scenario("large_lop");
    FAIL() << "accepted an unknown name";
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'large-loop'"), std::string::npos) << error.what();
  }
}

TEST(CheckScenario, NamesTheKeyTheValueAndTheRange) {
  Scenario scenario = named_scenario("large-loop");
  scenario.scanner.detection_probability = 1.5;
  EXPECT_EQ(refusal(scenario), "scenario: scanner.detection_probability = 1.5, allowed is 0 to 1");
  EXPECT_THROW(simulate(scenario, 1), core::InputError);
}

TEST(CheckScenario, RefusesNanAndIntervalsFromHighToLow) {
  Scenario scenario = named_scenario("large-loop");
  scenario.vehicle.speed_mps = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(scenario).find("vehicle.speed_mps"), std::string::npos);
  scenario = named_scenario("large-loop");
  scenario.world.tree_spacing_m = {8.0, 5.0};
  EXPECT_NE(refusal(scenario).find("world.tree_spacing_m.max"), std::string::npos);
}

TEST(CheckScenario, RefusesToldNoiseThatNoFilterCouldUse) {
  Scenario scenario = named_scenario("large-loop");
  scenario.true_noise.sigma_range_m = 0.0;
  EXPECT_EQ(refusal(scenario), "");
  scenario.assumed_noise.sigma_range_m = 0.0;
  EXPECT_NE(refusal(scenario).find("assumed_noise.sigma_range_m"), std::string::npos);
}

TEST(CheckScenario, RefusesALoopThatIsAllBare) {
  Scenario scenario = named_scenario("large-loop");
  scenario.world.loop_length_m = {250.0, 250.0};
  EXPECT_NE(refusal(scenario).find("world.bare_length_m.max"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::sim
