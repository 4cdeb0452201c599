// SPDX-License-Identifier: BSD-3-Clause
#include "join/session_views.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::apps {
namespace {

constexpr double reach_of_looks_m = 12.0, detected = 0.8;

/// A drive of 200 looks along y = 0 from x = 0 to 100 m, which sees 12 m ahead and to the sides, past trees on a perturbed 5 m grid.
class StraightDrive {
 public:
  explicit StraightDrive(bool half_hidden = false) {
    core::RandomStream random(5, "straight drive");
    for (int k = 0; k < 140; ++k) {
      const double x_m = 5.0 * (k % 20) + random.uniform(-1.0, 1.0);
      map_.joint.ids.push_back(k);
      map_.joint.points_m.emplace_back(x_m, 5.0 * (k / 20) - 15.0 + random.uniform(-1.0, 1.0));
      map_.states.push_back(core::LandmarkState::mature);
    }
    for (int k = 0; k < 200; ++k) {
      looks_.push_back({{0.5 * k, 0.0, 0.0}, {}});
      for (const core::LandmarkId id : map_.joint.ids) {
        const Eigen::Vector2d d = map_.joint.points_m[static_cast<std::size_t>(id)] - Eigen::Vector2d(0.5 * k, 0.0);
        const double share = half_hidden && id % 2 == 0 ? 0.2 * detected : detected;
        if (d.norm() < reach_of_looks_m && d.x() > 0.0 && random.uniform(0.0, 1.0) < share)
          looks_.back().seen.push_back(id);
      }
    }
  }

  SessionViews views() const { return {looks_, map_}; }

 private:
  core::JointMap map_;
  std::vector<Look> looks_;
};

TEST(SessionViews, WhereTheDrivePassesAsManyDetectionsAreExpectedAsThereWouldBe) {
  const SessionViews views = StraightDrive().views();
  const double ahead_m = std::sqrt(reach_of_looks_m * reach_of_looks_m - 36.0);
  const double mean = detected * ahead_m / 0.5;
  EXPECT_NEAR(views.expected({50.0, 6.0}), mean, 0.2 * mean);
  EXPECT_LT(views.missed_by_chance(views.surely_expected({50.0, 2.0})), 1e-3);
}

TEST(SessionViews, BeyondReachOrBehindTheStartNothingSurelyIs) {
  const SessionViews views = StraightDrive().views();
  for (const Eigen::Vector2d& at_m : {Eigen::Vector2d(50.0, 12.5), Eigen::Vector2d(-3.0, 2.0), {50.0, -14.0}}) {
    EXPECT_GT(views.missed_by_chance(views.surely_expected(at_m)), 0.5) << at_m.transpose();
  }
}

TEST(SessionViews, WhereSomeLandmarksAreHardlySeenMissingOneSaysLess) {
  const SessionViews alike = StraightDrive().views();
  const SessionViews unlike = StraightDrive(true).views();
  constexpr double some = 12.0;
  EXPECT_NEAR(alike.missed_by_chance(some), std::exp(-some) * (1.0 + some + 0.5 * some * some), 1e-4) << "Poisson";
  EXPECT_GT(unlike.missed_by_chance(some), 10.0 * alike.missed_by_chance(some));
}

}  // namespace
}  // namespace helixnav::apps
