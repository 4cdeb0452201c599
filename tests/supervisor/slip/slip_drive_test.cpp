// SPDX-License-Identifier: BSD-3-Clause
// Towns in which the vehicle slips, and orchards in which it does not, judged by the truth.
#include <gtest/gtest.h>

#include "judged_drive.hpp"

namespace helixnav::supervisor {
namespace {

sim::Scenario slip_town(double tour_m) {
  sim::Scenario scenario = sim::named_scenario("slip");
  scenario.world.tour_m = tour_m;
  return scenario;
}

TEST(SlipDrive, OfATownMapsItsTreesOnce) {
  const evaluation::RunScore score = navigate_and_judge(slip_town(1200.0), 202);
  EXPECT_GE(score.slips, 4) << "or it shows nothing";
  EXPECT_GE(score.slips_decided, score.slips / 2);
  EXPECT_LE(score.duplicates, score.trees_seen / 50);
  for (const evaluation::ClosureScore& closure : score.closures) EXPECT_EQ(closure.wrong_pairs, 0);
}

TEST(SlipDrive, OfAnOrchardWithoutSlipsDecidesForNone) {
  for (const std::uint64_t seed : {1, 2}) {
    const evaluation::RunScore score = navigate_and_judge(sim::named_scenario("orchard"), seed);
    EXPECT_EQ(score.slips_decided, 0) << seed;
    EXPECT_EQ(score.verdict, evaluation::RunVerdict::closed) << seed;
  }
}

/// Carried, slipped, and carried again: old landmarks stand 100 m from where the region that they are passive in was left, and are not
/// among those that lie around them.
TEST(SlipDrive, OfAVehicleThatIsCarriedTooIsIndexed) {
  EXPECT_NO_THROW(navigate_and_judge(sim::named_scenario("kidnapped-slip"), 4300009));
}

}  // namespace
}  // namespace helixnav::supervisor
