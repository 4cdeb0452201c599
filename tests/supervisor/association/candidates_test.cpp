// SPDX-License-Identifier: BSD-3-Clause
#include "association/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/named_navigator.hpp"

namespace helixnav::supervisor {
namespace {

bool contains(const std::vector<core::LandmarkId>& ids, core::LandmarkId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Calls `check(filter, scan)` with the filter as it is when every tenth scan comes: active and passive landmarks,
/// fresh and old ones, before and after the first loop closing.
template <class Check>
void on_a_drive(double scale_of_odometry_noise, const Check& check) {
  sim::Scenario scenario = wide_circuit();
  scenario.world.circuit_landmarks = 60;
  scenario.scanner.T_robot_sensor = core::Pose2(1.5, 0.4, 0.2);
  scenario.scanner.field_of_view = {1.0, 25.0, -2.0, 1.5};
  scenario.scanner.clutter_per_scan = 1.0;
  scenario.true_noise.odometry.sigma_speed_mps *= scale_of_odometry_noise;
  scenario.true_noise.odometry.sigma_steering_rad *= scale_of_odometry_noise;
  scenario.assumed_noise = scenario.true_noise;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const core::Recording run = sim::simulate(scenario, seed);
    NamedNavigator navigator(run.start);
    drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
      core::Scan nothing_seen = scan;
      nothing_seen.observations.clear();
      navigator.observe(nothing_seen, {});  // brings the filter to where the scan was taken
      if (i % 10 == 9) check(navigator.filter(), scan);
      navigator.observe(scan, run.labels[i]);
    });
  }
}

TEST(Candidates, LoseNoLandmarkInsideTheGateOfAnyObservation) {
  const double sigmas = NavigatorOptions().candidate_sigmas;
  association::Gates gates;
  gates.new_probability = gates.match_probability;
  int gated = 0;
  int offered = 0;
  int mapped = 0;
  for (const double noise : {1.0, 4.0}) {
    on_a_drive(noise, [&](const cekf::CompressedEkf& filter, const core::Scan& scan) {
      const std::vector<core::LandmarkId> chosen = candidates(filter, scan, sigmas);
      EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
      const core::JointGaussian joint = filter.joint(filter.landmarks());
      const auto all = association::make_innovation_problem(joint, scan, gates);
      for (const association::GatedPair& pair : all.pairs) {
        ++gated;
        EXPECT_TRUE(contains(chosen, all.ids[static_cast<std::size_t>(pair.candidate)])) << "NIS " << pair.nis;
      }
      offered += static_cast<int>(chosen.size());
      mapped += filter.mapped_count();
    });
  }
  EXPECT_GT(gated, 1000);
  EXPECT_LT(offered, mapped / 2) << "the search shall be a search";
}

TEST(Candidates, OfAnEmptyScanAreNone) {
  on_a_drive(1.0, [](const cekf::CompressedEkf& filter, core::Scan scan) {
    scan.observations.clear();
    EXPECT_TRUE(candidates(filter, scan, 4.0).empty());
  });
}

TEST(Candidates, OfABearingAreAllInReach) {
  on_a_drive(1.0, [](const cekf::CompressedEkf& filter, core::Scan scan) {
    scan.observations = {core::make_bearing(0.1, 0.02)};
    const Eigen::Vector2d sensor_m = core::transform(filter.pose().mean, scan.T_robot_sensor.position_m());
    const std::vector<core::LandmarkId> chosen = candidates(filter, scan, 4.0);
    for (const core::LandmarkId id : filter.landmarks()) {
      const double range_m = (filter.landmark(id).mean_m - sensor_m).norm();
      EXPECT_EQ(contains(chosen, id), range_m <= scan.field_of_view.max_range_m) << range_m;
    }
  });
}

/// Points all along the edge of a field of view, in the sensor frame, 2 cm apart.
std::vector<Eigen::Vector2d> edge_of(const core::FieldOfView& view) {
  constexpr double step_m = 0.02;
  std::vector<Eigen::Vector2d> points;
  for (const double r : {view.min_range_m, view.max_range_m}) {
    for (double b = view.min_bearing_rad; b <= view.max_bearing_rad; b += step_m / r) {
      points.emplace_back(r * std::cos(b), r * std::sin(b));
    }
  }
  for (const double b : {view.min_bearing_rad, view.max_bearing_rad}) {
    for (double r = view.min_range_m; r <= view.max_range_m; r += step_m) {
      points.emplace_back(r * std::cos(b), r * std::sin(b));
    }
  }
  return points;
}

/// Distance of a point inside the view from its edge, negative outside.
double depth_m(const core::FieldOfView& view, const std::vector<Eigen::Vector2d>& edge, const Eigen::Vector2d& p) {
  const double bearing_rad = std::atan2(p.y(), p.x());
  const bool inside = p.norm() > view.min_range_m && p.norm() < view.max_range_m &&
                      bearing_rad > view.min_bearing_rad && bearing_rad < view.max_bearing_rad;
  if (!inside) return -1.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& e : edge) nearest_m = std::min(nearest_m, (p - e).norm());
  return nearest_m;
}

TEST(ExpectedInView, IsWhatLiesDeepEnoughInsideTheFieldOfView) {
  constexpr double margin_m = 2.0;
  std::vector<Eigen::Vector2d> edge;
  int expected_in_all = 0;
  on_a_drive(1.0, [&](const cekf::CompressedEkf& filter, const core::Scan& scan) {
    if (edge.empty()) edge = edge_of(scan.field_of_view);
    const std::vector<core::LandmarkId> expected = expected_in_view(filter, scan, margin_m);
    expected_in_all += static_cast<int>(expected.size());
    const core::Pose2 T_sensor_world = core::inverse(core::compose(filter.pose().mean, scan.T_robot_sensor));
    for (const core::LandmarkId id : filter.landmarks()) {
      const Eigen::Vector2d point_m = core::transform(T_sensor_world, filter.landmark(id).mean_m);
      const double depth = depth_m(scan.field_of_view, edge, point_m);
      // The margin at the sides is an arc of margin_m, whose chord is up to 7 % shorter at the near edge.
      const bool is_expected = contains(expected, id);
      EXPECT_TRUE(is_expected || depth < margin_m + 0.02) << depth << " at " << point_m.transpose();
      EXPECT_TRUE(!is_expected || depth > 0.92 * margin_m) << depth << " at " << point_m.transpose();
    }
  });
  EXPECT_GT(expected_in_all, 300);
}

TEST(ExpectedInView, OfASensorThatSeesAllAroundHasNoSides) {
  on_a_drive(1.0, [](const cekf::CompressedEkf& filter, core::Scan scan) {
    scan.field_of_view = {1.0, 25.0, -core::pi, core::pi};
    const Eigen::Vector2d sensor_m = core::transform(filter.pose().mean, scan.T_robot_sensor.position_m());
    const std::vector<core::LandmarkId> expected = expected_in_view(filter, scan, 2.0);
    for (const core::LandmarkId id : filter.landmarks()) {
      const double range_m = (filter.landmark(id).mean_m - sensor_m).norm();
      EXPECT_EQ(contains(expected, id), range_m > 3.0 && range_m <= 23.0) << range_m;
    }
  });
}

TEST(ExpectedInView, IsNobodyWhereTheViewIsUnknown) {
  on_a_drive(1.0, [](const cekf::CompressedEkf& filter, core::Scan scan) {
    scan.field_of_view = core::FieldOfView();
    EXPECT_TRUE(expected_in_view(filter, scan, 2.0).empty());
  });
}

}  // namespace
}  // namespace helixnav::supervisor
