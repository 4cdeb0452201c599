// SPDX-License-Identifier: BSD-3-Clause
// A NamedNavigator whose filter holds part of the map, against one whose filter holds all of it, and against least squares.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/problem.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "smoothing/drive_phases.hpp"

namespace helixnav::supervisor {
namespace {

/// Two laps of a circle of 630 m between two rows of landmarks, seen up to 30 m away. Measurement errors are `noise`
/// times what their covariances state: with little noise all filters are linear.
class Ring {
 public:
  static constexpr double radius_m = 100.0;
  static constexpr int steps_a_lap = 314;
  static constexpr int landmarks = 200;

  explicit Ring(double noise) : noise_(noise), random_(7) {}

  core::Odometry step(int k) {
    core::Odometry odometry;
    odometry.t_ns = k * core::Nanoseconds{100'000'000};
    odometry.covariance = Eigen::Vector3d(0.05, 0.03, 0.004).cwiseAbs2().asDiagonal();
    odometry.T_before_after =
        core::Pose2(core::between(pose(k - 1), pose(k)).vector() + noise_ * random_.normal3(odometry.covariance));
    return odometry;
  }

  core::Scan look(int k, std::vector<std::int64_t>& identities) {
    core::Scan scan;
    scan.t_ns = k * core::Nanoseconds{100'000'000};
    scan.field_of_view.max_range_m = 30.0;
    identities.clear();
    for (int i = 0; i < landmarks; ++i) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(pose(k)), landmark(i));
      if (seen_m.norm() > 30.0) continue;
      core::Observation seen = core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.1, 0.01);
      seen.z[0] += noise_ * random_.normal(0.0, 0.1);
      seen.z[1] += noise_ * random_.normal(0.0, 0.01);
      scan.observations.push_back(seen);
      identities.push_back(1000 - i);
    }
    return scan;
  }

  core::AbsoluteFix fix(int k) {
    core::AbsoluteFix fix;
    fix.t_ns = k * core::Nanoseconds{100'000'000};
    fix.covariance_m2 = 0.25 * Eigen::Matrix2d::Identity();
    fix.position_world_m =
        pose(k).position_m() + noise_ * Eigen::Vector2d(random_.normal(0.0, 0.5), random_.normal(0.0, 0.5));
    return fix;
  }

  static core::Pose2 pose(int k) {
    const double angle_rad = 2.0 * core::pi * k / steps_a_lap;
    return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), angle_rad};
  }

 private:
  static Eigen::Vector2d landmark(int i) {
    const double angle_rad = 2.0 * core::pi * (i + 0.25) / landmarks;
    const double off_m = i % 2 == 0 ? -9.0 : 7.0;
    return {(radius_m + off_m) * std::sin(angle_rad), radius_m - (radius_m + off_m) * std::cos(angle_rad)};
  }

  double noise_;
  core::RandomStream random_;
};

NavigatorOptions narrow() {
  NavigatorOptions options;
  options.map.whole = 50;
  options.map.window = 40;
  options.map.most = 60;
  return options;
}

NavigatorOptions never_narrow() {
  NavigatorOptions options;
  options.map.whole = 1'000'000;
  return options;
}

double apart(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

void expect_almost_same_map(const std::vector<core::MapLandmark>& a, const std::vector<core::MapLandmark>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].observations, b[i].observations);
    EXPECT_LT((a[i].point.mean_m - b[i].point.mean_m).norm(), 1e-7) << a[i].id;
    EXPECT_LT(apart(a[i].point.covariance_m2, b[i].point.covariance_m2), 1e-4) << a[i].id;
  }
}

// The covariances softened by the atlas, and linearisation points about 0.1 mm apart, make up 1e-5 of the covariances.
TEST(NamedWindow, IsTheFilterOfTheWholeMapWhereAllIsLinear) {
  Ring ring(1e-4);
  NamedNavigator window(core::PoseGaussian{}, narrow());
  NamedNavigator whole(core::PoseGaussian{}, never_narrow());
  int hand_overs = 0;
  std::vector<std::int64_t> identities;
  for (int k = 0; k <= 2 * Ring::steps_a_lap; ++k) {
    const core::Odometry odometry = ring.step(k);
    const core::Scan scan = ring.look(k, identities);
    const core::AbsoluteFix fix = ring.fix(k);
    const int held = window.filter().mapped_count();
    for (NamedNavigator* navigator : {&window, &whole}) {
      if (k > 0) navigator->move(odometry);
      if (k % 200 == 150) {
        EXPECT_TRUE(navigator->fix(fix));
      }
    }
    const core::StepReport a = window.observe(scan, identities);
    const core::StepReport b = whole.observe(scan, identities);
    hand_overs += window.filter().mapped_count() < held || window.filter().mapped_count() > held + 20 ? 1 : 0;
    ASSERT_LT((a.pose.mean.vector() - b.pose.mean.vector()).norm(), 1e-7) << k;
    ASSERT_LE((a.pose.covariance - b.pose.covariance).norm(), 1e-4 * b.pose.covariance.norm()) << k;
    ASSERT_EQ(a.mapped_landmarks, b.mapped_landmarks);
    if (a.joint_dof > 0) {
      EXPECT_NEAR(a.joint_nis, b.joint_nis, 1e-3 * b.joint_nis);
    }
    ASSERT_EQ(a.associations.size(), b.associations.size());
    for (std::size_t i = 0; i < a.associations.size(); ++i) {
      ASSERT_EQ(a.associations[i].outcome, b.associations[i].outcome);
      ASSERT_EQ(a.associations[i].landmark, b.associations[i].landmark);
    }
  }
  EXPECT_GE(hand_overs, 10);
  EXPECT_EQ(whole.filter().mapped_count(), Ring::landmarks);
  EXPECT_LT(window.filter().mapped_count(), 100);
  expect_almost_same_map(window.map(), whole.map());
  const core::JointGaussian a = window.joint({190, 3, 77, 120});
  const core::JointGaussian b = whole.joint({190, 3, 77, 120});
  EXPECT_EQ(a.ids, b.ids);
  EXPECT_LT(apart(a.covariance, b.covariance), 1e-4);
}

TEST(NamedWindow, SketchesWhatTheFilterLeftOutAsItWasLeft) {
  Ring ring(1.0);
  NamedNavigator window(core::PoseGaussian{}, narrow());
  std::vector<std::int64_t> identities;
  for (int k = 0; k < 200; ++k) {
    if (k > 0) window.move(ring.step(k));
    const core::Scan scan = ring.look(k, identities);
    window.observe(scan, identities);
  }
  const std::vector<core::MapLandmark> map = window.map();
  const std::vector<core::MapLandmark> sketch = window.sketch();
  ASSERT_EQ(sketch.size(), map.size());
  ASSERT_GT(static_cast<int>(map.size()), window.filter().mapped_count() + 10);
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_EQ(sketch[i].id, map[i].id);
    EXPECT_LT((sketch[i].point.mean_m - map[i].point.mean_m).norm(), 0.05);
    EXPECT_LT(apart(sketch[i].point.covariance_m2, map[i].point.covariance_m2), 0.2);
  }
}

// With noise as large as modelled, the filter of the whole map is off by its linearisations; the atlas is at the optimum.
TEST(NamedWindow, MapIsThatOfLeastSquaresOverAllPoses) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  NavigatorOptions options = narrow();
  options.map.whole = options.map.window = 8;
  options.map.most = 10;
  NamedNavigator window(run.start, options);
  drive(run, window, [&](const core::Scan& scan, std::size_t i) { window.observe(scan, run.labels[i]); });
  EXPECT_LT(window.filter().mapped_count(), 20);
  smoothing::Problem problem = smoothing::build_problem(run.events, run.labels);
  smoothing::soften_odometry(problem, softening());
  const Eigen::Matrix3d certain = softening().cwiseAbs2().asDiagonal();
  problem.pose_priors.push_back({0, run.start.mean, run.start.covariance + certain});
  smoothing::optimize(problem);
  std::size_t found = 0;
  const std::vector<core::MapLandmark> map = window.map();
  for (const core::LandmarkGraph::Landmark& landmark : problem.graph.landmarks) {
    for (const core::MapLandmark& mapped : map) {
      if ((mapped.point.mean_m - landmark.point_m).norm() < 5e-3) ++found;
    }
  }
  EXPECT_EQ(found, problem.graph.landmarks.size());
  EXPECT_EQ(map.size(), problem.graph.landmarks.size());
}

// A landmark that the window has left out comes into view by range alone: it is known, so the filter begins anew with
// it. A landmark not yet known has no phase that determines it, and is left out.
TEST(NamedWindow, TakesRangesOfKnownLandmarksAndLeavesOutThoseOfNewOnes) {
  Ring ring(0.1);
  NamedNavigator window(core::PoseGaussian{}, narrow());
  std::vector<std::int64_t> identities;
  for (int k = 0; k < Ring::steps_a_lap; ++k) {
    if (k > 0) window.move(ring.step(k));
    const core::Scan scan = ring.look(k, identities);
    window.observe(scan, identities);
  }
  const int mapped = window.filter().mapped_count();
  window.move(ring.step(Ring::steps_a_lap));
  core::Scan scan = ring.look(Ring::steps_a_lap, identities);
  for (core::Observation& seen : scan.observations) seen = core::make_range(seen.z[0], 0.1);
  identities.back() = 5000;
  const core::StepReport report = window.observe(scan, identities);
  for (std::size_t i = 0; i + 1 < identities.size(); ++i) {
    EXPECT_EQ(report.associations[i].outcome, core::Outcome::matched);
  }
  EXPECT_EQ(report.associations.back().outcome, core::Outcome::ambiguous);
  EXPECT_LE(window.filter().mapped_count(), mapped + static_cast<int>(identities.size()));
}

TEST(NamedWindow, ADriveThatBeganWithRangesAloneKeepsOneFilter) {
  Ring ring(0.1);
  NamedNavigator navigator(core::PoseGaussian{}, narrow());
  std::vector<std::int64_t> identities;
  for (int k = 0; k < 150; ++k) {
    if (k > 0) navigator.move(ring.step(k));
    core::Scan scan = ring.look(k, identities);
    if (k == 3) scan.observations[0] = core::make_range(scan.observations[0].z[0], 0.1);
    navigator.observe(scan, identities);
  }
  EXPECT_EQ(navigator.filter().mapped_count(), static_cast<int>(navigator.map().size()));
  EXPECT_GT(navigator.filter().mapped_count(), 80);
}

}  // namespace
}  // namespace helixnav::supervisor
