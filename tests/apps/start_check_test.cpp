// SPDX-License-Identifier: BSD-3-Clause
// A start that is wrong by one row, in orchards whose trees do not stand quite regularly.
#include "drive/start_check.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "drive/navigator_on_map.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "sanitized.hpp"

namespace helixnav::apps {
namespace {

constexpr double orchard_pitch_m = 5.0;
constexpr double orchard_view_m = 15.0;

class JitteredOrchard {
 public:
  JitteredOrchard(std::uint64_t seed, const core::Pose2& start_error) : random_(seed, "orchard") {
    GivenMap map;
    for (int i = 0; i < 196; ++i) {
      core::MapLandmark& tree = map.landmarks.emplace_back();
      tree.id = i;
      const double jitter_x_m = random_.normal(0.0, 0.25), jitter_y_m = random_.normal(0.0, 0.25);
      tree.point.mean_m = {orchard_pitch_m * (i % 14) - 35.0 + jitter_x_m,
                           orchard_pitch_m * (i / 14) - 35.0 + jitter_y_m};
      tree.state = core::LandmarkState::mature;
    }
    drive_.given_map = map;
    T_map_robot_ = core::Pose2(-2.0, 7.0, 0.4);
    drive_.given_map->start = SessionStart{SessionStart::Kind::pose, core::compose(start_error, T_map_robot_)};
    scan();
    for (int k = 0; k < 60; ++k) step();
  }

  const Drive& drive() const { return drive_; }
  const core::Pose2& truth_at_end() const { return T_map_robot_; }

 private:
  void step() {
    t_ns_ += 500000000;
    const core::Pose2 moved(0.8, 0.0, 0.06);
    T_map_robot_ = core::compose(T_map_robot_, moved);
    core::Odometry odometry;
    odometry.t_ns = t_ns_;
    const Eigen::Vector3d sigma(0.02, 0.005, 0.005);
    Eigen::Vector3d noisy = moved.vector();
    for (int i = 0; i < 3; ++i) noisy(i) += random_.normal(0.0, sigma(i));
    odometry.T_before_after = core::Pose2(noisy);
    odometry.covariance = sigma.cwiseAbs2().asDiagonal();
    drive_.recording.events.emplace_back(odometry);
    scan();
  }

  void scan() {
    core::Scan scan;
    scan.t_ns = t_ns_;
    scan.field_of_view = {0.0, orchard_view_m, -core::pi, core::pi};
    const core::Pose2 T_robot_map = core::inverse(T_map_robot_);
    for (const core::MapLandmark& tree : drive_.given_map->landmarks) {
      const Eigen::Vector2d point_m = core::transform(T_robot_map, tree.point.mean_m);
      if (point_m.norm() < 0.5 || point_m.norm() > orchard_view_m || random_.uniform() > 0.9) continue;
      const double range_m = point_m.norm() + random_.normal(0.0, 0.05);
      const double bearing_rad = std::atan2(point_m.y(), point_m.x()) + random_.normal(0.0, 0.005);
      scan.observations.push_back(core::make_range_bearing(range_m, bearing_rad, 0.05, 0.005));
    }
    drive_.recording.events.emplace_back(scan);
  }

  core::RandomStream random_;
  Drive drive_;
  core::Pose2 T_map_robot_;
  core::Nanoseconds t_ns_ = 0;
};

struct LocalisedFromStart {
  double error_at_end_m = 0.0;
  int wrong_starts = 0;
  int scans_before = 0;  ///< of the start that was wrong
};

LocalisedFromStart localised_from_start(const JitteredOrchard& orchard) {
  LabelAgreement agreement;
  NavigatorOnMap navigator(orchard.drive(), {}, agreement);
  LocalisedFromStart result;
  for (const core::Event& event : orchard.drive().recording.events) {
    const std::optional<core::StepReport> report = navigator.take(event);
    if (!report) continue;
    for (const core::Decision& decision : report->decisions) {
      const auto* carried = std::get_if<core::CarriedDecision>(&decision);
      if (carried == nullptr) continue;
      EXPECT_EQ(carried->cause, core::CarriedDecision::Cause::wrong_start);
      EXPECT_EQ(carried->scans, static_cast<int>(report->step));
      ++result.wrong_starts;
    }
  }
  result.error_at_end_m = (navigator.pose().mean.position_m() - orchard.truth_at_end().position_m()).norm();
  return result;
}

TEST(StartCheck, FindsOutAStartThatIsWrongByOneRow) {
  for (std::uint64_t seed = 1; seed <= (support::sanitized ? 1 : 2); ++seed) {
    for (const core::Pose2& error : {core::Pose2(orchard_pitch_m, 0.0, 0.0), core::Pose2(0.0, -orchard_pitch_m, 0.0)}) {
      const LocalisedFromStart run = localised_from_start(JitteredOrchard(seed, error));
      EXPECT_EQ(run.wrong_starts, 1) << seed;
      EXPECT_LT(run.error_at_end_m, 0.3) << seed;
    }
  }
}

TEST(StartCheck, KeepsAStartThatIsRight) {
  for (std::uint64_t seed = 11; seed <= (support::sanitized ? 11 : 14); ++seed) {
    const LocalisedFromStart run = localised_from_start(JitteredOrchard(seed, core::Pose2(0.3, -0.2, 0.02)));
    EXPECT_EQ(run.wrong_starts, 0) << seed;
    EXPECT_LT(run.error_at_end_m, 0.3) << seed;
  }
}

}  // namespace
}  // namespace helixnav::apps
