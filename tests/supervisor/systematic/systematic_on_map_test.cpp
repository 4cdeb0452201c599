// SPDX-License-Identifier: BSD-3-Clause
// Sessions on an earlier map whose odometry and sensor err throughout: how that map was made the tape does not hold.
#include <optional>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "systematic/with_errors.hpp"

namespace helixnav::supervisor {
namespace {

core::Recording drive_of_day(std::uint64_t day) {
  const sim::Scenario scenario = sim::named_scenario("large-loop");
  return sim::simulate_in(sim::build_world(scenario.world, 3), scenario, day);
}

core::JointMap map_of_day(std::uint64_t day) {
  const core::Recording run = drive_of_day(day);
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  std::optional<core::JointMap> map = map_to_go_on_in(navigator, navigator.map(), 2000);
  EXPECT_TRUE(map.has_value() && map->factors != nullptr);
  return *map;
}

SystematicErrors of_vehicle() {
  SystematicErrors errors;
  errors.too_long = 0.08;
  errors.heading_rad = 0.035;
  errors.short_m = -0.25;
  return errors;
}

struct SessionOnMap {
  std::optional<core::SystematicDecision> taken_out;
  double nees = 0.0;  ///< mean over the second half
};

SessionOnMap session_on(const core::JointMap& map, const core::Recording& run, bool learns) {
  NavigatorOptions options;
  options.noise.systematic = learns;
  options.search.relocalizer.threads = 1;
  Navigator navigator(core::PoseGaussian{}, options);
  navigator.look_for_place_in(map);
  SessionOnMap session;
  int judged = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t k) {
    const core::StepReport report = navigator.observe(scan);
    for (const core::Decision& decision : report.decisions) {
      if (const auto* found = std::get_if<core::SystematicDecision>(&decision)) session.taken_out = *found;
    }
    if (2 * k < run.labels.size()) return;
    session.nees += nees(report.pose, run.true_poses[k].T_world_robot);
    ++judged;
  });
  session.nees /= judged;
  return session;
}

void expect_learnt(const core::JointMap& map, std::uint64_t day) {
  const core::Recording run = with_errors(drive_of_day(day), of_vehicle());
  const SessionOnMap learning = session_on(map, run, true);
  ASSERT_TRUE(learning.taken_out);
  EXPECT_EQ(learning.taken_out->solved_again, 0);
  EXPECT_NEAR(learning.taken_out->too_long, of_vehicle().too_long, 0.025);
  EXPECT_NEAR(learning.taken_out->heading_rad, of_vehicle().heading_rad, 0.006);
  EXPECT_NEAR(learning.taken_out->short_m, of_vehicle().short_m, 0.08);
  const SessionOnMap as_given = session_on(map, run, false);
  EXPECT_FALSE(as_given.taken_out);
  EXPECT_LT(learning.nees, 0.3 * as_given.nees);
}

TEST(SystematicOnMap, IsTakenOutWhereTheDriveOfTheMapIsKnown) { expect_learnt(map_of_day(60), 61); }

TEST(SystematicOnMap, IsTakenOutFromHereOnWhereItIsNotKnown) {
  core::JointMap map = map_of_day(62);
  map.factors = nullptr;
  expect_learnt(map, 63);
}

TEST(SystematicOnMap, ChangesNothingWhereNothingIsWrong) {
  const core::JointMap map = map_of_day(64);
  for (std::uint64_t day = 65; day <= 68; ++day) {
    SCOPED_TRACE(day);
    const SessionOnMap learning = session_on(map, drive_of_day(day), true);
    EXPECT_FALSE(learning.taken_out);
    EXPECT_EQ(learning.nees, session_on(map, drive_of_day(day), false).nees);
  }
}

}  // namespace
}  // namespace helixnav::supervisor
