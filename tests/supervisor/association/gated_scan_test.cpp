// SPDX-License-Identifier: BSD-3-Clause
// Of many candidates, only those that may be seen are gated together; the scan is associated as with all.
#include "association/gated_scan.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

core::Observation seen_at(double x_m, double y_m) {
  return core::make_range_bearing(std::hypot(x_m, y_m), std::atan2(y_m, x_m), 0.1, 0.01);
}

/// Landmarks 6 m apart, `columns` by 10 of them ahead of the vehicle, whose pose is known to half a metre.
cekf::CompressedEkf grid_of(int columns) {
  core::PoseGaussian start;
  start.covariance = Eigen::Vector3d(0.25, 0.25, 1e-4).asDiagonal();
  cekf::CompressedEkf filter(start);
  for (int i = 0; i < 10 * columns; ++i)
    filter.augment(seen_at(10.0 + 6.0 * (i % columns), 6.0 * (i / columns) - 27.0), {});
  core::Odometry moved;
  moved.covariance = Eigen::Vector3d(0.09, 0.09, 1e-4).asDiagonal();
  filter.predict(moved);
  return filter;
}

core::Scan scan_of_three_and_a_new_one() {
  core::Scan scan;
  scan.field_of_view.max_range_m = 80.0;
  scan.observations = {seen_at(10.3, -26.8), seen_at(22.3, -8.8), seen_at(16.3, 9.2), seen_at(25.0, 0.0)};
  return scan;
}

TEST(GatedScan, OfManyCandidatesThoseThatNoObservationMayBeOfAreLeftOut) {
  const cekf::CompressedEkf filter = grid_of(10);
  const core::Scan scan = scan_of_three_and_a_new_one();
  const NavigatorOptions options;
  const GatedScan gated = gate_scan(filter, filter.landmarks(), scan, options);
  EXPECT_LT(gated.gating->joint.ids.size(), 20u);
  for (const core::LandmarkId seen : {0, 32, 61}) {
    EXPECT_EQ(std::count(gated.gating->joint.ids.begin(), gated.gating->joint.ids.end(), seen), 1) << seen;
  }
  const Gating all(filter, filter.landmarks(), scan, options.gates);
  ASSERT_EQ(all.problem.pairs.size(), gated.gating->problem.pairs.size());
  for (std::size_t p = 0; p < all.problem.pairs.size(); ++p) {
    EXPECT_EQ(all.problem.pairs[p].observation, gated.gating->problem.pairs[p].observation);
    EXPECT_NEAR(all.problem.pairs[p].nis, gated.gating->problem.pairs[p].nis, 1e-9);
  }
  for (std::size_t o = 0; o < scan.observations.size(); ++o) {
    const double of_all = all.problem.observations[o].nearest_nis;
    const double of_some = gated.gating->problem.observations[o].nearest_nis;
    if (std::isinf(of_all)) {
      EXPECT_EQ(of_some, of_all);
    } else {
      EXPECT_NEAR(of_some, of_all, 1e-9);
    }
  }
}

TEST(GatedScan, FewCandidatesAreGatedAsTheyAre) {
  const cekf::CompressedEkf filter = grid_of(4);
  const GatedScan gated = gate_scan(filter, filter.landmarks(), scan_of_three_and_a_new_one(), {});
  EXPECT_EQ(gated.gating->joint.ids, filter.landmarks());
}

}  // namespace
}  // namespace helixnav::supervisor
