// SPDX-License-Identifier: BSD-3-Clause
// What a search leaves in the map while it is open: landmarks that were not old when it began become old while it lasts.
#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

/// A search begins at scan 639 and stays open. At scan 880 a tree is in the gate of a landmark last seen at scan 619:
/// with the pose uncertain by 36 m, it was matched to it, by 0.14 nats, and the pose moved by 33 m and 15 degrees.
TEST(OpenSearch, NoReturnToWhatHasBecomeOldSinceItBeganMovesThePose) {
  sim::Scenario town = sim::named_scenario("town");
  town.world.tour_m = 8000.0;
  const core::Recording run = sim::simulate(town, 5400030);
  constexpr std::size_t scans = 890;
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  bool was_open = false;
  std::size_t seen = 0;
  for (const core::Event& event : run.events) {
    const auto report = navigator.take(event);
    if (!report) continue;
    was_open = report->mode == core::Mode::searching;
    if (++seen == scans) break;
  }
  ASSERT_TRUE(was_open) << "or it shows nothing";
  const core::PoseGaussian pose = navigator.pose();
  EXPECT_GT(pose.covariance(0, 0) + pose.covariance(1, 1), 100.0) << "or the place is known, and it shows nothing";
  EXPECT_LT(nees(pose, run.true_poses[scans - 1].T_world_robot), core::chi2_quantile(0.999, 3));
}

}  // namespace
}  // namespace helixnav::supervisor
