// SPDX-License-Identifier: BSD-3-Clause
// Which part of a rich scan is weighed against which landmarks: the same slips are found as with all of them.
#include "slip/keep_weighed.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"
#include "slip/slip_decision.hpp"

namespace helixnav::supervisor {
namespace {

/// Landmarks at least 5 m apart within 80 m of the vehicle, known to a decimetre.
std::vector<Eigen::Vector2d> forest(int count) {
  core::RandomStream random(4, "forest");
  std::vector<Eigen::Vector2d> points_m;
  while (static_cast<int>(points_m.size()) < count) {
    const Eigen::Vector2d point_m(random.uniform(-80.0, 80.0), random.uniform(-80.0, 80.0));
    const bool crowded = std::any_of(points_m.begin(), points_m.end(),
                                     [&](const Eigen::Vector2d& other) { return (other - point_m).norm() < 5.0; });
    if (!crowded && point_m.norm() > 2.0) points_m.push_back(point_m);
  }
  return points_m;
}

core::Scan scan_of(const std::vector<Eigen::Vector2d>& points_m, const core::Pose2& T_predicted_true) {
  core::Scan scan;
  scan.field_of_view.max_range_m = 80.0;
  for (const Eigen::Vector2d& point_m : points_m) {
    const Eigen::Vector2d seen_m = core::transform(core::inverse(T_predicted_true), point_m);
    scan.observations.push_back(
        core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.1, 0.005));
  }
  return scan;
}

cekf::CompressedEkf forest_map(const std::vector<Eigen::Vector2d>& points_m) {
  cekf::CompressedEkf filter({{}, 1e-6 * Eigen::Matrix3d::Identity()});
  for (const core::Observation& observation : scan_of(points_m, {}).observations) filter.augment(observation, {});
  return filter;
}

std::vector<SlipLandmark> all_of(const cekf::CompressedEkf& filter) {
  std::vector<SlipLandmark> landmarks;
  for (const core::LandmarkId id : filter.landmarks()) landmarks.push_back({id, filter.landmark_mean(id), 2});
  return landmarks;
}

std::vector<core::LandmarkId> ids_in(const std::vector<SlipLandmark>& landmarks) {
  std::vector<core::LandmarkId> ids;
  for (const SlipLandmark& one : landmarks) ids.push_back(one.id);
  return ids;
}

TEST(KeepWeighed, LeavesOutWhatIsFartherThanAllThatIsWeighed) {
  const cekf::CompressedEkf filter = forest_map(forest(120));
  const core::Scan scan = scan_of(forest(120), core::Pose2(1.5, 0.5, 0.05));
  const std::vector<SeenPoint> seen = seen_points(scan, most_weighed);
  ASSERT_EQ(seen.size(), most_weighed);
  const SlipOptions options;
  std::vector<SlipLandmark> near = all_of(filter);
  keep_weighed(filter.pose().mean, scan, seen, slip_components(options).back(), SlipReach::next_neighbour, near);
  EXPECT_LT(2 * near.size(), filter.landmarks().size());
  EXPECT_GE(near.size(), most_weighed);

  const auto decide = [&](const std::vector<core::LandmarkId>& witnesses) {
    const RelativeGeometry geometry(filter.joint(witnesses));
    const std::vector<double> new_per_m2(seen.size(), 1e-4);
    return decide_slip({geometry, seen, new_per_m2, {}, pair_nats(0.9, 1e-4), 1e-4, false}, options);
  };
  const std::optional<Slip> of_all = decide(filter.landmarks());
  const std::optional<Slip> of_near = decide(ids_in(near));
  ASSERT_TRUE(of_all && of_near);
  EXPECT_NEAR((of_all->displacement - of_near->displacement).norm(), 0.0, 1e-9);
  EXPECT_NEAR(of_near->displacement.x(), 1.5, 0.3);
  ASSERT_EQ(of_all->pairs.size(), of_near->pairs.size());
  for (std::size_t p = 0; p < of_all->pairs.size(); ++p)
    EXPECT_EQ(of_all->pairs[p].landmark, of_near->pairs[p].landmark);
}

TEST(KeepWeighed, OfAScanThatIsWeighedAsAWholeEveryLandmarkStays) {
  const cekf::CompressedEkf filter = forest_map(forest(120));
  core::Scan scan = scan_of(forest(120), {});
  scan.observations.resize(most_weighed - 1);
  std::vector<SlipLandmark> near = all_of(filter);
  keep_weighed(filter.pose().mean, scan, seen_points(scan, most_weighed), slip_components({}).back(),
               SlipReach::next_neighbour, near);
  EXPECT_EQ(ids_in(near), filter.landmarks());
}

}  // namespace
}  // namespace helixnav::supervisor
