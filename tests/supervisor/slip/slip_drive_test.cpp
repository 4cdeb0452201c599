// SPDX-License-Identifier: BSD-3-Clause
// Towns in which the vehicle slips, and orchards in which it does not, judged by the truth.
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/decision.hpp"
#include "helixnav/core/odometry.hpp"
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

/// Carried, slipped and carried again: old landmarks are 100 m from where the region in which they are passive was
/// left, and are not among those around them.
TEST(SlipDrive, OfAVehicleThatIsCarriedTooIsIndexed) {
  EXPECT_NO_THROW(navigate_and_judge(sim::named_scenario("kidnapped-slip"), 4300009));
}

/// Posts on both sides of a straight road, seen 12 m ahead and to the sides.
core::Scan scan_of_posts(double vehicle_x_m, int scan) {
  core::Scan seen;
  seen.t_ns = 500'000'000LL * scan;
  seen.field_of_view = {0.3, 12.0, -core::pi / 2, core::pi / 2};
  for (int post = 0; post < 40; ++post) {
    const Eigen::Vector2d at_m(2.2 * post + std::sin(5.0 * post) - vehicle_x_m,
                               (post % 2 == 0 ? 1.0 : -1.0) * (4.0 + 3.0 * std::cos(3.0 * post)));
    if (at_m.norm() > 12.0 || at_m.x() < 0.0) continue;
    core::Observation observation;
    observation.z = Eigen::Vector2d(at_m.norm(), std::atan2(at_m.y(), at_m.x()));
    observation.R = Eigen::Vector2d(0.04, 0.01).cwiseAbs2().asDiagonal();
    seen.observations.push_back(observation);
  }
  return seen;
}

/// Wheels that spin for two seconds: according to odometry, everything stationary moves with the vehicle at its own speed.
TEST(SlipDrive, OfWheelsThatSpinMakesNothingMove) {
  constexpr double step_m = 0.75;
  Navigator navigator({}, {});
  double vehicle_x_m = 0.0;
  int slips = 0, movers = 0;
  for (int scan = 0; scan < 80; ++scan) {
    core::Odometry motion = core::no_motion(500'000'000LL * scan);
    motion.T_before_after = core::Pose2(step_m, 0.0, 0.0);
    motion.covariance = Eigen::Vector3d(0.03, 0.01, 0.01).cwiseAbs2().asDiagonal();
    if (scan > 0) navigator.move(motion);
    const bool spins = scan >= 40 && scan < 44;
    if (scan > 0 && !spins) vehicle_x_m += step_m;
    for (const core::Decision& decision : navigator.observe(scan_of_posts(vehicle_x_m, scan)).decisions) {
      slips += std::holds_alternative<core::SlipDecision>(decision);
      movers += std::holds_alternative<core::MovingDecision>(decision);
    }
  }
  EXPECT_GE(slips, 3);
  EXPECT_EQ(movers, 0);
  EXPECT_NEAR(navigator.pose().mean.x_m, vehicle_x_m, 0.3);
}

/// An avenue with a pair of posts every 3 m, seen 12 m ahead and to the sides.
core::Scan scan_of_avenue(double vehicle_x_m, int scan) {
  core::Scan seen;
  seen.t_ns = 500'000'000LL * scan;
  seen.field_of_view = {0.3, 12.0, -core::pi / 2, core::pi / 2};
  for (int post = 0; post < 60; ++post) {
    const Eigen::Vector2d at_m(3.0 * (post / 2) + 1.0 - vehicle_x_m, post % 2 == 0 ? 4.0 : -4.0);
    if (at_m.norm() > 11.5 || at_m.x() < 0.0) continue;
    core::Observation observation;
    observation.z = Eigen::Vector2d(at_m.norm(), std::atan2(at_m.y(), at_m.x()));
    observation.R = Eigen::Vector2d(0.04, 0.01).cwiseAbs2().asDiagonal();
    seen.observations.push_back(observation);
  }
  return seen;
}

/// Half a pitch forwards looks like half a pitch back: neither is believed, and the covariance has to hold both.
TEST(SlipDrive, ThatHasARivalOpensASearchAndTheCovariance) {
  Navigator navigator({}, {});
  double vehicle_x_m = 0.0;
  int slips = 0, lost = 0;
  for (int scan = 0; scan < 40; ++scan) {
    core::Odometry motion = core::no_motion(500'000'000LL * scan);
    motion.T_before_after = core::Pose2(0.5, 0.0, 0.0);
    motion.covariance = Eigen::Vector3d(0.02, 0.01, 0.005).cwiseAbs2().asDiagonal();
    if (scan > 0) navigator.move(motion);
    if (scan > 0) vehicle_x_m += 0.5;
    if (scan == 25) vehicle_x_m += 1.5;
    for (const core::Decision& decision : navigator.observe(scan_of_avenue(vehicle_x_m, scan)).decisions) {
      slips += std::holds_alternative<core::SlipDecision>(decision);
      lost += std::holds_alternative<core::LostBySlipDecision>(decision);
    }
  }
  EXPECT_EQ(slips, 0);
  EXPECT_EQ(lost, 1);
  const core::PoseGaussian pose = navigator.pose();
  EXPECT_NEAR(pose.mean.x_m, vehicle_x_m - 1.5, 0.3) << "or it shows nothing";
  EXPECT_GT(std::sqrt(pose.covariance(0, 0)), 0.75);
}

/// Stems of a forest in a strip of 400 by 60 m, one per 25 m².
std::vector<Eigen::Vector2d> stems_of_forest() {
  std::mt19937 engine(1);
  const auto draw_m = [&engine](double from_m, double to_m) {
    return from_m + (to_m - from_m) * static_cast<double>(engine()) / 4294967296.0;
  };
  std::vector<Eigen::Vector2d> stems_m(960);
  for (Eigen::Vector2d& stem_m : stems_m) {
    stem_m.x() = draw_m(-20.0, 380.0);
    stem_m.y() = draw_m(-30.0, 30.0);
  }
  return stems_m;
}

core::Scan scan_of_forest(const std::vector<Eigen::Vector2d>& stems_m, double vehicle_x_m, int scan,
                          double reliable_m) {
  core::Scan seen;
  seen.t_ns = 500'000'000LL * scan;
  seen.field_of_view.max_range_m = reliable_m;
  seen.field_of_view.reach_m = 12.0;
  for (const Eigen::Vector2d& stem_m : stems_m) {
    const Eigen::Vector2d at_m = stem_m - Eigen::Vector2d(vehicle_x_m, 0.0);
    if (at_m.norm() > 12.0) continue;
    core::Observation observation;
    observation.z = Eigen::Vector2d(at_m.norm(), std::atan2(at_m.y(), at_m.x()));
    observation.R = Eigen::Vector2d(0.05, 0.01).cwiseAbs2().asDiagonal();
    seen.observations.push_back(observation);
  }
  return seen;
}

/// Carried from 20 to 320 m between two scans, without a pause: how often it is found lost. `hidden_m`: a stem that the first scan
/// there does not see.
int times_lost_when_carried(std::vector<Eigen::Vector2d> stems_m, double reliable_m,
                            const std::optional<Eigen::Vector2d>& hidden_m = {}) {
  Navigator navigator({}, {});
  double vehicle_x_m = 0.0;
  int lost = 0;
  for (int scan = 0; scan < 50; ++scan) {
    core::Odometry motion = core::no_motion(500'000'000LL * scan);
    motion.T_before_after = core::Pose2(0.5, 0.0, 0.0);
    motion.covariance = Eigen::Vector3d(0.02, 0.01, 0.005).cwiseAbs2().asDiagonal();
    if (scan > 0) navigator.move(motion);
    if (scan > 0) vehicle_x_m += 0.5;
    if (scan == 40) vehicle_x_m += 300.0;
    if (scan == 41 && hidden_m) stems_m.push_back(*hidden_m);
    for (const core::Decision& decision :
         navigator.observe(scan_of_forest(stems_m, vehicle_x_m, scan, reliable_m)).decisions)
      lost += std::holds_alternative<core::LostBySlipDecision>(decision);
  }
  return lost;
}

/// Hardly anything stands within the range that is seen reliably, but a dozen stems beyond it vanish.
TEST(SlipDrive, OfAVehicleCarriedInAForestIsNoticedByWhatIsFarOff) {
  EXPECT_EQ(times_lost_when_carried(stems_of_forest(), 2.5), 1);
}

/// Where it is put down, one stem stands where one of a dozen was.
TEST(SlipDrive, OfAVehicleCarriedInAForestIsNoticedDespiteAChanceMatch) {
  const std::vector<Eigen::Vector2d> stems_m = stems_of_forest();
  const Eigen::Vector2d ahead_m(22.0, 0.0);
  const auto nearest = std::min_element(stems_m.begin(), stems_m.end(), [&](const auto& a, const auto& b) {
    return (a - ahead_m).squaredNorm() < (b - ahead_m).squaredNorm();
  });
  const Eigen::Vector2d alike_m = *nearest + Eigen::Vector2d(300.0, 0.0);
  EXPECT_EQ(times_lost_when_carried(stems_m, 12.0, alike_m), 1);
}

/// Most of what a sensor sees stands beyond the range up to which it sees landmarks reliably. The vehicle is pushed round by 6°.
TEST(SlipDrive, IsFoundByLandmarksThatAreSeenLessReliably) {
  std::vector<Eigen::Vector2d> trees_m;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> along_m(0.0, 140.0), across_m(4.0, 30.0);
  for (int k = 0; k < 40; ++k) {
    const double x_m = along_m(random);
    const double y_m = across_m(random);
    trees_m.emplace_back(x_m, k % 2 == 0 ? y_m : -y_m);
  }
  Navigator navigator({}, {});
  core::Pose2 truth;
  int slips = 0;
  for (int scan = 0; scan < 60; ++scan) {
    core::Odometry motion = core::no_motion(500'000'000LL * scan);
    motion.T_before_after = core::Pose2(1.0, 0.0, 0.0);
    motion.covariance = Eigen::Vector3d(0.03, 0.01, 0.004).cwiseAbs2().asDiagonal();
    if (scan > 0) {
      navigator.move(motion);
      truth = core::compose(truth, motion.T_before_after);
    }
    if (scan == 40) truth = core::compose(truth, core::Pose2(0.3, 0.0, 6.0 * core::pi / 180.0));
    core::Scan seen;
    seen.t_ns = 500'000'000LL * scan;
    seen.field_of_view = {1.0, 15.0, -core::pi / 4, core::pi / 4, 60.0};
    for (const Eigen::Vector2d& tree_m : trees_m) {
      const Eigen::Vector2d at_m = core::transform(core::inverse(truth), tree_m);
      if (at_m.norm() > 60.0 || std::abs(std::atan2(at_m.y(), at_m.x())) > core::pi / 4) continue;
      seen.observations.push_back(core::make_range_bearing(at_m.norm(), std::atan2(at_m.y(), at_m.x()), 0.15, 0.005));
    }
    for (const core::Decision& decision : navigator.observe(seen).decisions) {
      slips += std::holds_alternative<core::SlipDecision>(decision);
    }
  }
  EXPECT_EQ(slips, 1);
  EXPECT_NEAR(navigator.pose().mean.heading_rad, truth.heading_rad, 0.02);
}

}  // namespace
}  // namespace helixnav::supervisor
