// SPDX-License-Identifier: BSD-3-Clause
#include "drive/navigator_on_map.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::apps {
namespace {

constexpr double wood_m = 40.0;  ///< half the side of the square that is on the map
constexpr double view_m = 20.0;

/// A wood that is on the map, surrounded by bare ground with nothing but clutter.
class WoodAndBareGround {
 public:
  explicit WoodAndBareGround(std::uint64_t seed) : random_(seed, "navigator on map") {
    GivenMap map;
    for (int k = 0; k < 70; ++k) {
      core::MapLandmark& tree = map.landmarks.emplace_back();
      tree.id = k;
      tree.point.mean_m = {random_.uniform(-wood_m, wood_m), random_.uniform(-wood_m, wood_m)};
      tree.state = core::LandmarkState::mature;
    }
    drive_.given_map = map;
    scan();
  }

  void go(double length_m, double turn_rad = 0.0) {
    for (double left_m = length_m; left_m > 0.0; left_m -= 1.0) step(turn_rad / length_m);
  }
  /// A slip that the odometry does not see.
  void slip(const core::Pose2& moved) { T_map_robot_ = core::compose(T_map_robot_, moved); }
  void begin_at(const core::Pose2& T_map_robot) {
    drive_.given_map->start = SessionStart{SessionStart::Kind::pose, T_map_robot};
  }

  /// [scan] true pose.
  const std::vector<core::Pose2>& truth() const { return truth_; }
  const Drive& drive() const { return drive_; }

 private:
  void step(double turn_rad) {
    t_ns_ += 500000000;
    const core::Pose2 moved(1.0, 0.0, turn_rad);
    T_map_robot_ = core::compose(T_map_robot_, moved);
    core::Odometry odometry;
    odometry.t_ns = t_ns_;
    const Eigen::Vector3d sigma(0.02, 0.005, 0.01);
    Eigen::Vector3d noisy = moved.vector();
    for (int i = 0; i < 3; ++i) noisy(i) += random_.normal(0.0, sigma(i));
    odometry.T_before_after = core::Pose2(noisy);
    odometry.covariance = sigma.cwiseAbs2().asDiagonal();
    drive_.recording.events.emplace_back(odometry);
    scan();
  }

  void see(const Eigen::Vector2d& point_m, core::Scan& scan) {
    if (point_m.norm() > view_m) return;
    scan.observations.push_back(
        core::make_range_bearing(point_m.norm() + random_.normal(0.0, 0.1),
                                 std::atan2(point_m.y(), point_m.x()) + random_.normal(0.0, 0.01), 0.1, 0.01));
  }

  void scan() {
    core::Scan scan;
    scan.t_ns = t_ns_;
    scan.field_of_view = {0.0, view_m, -core::pi, core::pi};
    const core::Pose2 T_robot_map = core::inverse(T_map_robot_);
    for (const core::MapLandmark& tree : drive_.given_map->landmarks) {
      if (random_.uniform() < 0.9) see(core::transform(T_robot_map, tree.point.mean_m), scan);
    }
    if (random_.uniform() < 0.3) see({random_.uniform(-15.0, 15.0), random_.uniform(-15.0, 15.0)}, scan);
    drive_.recording.events.emplace_back(scan);
    truth_.push_back(T_map_robot_);
  }

  core::RandomStream random_;
  Drive drive_;
  core::Pose2 T_map_robot_;
  core::Nanoseconds t_ns_ = 0;
  std::vector<core::Pose2> truth_;
};

struct Judged {
  int sure_and_wrong = 0;  ///< scans with an error beyond four standard deviations and a metre
  double last_error_m = 0.0;
  int sought = 0;        ///< scans without a known place
  int wrong_starts = 0;  ///< found out
};

Judged judged(const WoodAndBareGround& world) {
  LabelAgreement agreement;
  NavigatorOnMap navigator(world.drive(), {}, agreement);
  Judged judged;
  std::size_t scans = 0;
  for (const core::Event& event : world.drive().recording.events) {
    const std::optional<core::StepReport> report = navigator.take(event);
    if (!report) continue;
    judged.last_error_m = (report->pose.mean.position_m() - world.truth().at(scans++).position_m()).norm();
    const double sigma_m = std::sqrt(report->pose.covariance.topLeftCorner<2, 2>().trace());
    judged.sure_and_wrong += report->mode == core::Mode::mapping && judged.last_error_m > std::max(1.0, 4.0 * sigma_m);
    judged.sought += report->mode == core::Mode::searching;
    for (const core::Decision& decision : report->decisions) {
      judged.wrong_starts += std::holds_alternative<core::CarriedDecision>(decision);
    }
    for (const core::AssociationReport& one : report->associations) {
      EXPECT_TRUE(one.landmark == core::no_landmark || one.landmark < 70);
      EXPECT_NE(one.outcome, core::Outcome::augmented);
    }
  }
  return judged;
}

// 600 m without a landmark, by then a heading standard deviation of 14°: whatever is seen first, mostly clutter, falls in some gate. A
// pose-only EKF accepts it and is confident of a wrong place in all ten drives, for some 370 scans and to the end.
TEST(NavigatorOnMap, BelievesNoClutterAfterBareGround) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    WoodAndBareGround world(seed);
    world.go(200.0);
    world.go(60.0, core::pi);
    world.go(300.0);
    world.go(60.0, core::pi);
    world.go(150.0);
    const Judged drive = judged(world);
    EXPECT_EQ(drive.sure_and_wrong, 0) << seed;
    found += drive.last_error_m < 0.5;
  }
  EXPECT_GE(found, 9);
}

TEST(NavigatorOnMap, ForgetsAStartThatWhatIsSeenContradicts) {
  for (std::uint64_t seed = 21; seed <= 24; ++seed) {
    WoodAndBareGround world(seed);
    world.go(30.0);
    for (int lap = 0; lap < 3; ++lap) world.go(60.0, 2.0 * core::pi);
    world.begin_at(core::Pose2(9.0, -14.0, 2.0));
    const Judged drive = judged(world);
    EXPECT_LT(drive.last_error_m, 0.5) << seed;
    EXPECT_EQ(drive.wrong_starts, 1) << seed;
  }
}

// The EKF alone is confident of the wrong place until nothing has confirmed it over a reach: for 9 to 18 scans each.
TEST(NavigatorOnMap, GoesOnFromTheNavigatorsPoseAfterASlip) {
  for (std::uint64_t seed = 41; seed <= 50; ++seed) {
    WoodAndBareGround world(seed);
    world.go(60.0, 2.0 * core::pi);
    world.slip({1.4, -0.5, 0.05});
    world.go(40.0, core::pi);
    const Judged drive = judged(world);
    EXPECT_LE(drive.sure_and_wrong, 2) << seed;
    EXPECT_LT(drive.last_error_m, 0.5) << seed;
  }
}

// The navigator finds within a few scans that everything has vanished; the EKF was believed until nothing had confirmed it over a reach.
TEST(NavigatorOnMap, StopsBelievingTheOldPlaceWhereEverythingVanished) {
  int sure_and_wrong = 0, found = 0;
  for (std::uint64_t seed = 61; seed <= 70; ++seed) {
    WoodAndBareGround world(seed);
    world.go(60.0, 2.0 * core::pi);
    world.slip({-22.0, 17.0, 2.0});
    world.go(40.0, 2.0 * core::pi);
    const Judged drive = judged(world);
    sure_and_wrong += drive.sure_and_wrong;
    found += drive.last_error_m < 0.5;
  }
  EXPECT_LE(sure_and_wrong, 25);
  EXPECT_GE(found, 9);
}

TEST(NavigatorOnMap, KeepsAStartThatIsRight) {
  WoodAndBareGround world(31);
  world.go(60.0, 2.0 * core::pi);
  world.begin_at(core::Pose2());
  const Judged drive = judged(world);
  EXPECT_EQ(drive.sought, 0);
  EXPECT_EQ(drive.wrong_starts, 0);
  EXPECT_EQ(drive.sure_and_wrong, 0);
  EXPECT_LT(drive.last_error_m, 0.3);
}

}  // namespace
}  // namespace helixnav::apps
