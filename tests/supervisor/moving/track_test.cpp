// SPDX-License-Identifier: BSD-3-Clause
#include "moving/track.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double sigma_seen_m = 0.1;

SeenPoint sighting_at(double x_m, double y_m) {
  return {0, {x_m, y_m}, sigma_seen_m * sigma_seen_m * Eigen::Matrix2d::Identity()};
}

core::Nanoseconds at_s(double t_s) { return core::nanoseconds_from_seconds(t_s); }

/// Two sightings a second apart: except for its prior, the velocity is their difference, so the next is expected as far on.
TEST(Track, ExpectsWhatMovesAsFarOnAndWhatStandsWhereItWas) {
  Track track(7, sighting_at(10.0, 2.0), at_s(0.0), 5.0);
  track.predict(at_s(1.0));
  EXPECT_GT(track.density_if_standing(sighting_at(10.0, 2.0)), 0.0);
  EXPECT_EQ(track.density_if_standing(sighting_at(12.0, 2.0)), 0.0);
  EXPECT_GT(track.density_if_moving(sighting_at(12.0, 2.0)), 0.0);
  track.see_moving(sighting_at(11.5, 2.0), 3.0);
  EXPECT_EQ(track.nats(), 3.0);
  track.predict(at_s(2.0));
  const double expected = track.density_if_moving(sighting_at(13.0, 2.0));
  for (const double off_m : {-0.3, 0.3}) {
    EXPECT_GT(expected, track.density_if_moving(sighting_at(13.0 + off_m, 2.0)));
    EXPECT_GT(expected, track.density_if_moving(sighting_at(13.0, 2.0 + off_m)));
  }
  EXPECT_EQ(track.density_if_standing(sighting_at(13.0, 2.0)), 0.0);
}

/// Quadrature: each density is that of one object somewhere, as long as no gate truncates it.
TEST(Track, DensitiesIntegrateToOne) {
  Track track(7, sighting_at(10.0, 2.0), at_s(0.0), 1.0);
  track.predict(at_s(0.5));
  double moving = 0.0;
  double standing = 0.0;
  constexpr double step_m = 0.02;
  for (double x_m = 6.0; x_m < 14.0; x_m += step_m) {
    for (double y_m = -2.0; y_m < 6.0; y_m += step_m) {
      moving += step_m * step_m * track.density_if_moving(sighting_at(x_m, y_m));
      standing += step_m * step_m * track.density_if_standing(sighting_at(x_m, y_m));
    }
  }
  EXPECT_NEAR(moving, 1.0, 2e-3);
  EXPECT_NEAR(standing, 1.0, 2e-3);
}

/// In the frame of a vehicle that drives and turns exactly as it reports, densities are the same as for one at rest.
TEST(Track, DoesNotDependOnHowTheVehicleMoves) {
  core::Odometry motion = core::no_motion(at_s(1.0));
  motion.T_before_after = core::Pose2(1.5, -0.4, 0.7);
  const core::Pose2 T_after_before = core::inverse(motion.T_before_after);
  const auto seen_after = [&](double x_m, double y_m) {
    const Eigen::Vector2d at_m = core::transform(T_after_before, Eigen::Vector2d(x_m, y_m));
    return sighting_at(at_m.x(), at_m.y());
  };
  Track rests(7, sighting_at(10.0, 2.0), at_s(0.0), 5.0);
  Track drives = rests;
  rests.predict(at_s(1.0));
  drives.change_frame(motion);
  drives.predict(at_s(1.0));
  rests.see_moving(sighting_at(11.0, 2.5), 0.0);
  drives.see_moving(seen_after(11.0, 2.5), 0.0);
  rests.predict(at_s(2.0));
  drives.predict(at_s(2.0));
  EXPECT_NEAR(rests.density_if_moving(sighting_at(12.2, 3.1)), drives.density_if_moving(seen_after(12.2, 3.1)), 1e-9);
  EXPECT_NEAR(rests.density_if_standing(sighting_at(11.1, 2.4)), drives.density_if_standing(seen_after(11.1, 2.4)),
              1e-9);
}

/// J of a point with respect to the vehicle's motion, against central differences through a motion with a covariance.
TEST(Track, IsAsUncertainByAMotionAsThatIs) {
  core::Odometry motion = core::no_motion(at_s(0.0));
  motion.T_before_after = core::Pose2(1.5, -0.4, 0.7);
  motion.covariance.setZero();
  motion.covariance(2, 2) = 0.01;
  Track track(7, sighting_at(10.0, 2.0), at_s(0.0), 5.0);
  track.change_frame(motion);
  const auto after = [&](double turn_rad) {
    core::Pose2 T = motion.T_before_after;
    T.heading_rad += turn_rad;
    return core::transform(core::inverse(T), Eigen::Vector2d(10.0, 2.0));
  };
  const Eigen::Vector2d by_turn = (after(1e-4) - after(-1e-4)) / 2e-4;
  const Eigen::Matrix2d S =
      0.01 * by_turn * by_turn.transpose() + 2.0 * sigma_seen_m * sigma_seen_m * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d at_m = after(0.0);
  EXPECT_NEAR(track.density_if_standing(sighting_at(at_m.x(), at_m.y())),
              1.0 / (2.0 * core::pi * std::sqrt(S.determinant())), 1e-6);
}

TEST(Track, ForgetsItsLandmarksOnceTheyAreTaken) {
  Track track(7, sighting_at(10.0, 2.0), at_s(0.0), 5.0);
  track.begin_landmark(9);
  EXPECT_EQ(track.take_landmarks(), (std::vector<core::LandmarkId>{7, 9}));
  EXPECT_TRUE(track.landmarks().empty());
}

}  // namespace
}  // namespace helixnav::supervisor
