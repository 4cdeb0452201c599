// SPDX-License-Identifier: BSD-3-Clause
#include "slip/should_be_seen.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

core::Observation straight_ahead(double range_m) {
  core::Observation observation;
  observation.z = Eigen::Vector2d(range_m, 0.0);
  observation.R = Eigen::Vector2d(0.1, 0.01).cwiseAbs2().asDiagonal();
  return observation;
}

/// Seen reliably up to 8 m, and up to 12 m at all.
core::Scan scan_ahead_with(int observations) {
  core::Scan scan;
  scan.field_of_view.max_range_m = 8.0;
  scan.field_of_view.reach_m = 12.0;
  for (int k = 0; k < observations; ++k) scan.observations.push_back(straight_ahead(5.0));
  return scan;
}

TEST(ShouldBeSeen, TellsWhatIsSeenReliablyFromWhatIsMerelyWithinReach) {
  cekf::CompressedEkf filter(core::PoseGaussian{});
  std::vector<core::LandmarkId> ids;
  for (const double range_m : {5.0, 9.0, 11.5, 15.0}) ids.push_back(filter.augment(straight_ahead(range_m), {}));
  const InView in_view = should_be_seen(filter, scan_ahead_with(0), 1.0, ids, {});
  EXPECT_EQ(in_view.surely, std::vector<core::LandmarkId>{ids[0]});
  EXPECT_EQ(in_view.perhaps, std::vector<core::LandmarkId>{ids[1]});
}

TEST(ChanceOfMatch, GrowsWithWhatIsInViewAndWithTheGate) {
  cekf::CompressedEkf filter(core::PoseGaussian{});
  const std::vector<core::LandmarkId> ids = {filter.augment(straight_ahead(5.0), {})};
  constexpr double gate = 0.999;
  EXPECT_EQ(chance_of_match(filter, scan_ahead_with(0), ids, gate), 0.0);
  const double of_one = chance_of_match(filter, scan_ahead_with(1), ids, gate);
  const double of_ten = chance_of_match(filter, scan_ahead_with(10), ids, gate);
  // pi 13.8 sqrt(2 0.1^2 2 0.05^2) / (pi 12^2)
  EXPECT_NEAR(of_one, 9.6e-4, 1e-5);
  EXPECT_NEAR(of_ten, 10.0 * of_one, 1e-4);
  EXPECT_GT(of_one, chance_of_match(filter, scan_ahead_with(1), ids, 0.9));
}

}  // namespace
}  // namespace helixnav::supervisor
