// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/delayed_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "campaign.hpp"
#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/named_navigator.hpp"

namespace helixnav::supervisor {
namespace {

using core::ObservationKind;

/// What remains of a scan if the sensor measures one quantity and sees only `landmarks` landmarks.
struct Reduced {
  core::Scan scan;
  std::vector<std::int64_t> identities;
};

Reduced reduced(const core::Scan& scan, const std::vector<core::Label>& labels, ObservationKind kind, int landmarks) {
  Reduced kept;
  kept.scan = scan;
  kept.scan.observations.clear();
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0 || labels[i] >= landmarks) continue;
    const core::Observation& o = scan.observations[i];
    kept.scan.observations.push_back(kind == ObservationKind::range ? core::make_range(o.z[0], std::sqrt(o.R(0, 0)))
                                                                    : core::make_bearing(o.z[1], std::sqrt(o.R(1, 1))));
    kept.identities.push_back(labels[i]);
  }
  return kept;
}

/// Landmarks as they enter in a lap, over 60 seeds: eᵀP⁻¹e of the first of each run (independent of each other).
struct Entrances {
  std::vector<double> first_nees;
  int entered = 0;
  double worst_error_m = 0.0;
};

Entrances entrances(ObservationKind kind) {
  constexpr int landmarks = 4;
  Entrances seen;
  for (const std::uint64_t seed : support::campaign_seeds(1, 60)) {
    const core::Recording run = sim::simulate(wide_circuit(), seed);
    NamedNavigator navigator(run.start);
    bool first = true;
    drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
      if (i > 200) return;
      const Reduced kept = reduced(scan, run.labels[i], kind, landmarks);
      const core::StepReport report = navigator.observe(kept.scan, kept.identities);
      for (const core::AssociationReport& association : report.associations) {
        if (association.outcome != core::Outcome::augmented) continue;
        const core::PointGaussian landmark = navigator.filter().landmark(association.landmark);
        const auto label = static_cast<std::size_t>(kept.identities[static_cast<std::size_t>(association.observation)]);
        const Eigen::Vector2d error_m = landmark.mean_m - run.true_landmarks[label].point_m;
        if (first) seen.first_nees.push_back(error_m.dot(landmark.covariance_m2.inverse() * error_m));
        first = false;
        seen.worst_error_m = std::max(seen.worst_error_m, error_m.norm());
        ++seen.entered;
      }
      EXPECT_EQ(report.mapped_landmarks, static_cast<int>(navigator.map().size()));
    });
  }
  return seen;
}

/// The mean of n values of χ²₂ is inside with probability 0.998.
void expect_consistent(const std::vector<double>& nees) {
  ASSERT_FALSE(nees.empty());
  const int runs = static_cast<int>(nees.size());
  double sum = 0.0;
  for (const double value : nees) sum += value;
  const support::Band band = support::chi2_band(runs, 2, 0.002);
  EXPECT_GT(sum, band.low) << "mean " << sum / runs;
  EXPECT_LT(sum, band.high) << "mean " << sum / runs;
}

TEST(DelayedLandmarksCampaign, SeenAsRangesEnterInsideTheirEllipse) {
  const Entrances seen = entrances(ObservationKind::range);
  if (support::whole_campaign) {
    EXPECT_GE(seen.first_nees.size(), 55u);
  }
  EXPECT_LT(seen.worst_error_m, 20.0) << "15 m are the drift of the worst run; mirror images gave 30 to 70 m";
  expect_consistent(seen.first_nees);
}

TEST(DelayedLandmarksCampaign, SeenAsBearingsEnterInsideTheirEllipse) {
  const Entrances seen = entrances(ObservationKind::bearing);
  if (support::whole_campaign) {
    EXPECT_GE(seen.first_nees.size(), 55u);
  }
  expect_consistent(seen.first_nees);
}

TEST(DelayedLandmarks, WaitOnAStraightPathUntilATurnTellsTheMirrorImageFromTheLandmark) {
  const Eigen::Vector2d landmark_m(25.0, 15.0);
  NamedNavigator navigator(core::PoseGaussian{});
  core::Pose2 truth;
  bool entered = false;
  for (int i = 0; i < 90; ++i) {
    core::Odometry odometry = core::no_motion(i);
    odometry.T_before_after = core::Pose2(1.0, 0.0, i >= 50 ? 0.03 : 0.0);
    odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-8).asDiagonal();
    truth = core::compose(truth, odometry.T_before_after);
    navigator.move(odometry);
    core::Scan scan;
    scan.observations.push_back(core::make_range((landmark_m - truth.position_m()).norm(), 0.1));
    const core::StepReport report = navigator.observe(scan, {7});
    if (report.associations[0].outcome == core::Outcome::augmented) {
      EXPECT_GT(i, 50);
      entered = true;
    }
  }
  ASSERT_TRUE(entered);
  ASSERT_EQ(navigator.map().size(), 1u);
  EXPECT_LT((navigator.map()[0].point.mean_m - landmark_m).norm(), 0.5);
}

/// The first sighting is of something 60° off: the landmark is what all the others agree on.
TEST(DelayedLandmarks, EnterWithoutTheOneSightingThatBoreAnothersName) {
  const Eigen::Vector2d landmark_m(12.0, 9.0);
  for (const bool is_first_wrong : {false, true}) {
    NamedNavigator navigator(core::PoseGaussian{});
    core::Pose2 truth;
    for (int i = 0; i < 25; ++i) {
      core::Odometry odometry = core::no_motion(i);
      odometry.T_before_after = core::Pose2(1.0, 0.0, 0.02);
      odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-8).asDiagonal();
      truth = core::compose(truth, odometry.T_before_after);
      navigator.move(odometry);
      const Eigen::Vector2d seen_m = core::transform(core::inverse(truth), landmark_m);
      const double aside_rad = is_first_wrong && i == 0 ? core::pi / 3.0 : 0.0;
      core::Scan scan;
      scan.observations.push_back(core::make_bearing(std::atan2(seen_m.y(), seen_m.x()) - aside_rad, 0.01));
      navigator.observe(scan, {7});
    }
    ASSERT_EQ(navigator.map().size(), 1u) << is_first_wrong;
    EXPECT_LT((navigator.map()[0].point.mean_m - landmark_m).norm(), 0.5) << is_first_wrong;
  }
}

core::Odometry a_metre_ahead(core::Nanoseconds t_ns) {
  core::Odometry odometry = core::no_motion(t_ns);
  odometry.T_before_after = core::Pose2(1.0, 0.0, 0.0);
  odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-8).asDiagonal();
  return odometry;
}

TEST(DelayedLandmarks, KeepNoMoreClonesThanTheWindowHowEverLongTheyWait) {
  cekf::CompressedEkf filter(core::PoseGaussian{});
  DelayedOptions options;
  options.window = 8;
  DelayedLandmarks delayed(options);
  for (int i = 0; i < 200; ++i) {
    filter.predict(a_metre_ahead(i));
    const double range_m = std::hypot(100.0 - (i + 1.0), 40.0);
    EXPECT_FALSE(delayed.sight(filter, {{1, core::make_range(range_m, 0.1)}}, {})[0].has_value());
    EXPECT_LE(delayed.clones(), 8);
    EXPECT_EQ(filter.mapped_count(), delayed.clones());
  }
}

/// New names all the time, none of which is seen often enough.
TEST(DelayedLandmarks, KeepAFewTimesTheWindowHowEverManyWait) {
  cekf::CompressedEkf filter(core::PoseGaussian{});
  DelayedOptions options;
  options.window = 6;
  DelayedLandmarks delayed(options);
  for (int i = 0; i < 300; ++i) {
    filter.predict(a_metre_ahead(i));
    delayed.sight(filter, {{i / 3, core::make_bearing(0.3, 0.01)}}, {});
    EXPECT_LE(delayed.clones(), 2 * 4 * 6);
    EXPECT_EQ(filter.mapped_count(), delayed.clones());
  }
}

TEST(DelayedLandmarks, RefuseAnIdentityTwiceAndWhatNeedsNoDelay) {
  cekf::CompressedEkf filter(core::PoseGaussian{});
  DelayedLandmarks delayed;
  const core::Observation bearing = core::make_bearing(0.1, 0.01);
  EXPECT_THROW(delayed.sight(filter, {{1, bearing}, {1, bearing}}, {}), core::PreconditionError);
  EXPECT_THROW(delayed.sight(filter, {{1, core::make_range_bearing(1.0, 0.0, 0.1, 0.1)}}, {}), core::PreconditionError);
  EXPECT_EQ(filter.mapped_count(), 0);
}

/// Wheels that lose 1.2° in a second, and a camera that sees 60° to either side: while one landmark passes, the heading
/// drifts by as much as its bearing changes, and no landmark is determined by its own sightings.
struct PoorWheels {
  int begun = 0;
  double error_m = 0.0;
  double nees = 0.0;
};

PoorWheels drive_on_poor_wheels(std::uint64_t seed) {
  core::RandomStream random(seed, "poor wheels");
  std::vector<Eigen::Vector2d> landmarks_m;
  for (int k = 0; k < 40; ++k) {
    const double x_m = 20.0 + 45.0 * (2.0 * random.uniform() - 1.0);
    const double y_m = 12.0 + 35.0 * (2.0 * random.uniform() - 1.0);
    landmarks_m.emplace_back(x_m, y_m);
  }
  NamedNavigator navigator(core::PoseGaussian{});
  core::Pose2 truth;
  for (int i = 0; i < 400; ++i) {
    core::Odometry odometry = core::no_motion(i);
    odometry.T_before_after = core::Pose2(0.4, 0.0, (i / 25) % 2 == 1 ? 2.0 * core::pi / 100.0 : 0.0);
    odometry.covariance = Eigen::Vector3d(1e-5, 1e-8, 1.1e-4).asDiagonal();
    core::Pose2 noise;
    noise.x_m = std::sqrt(1e-5) * random.normal();
    noise.y_m = std::sqrt(1e-8) * random.normal();
    noise.heading_rad = std::sqrt(1.1e-4) * random.normal();
    truth = core::compose(truth, core::compose(odometry.T_before_after, noise));
    navigator.move(odometry);
    core::Scan scan;
    scan.field_of_view = {0.0, 40.0, -core::pi / 3.0, core::pi / 3.0};
    std::vector<std::int64_t> identities;
    for (std::size_t k = 0; k < landmarks_m.size(); ++k) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(truth), landmarks_m[k]);
      const double bearing_rad = std::atan2(seen_m.y(), seen_m.x());
      if (seen_m.norm() > 40.0 || std::abs(bearing_rad) > core::pi / 3.0) continue;
      scan.observations.push_back(core::make_bearing(bearing_rad + 0.02 * random.normal(), 0.02));
      identities.push_back(static_cast<std::int64_t>(k));
    }
    navigator.observe(scan, identities);
  }
  const core::PoseGaussian pose = navigator.pose();
  Eigen::Vector3d error = pose.mean.vector() - truth.vector();
  error[2] = core::wrap_to_pi(error[2]);
  return {static_cast<int>(navigator.map().size()), error.head<2>().norm(),
          error.dot(pose.covariance.llt().solve(error))};
}

TEST(DelayedLandmarksCampaign, HelpEachOtherWhereNoneIsDeterminedAlone) {
  int runs = 0;
  int begun = 0;
  double nees = 0.0;
  double worst_error_m = 0.0;
  for (const std::uint64_t seed : support::campaign_seeds(1, 40)) {
    const PoorWheels end = drive_on_poor_wheels(seed);
    ++runs;
    begun += end.begun;
    nees += end.nees;
    worst_error_m = std::max(worst_error_m, end.error_m);
  }
  EXPECT_GE(begun, 10 * runs) << "3.6 landmarks a run, and 6.5 m off, where each waits for its own sightings (16 runs)";
  EXPECT_LT(worst_error_m, 3.0);
  const support::Band band = support::chi2_band(runs, 3, 0.002);
  EXPECT_GT(nees, band.low) << "mean " << nees / runs;
  EXPECT_LT(nees, band.high) << "mean " << nees / runs;
}

}  // namespace
}  // namespace helixnav::supervisor
