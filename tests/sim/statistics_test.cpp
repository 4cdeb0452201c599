// SPDX-License-Identifier: BSD-3-Clause
// What the simulator's sensors do on average. Seeds are fixed; bands are five sigma, which a correct simulator with
// a fresh seed would leave with probability 6e-7 each.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/sim/simulate.hpp"
#include "recordings.hpp"

namespace helixnav::sim {
namespace {

using testing::events_of;

constexpr double five_sigma = 5.0;

bool stands(const Tree& tree, double along_m) { return tree.present.from_m <= along_m && along_m < tree.present.to_m; }

/// Trees well inside the field of view at a scan, where noise and the edge cannot be confused.
std::vector<core::Label> surely_visible(const World& world, const core::Scan& scan, const core::Pose2& T_world_robot) {
  const core::FieldOfView& view = scan.field_of_view;
  const core::Pose2 T_sensor_world = core::inverse(core::compose(T_world_robot, scan.T_robot_sensor));
  std::vector<core::Label> labels;
  for (std::size_t i = 0; i < world.trees.size(); ++i) {
    const Eigen::Vector2d p = core::transform(T_sensor_world, world.trees[i].point_m);
    const double bearing_rad = std::atan2(p.y(), p.x());
    if (stands(world.trees[i], 0.0) && p.norm() > view.min_range_m + 1e-6 && p.norm() < view.max_range_m - 1e-6 &&
        bearing_rad > view.min_bearing_rad + 1e-6 && bearing_rad < view.max_bearing_rad - 1e-6) {
      labels.push_back(static_cast<core::Label>(i));
    }
  }
  return labels;
}

TEST(Statistics, VisibleTreesAreDetectedWithTheirProbability) {
  const Scenario scenario = named_scenario("large-loop");
  int visible = 0, detected = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const World world = build_world(scenario.world, seed);
    const core::Recording run = simulate_in(world, scenario, seed);
    const auto scans = events_of<core::Scan>(run);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      for (const core::Label label : surely_visible(world, scans[i], run.true_poses[i].T_world_robot)) {
        ++visible;
        detected += static_cast<int>(std::count(run.labels[i].begin(), run.labels[i].end(), label));
      }
    }
  }
  const double p = scenario.scanner.detection_probability;
  ASSERT_GT(visible, 10000);
  EXPECT_NEAR(detected, p * visible, five_sigma * std::sqrt(p * (1.0 - p) * visible));
}

TEST(Statistics, ClutterIsPoissonAndUniformOverTheAreaOfTheFieldOfView) {
  const Scenario scenario = named_scenario("sparse");
  double scans_seen = 0.0, clutter = 0.0, squares = 0.0;
  std::vector<double> area_shares, bearing_shares;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const core::Recording run = simulate(scenario, seed);
    const auto scans = events_of<core::Scan>(run);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      double here = 0.0;
      const core::FieldOfView& v = scans[i].field_of_view;
      for (std::size_t j = 0; j < run.labels[i].size(); ++j) {
        if (run.labels[i][j] != core::no_label) continue;
        const core::ObsVector& z = scans[i].observations[j].z;
        area_shares.push_back((z[0] * z[0] - v.min_range_m * v.min_range_m) /
                              (v.max_range_m * v.max_range_m - v.min_range_m * v.min_range_m));
        bearing_shares.push_back((z[1] - v.min_bearing_rad) / (v.max_bearing_rad - v.min_bearing_rad));
        here += 1.0;
      }
      scans_seen += 1.0;
      clutter += here;
      squares += (here - scenario.scanner.clutter_per_scan) * (here - scenario.scanner.clutter_per_scan);
    }
  }
  const double mu = scenario.scanner.clutter_per_scan;
  EXPECT_NEAR(clutter, mu * scans_seen, five_sigma * std::sqrt(mu * scans_seen));
  EXPECT_NEAR(squares / scans_seen, mu, five_sigma * std::sqrt((mu + 2.0 * mu * mu) / scans_seen));
  for (std::vector<double>* shares : {&area_shares, &bearing_shares}) {
    std::sort(shares->begin(), shares->end());
    const auto n = static_cast<double>(shares->size());
    double distance = 0.0;
    for (std::size_t i = 0; i < shares->size(); ++i) {
      distance = std::max(distance, std::abs((*shares)[i] - (static_cast<double>(i) + 0.5) / n) + 0.5 / n);
    }
    EXPECT_LT(std::sqrt(n) * distance, 2.6936);  // Kolmogorov-Smirnov, false alarm 1e-6
  }
}

/// χ² of ranges and of bearings separately, at the landmarks' labels.
TEST(Statistics, RangeAndBearingNoiseHaveTheirSigmas) {
  for (const std::string name : {"large-loop", "circuit-large-noise"}) {
    double n = 0.0, chi2_range = 0.0, chi2_bearing = 0.0, cross = 0.0, sum_range = 0.0, sum_bearing = 0.0;
    const Scenario scenario = named_scenario(name);
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const core::Recording run = simulate(scenario, seed);
      const auto scans = events_of<core::Scan>(run);
      for (std::size_t i = 0; i < scans.size(); ++i) {
        for (std::size_t j = 0; j < run.labels[i].size(); ++j) {
          if (run.labels[i][j] == core::no_label) continue;
          const core::Observation& o = scans[i].observations[j];
          const auto& landmark = run.true_landmarks[static_cast<std::size_t>(run.labels[i][j])];
          const core::ObsVector nu =
              core::innovation(o.kind, o.z,
                               core::predict_observation(o.kind, run.true_poses[i].T_world_robot,
                                                         scans[i].T_robot_sensor, landmark.point_m)
                                   .z_hat);
          const double r = nu[0] / std::sqrt(o.R(0, 0)), b = nu[1] / std::sqrt(o.R(1, 1));
          n += 1.0;
          chi2_range += r * r;
          chi2_bearing += b * b;
          cross += r * b;
          sum_range += r;
          sum_bearing += b;
        }
      }
    }
    ASSERT_GT(n, 5000.0);
    EXPECT_NEAR(chi2_range, n, five_sigma * std::sqrt(2.0 * n)) << name;
    EXPECT_NEAR(chi2_bearing, n, five_sigma * std::sqrt(2.0 * n)) << name;
    EXPECT_NEAR(cross, 0.0, five_sigma * std::sqrt(n)) << name;
    EXPECT_NEAR(sum_range, 0.0, five_sigma * std::sqrt(n)) << name;
    EXPECT_NEAR(sum_bearing, 0.0, five_sigma * std::sqrt(n)) << name;
  }
}

/// Sums over scans of eᵀΣ⁻¹e, e = true increment minus chained odometry: χ² with 3 degrees of freedom a scan, and 2 for
/// (x, heading) alone, which also exists if one sample a scan leaves Σ with rank two.
struct OdometryNees {
  double pose = 0.0;
  double x_heading = 0.0;
  int scans = 0;

  void add(const core::Odometry& measured, const core::Pose2& truth) {
    Eigen::Vector3d e = truth.vector() - measured.T_before_after.vector();
    e[2] = core::wrap_to_pi(e[2]);
    const Eigen::Matrix3d& C = measured.covariance;
    pose += e.dot(C.ldlt().solve(e));
    Eigen::Matrix2d C_x_heading;
    C_x_heading << C(0, 0), C(0, 2), C(2, 0), C(2, 2);
    const Eigen::Vector2d e_x_heading(e[0], e[2]);
    x_heading += e_x_heading.dot(C_x_heading.ldlt().solve(e_x_heading));
    ++scans;
  }
};

OdometryNees odometry_nees(const Scenario& scenario, std::uint64_t seeds) {
  OdometryNees nees;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const core::Recording run = simulate(scenario, seed);
    core::Odometry chained = core::no_motion(0);
    std::size_t scan = 0;
    for (const core::Event& event : run.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
        chained = core::chain(chained, *odometry);
        continue;
      }
      if (scan > 0) {
        nees.add(chained, core::between(run.true_poses[scan - 1].T_world_robot, run.true_poses[scan].T_world_robot));
      }
      chained = core::no_motion(0);
      ++scan;
    }
  }
  return nees;
}

void expect_chi2(double sum, int dof, const std::string& what) {
  constexpr double one_side = 0.5e-4;  // two-sided band, false alarm 1e-4
  EXPECT_GT(sum, core::chi2_quantile(one_side, dof)) << what;
  EXPECT_LT(sum, core::chi2_quantile(1.0 - one_side, dof)) << what;
}

TEST(Statistics, OdometryErrorsHaveTheCovarianceThatIsTold) {
  const OdometryNees nees = odometry_nees(named_scenario("large-loop"), 4);
  ASSERT_GT(nees.scans, 1500);
  expect_chi2(nees.pose, 3 * nees.scans, "large-loop");
}

/// If the speed noise is a large share of the speed, the model's first order shows in the (tiny) lateral error given
/// the other two: 3-dof NEES is 1 % (large-loop), 3 % (big-drift), 9 % (orchard) too high over 20 seeds.
TEST(Statistics, OdometryErrorsInXAndHeadingHaveTheCovarianceThatIsToldAlsoWhenTheyAreLarge) {
  for (const std::string name : {"big-drift", "orchard", "circuit", "circuit-large-noise"}) {
    const OdometryNees nees = odometry_nees(named_scenario(name), 3);
    ASSERT_GT(nees.scans, 1500);
    expect_chi2(nees.x_heading, 2 * nees.scans, name);
  }
}

/// About 2000 degrees of freedom: the bands are four sigma wide.
TEST(Statistics, OdometryThatClaimsHalfOrTwiceItsNoiseIsFoundOut) {
  const OdometryNees half = odometry_nees(named_scenario("assumed-noise-half"), 2);
  const OdometryNees twice = odometry_nees(named_scenario("assumed-noise-double"), 2);
  EXPECT_NEAR(half.x_heading / (2.0 * half.scans), 4.0, 0.5);
  EXPECT_NEAR(twice.x_heading / (2.0 * twice.scans), 0.25, 0.03);
}

core::Pose2 dead_reckon(const core::Recording& run, std::size_t from_scan, std::size_t to_scan) {
  core::Pose2 T_world_robot = run.true_poses[from_scan].T_world_robot;
  for (const core::Odometry& odometry : events_of<core::Odometry>(run)) {
    if (odometry.t_ns <= run.true_poses[from_scan].t_ns || odometry.t_ns > run.true_poses[to_scan].t_ns) continue;
    T_world_robot = core::compose(T_world_robot, odometry.T_before_after);
  }
  return T_world_robot;
}

/// The scan at which the vehicle is back: nearest to the start in the last third of the drive that closes the loop.
std::size_t scan_of_return(const core::Recording& run, const World& world) {
  const auto about = static_cast<std::size_t>(world.returns_at_m[0] / 1.5);
  std::size_t nearest = about;
  for (std::size_t i = about - 10; i < about + 10; ++i) {
    if (run.true_poses[i].T_world_robot.position_m().norm() <
        run.true_poses[nearest].T_world_robot.position_m().norm()) {
      nearest = i;
    }
  }
  return nearest;
}

/// Dead reckoning over the whole loop, and over its bare stretch alone, in 50 seeds. The first share is 0.90 over 600
/// seeds (fresh ones would give fewer than 41 with probability 2 %). Over 195 m heading noise alone spreads the position
/// sideways by 13.4 m (1 sigma), so that the median is 9 m; its band is 1e-3 two-sided.
TEST(Statistics, AtTheReturnDeadReckoningIsOffByMoreThanTheSpacingOfTheTrees) {
  const Scenario scenario = named_scenario("large-loop");
  constexpr double spacing_m = 8.0;
  int beyond = 0;
  std::vector<double> bare_error_m;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const World world = build_world(scenario.world, seed);
    const core::Recording run = simulate_in(world, scenario, seed);
    const std::size_t back = scan_of_return(run, world);
    const Eigen::Vector2d truth_m = run.true_poses[back].T_world_robot.position_m();
    beyond += (dead_reckon(run, 0, back).position_m() - truth_m).norm() > spacing_m ? 1 : 0;
    const std::size_t bare_scans = 130;  // 195 m
    bare_error_m.push_back((dead_reckon(run, back - bare_scans, back).position_m() - truth_m).norm());
  }
  EXPECT_GE(beyond, 41);
  std::sort(bare_error_m.begin(), bare_error_m.end());
  EXPECT_GT(bare_error_m[25], 4.2);
  EXPECT_LT(bare_error_m[25], 14.0);
}

}  // namespace
}  // namespace helixnav::sim
