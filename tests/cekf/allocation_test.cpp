// SPDX-License-Identifier: BSD-3-Clause
// Counts the heap allocations of predict and update. malloc itself is counted, because Eigen does not go through
// operator new. Left out under sanitizers, which replace malloc themselves.
#include <gtest/gtest.h>

#include "sanitized.hpp"

#if !defined(HELIXNAV_SANITIZED) && defined(__GLIBC__)

#include <atomic>
#include <cstdlib>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace {
std::atomic<bool> counting{false};
std::atomic<int> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
}

namespace helixnav::cekf {
namespace {

class Allocation : public testing::TestWithParam<Retraction> {};

TEST_P(Allocation, DoesNotHappenInPredictAndUpdateOnceTheSizesHaveBeenSeen) {
  FilterOptions options;
  options.retraction = GetParam();
  CompressedEkf filter({}, options);
  const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
  for (int i = 0; i < 60; ++i) filter.augment(core::make_cartesian({5.0 + i, 0.3 * i - 9.0}, R), {});
  std::vector<core::LandmarkId> active = filter.landmarks();
  active.resize(40);
  filter.switch_region(active);

  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(0.01, 0.0, 0.001);
  odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  std::vector<Match> matches(8);
  for (int k = 0; k < 30; ++k) {
    for (int i = 0; i < 8; ++i) {
      const core::LandmarkId id = active[static_cast<std::size_t>((5 * k + i) % 40)];
      const core::PredictedObservation p = core::predict_observation(
          core::ObservationKind::range_bearing, filter.pose().mean, {}, filter.landmark(id).mean_m);
      matches[static_cast<std::size_t>(i)] = {id, core::make_range_bearing(p.z_hat[0], p.z_hat[1], 0.1, 0.01), {}};
    }
    counting = k >= 10;
    filter.predict(odometry);
    filter.update(matches);
    counting = false;
  }
  EXPECT_EQ(allocations.load(), 0);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Allocation,
                         testing::Values(Retraction::standard, Retraction::right_invariant), [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf

#endif
