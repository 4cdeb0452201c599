// SPDX-License-Identifier: BSD-3-Clause
// The drive on the atlas, against least squares over all poses of the same tape.
#include "smoothing/drive_map.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "labelled_drive.hpp"
#include "smoothing/solve_on_atlas.hpp"

namespace helixnav::supervisor {
namespace {

core::Recording circuit_of(std::uint64_t seed) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 0.5;
  return sim::simulate(scenario, seed);
}

/// Pose and landmarks to 3 cm and 0.05 rad, deviations to 2 %: phases are linearised again where they moved by 0.1 m, no sooner.
void expect_same(const core::JointGaussian& atlas, const core::JointGaussian& least_squares) {
  EXPECT_LT((atlas.pose.position_m() - least_squares.pose.position_m()).norm(), 0.03);
  EXPECT_LT(std::abs(core::wrap_to_pi(atlas.pose.heading_rad - least_squares.pose.heading_rad)), 2e-3);
  for (std::size_t i = 0; i < atlas.ids.size(); ++i) {
    EXPECT_LT((atlas.points_m[i] - least_squares.points_m[i]).norm(), 0.03);
  }
  const Eigen::VectorXd ratio =
      atlas.covariance.diagonal().cwiseQuotient(least_squares.covariance.diagonal()).cwiseSqrt();
  EXPECT_LT((ratio.array() - 1.0).abs().maxCoeff(), 0.02);
}

TEST(DriveMap, EqualsLeastSquaresOverAllPoses) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const bool strangers : {false, true}) {
      const core::Recording run = circuit_of(seed);
      LabelledDrive drive(run, strangers);
      DriveMap map(drive.start(), 20.0);
      const AtlasSolution solution = solve_on_atlas(drive.filter, drive.tape, map);
      EXPECT_TRUE(solution.accepted);
      const core::JointGaussian atlas = map.atlas().joint(drive.filter.landmarks());
      const Smoothing smoothing = drive.solve();
      ASSERT_TRUE(smoothing.solved);
      EXPECT_NEAR(solution.figures.chi2, smoothing.chi2, 0.5);
      EXPECT_NEAR(solution.figures.limit, smoothing.limit, 1e-9);
      expect_same(atlas, drive.filter.joint(atlas.ids));
      ASSERT_EQ(solution.figures.path.size(), smoothing.path.size());
      for (std::size_t k = 0; k < smoothing.path.size(); ++k) {
        EXPECT_EQ(solution.figures.path[k].t_ns, smoothing.path[k].t_ns);
        EXPECT_LT(
            (solution.figures.path[k].T_world_robot.position_m() - smoothing.path[k].T_world_robot.position_m()).norm(),
            0.05);
      }
    }
  }
}

// The tape is handed on piece by piece, and forgets what was taken in.
TEST(DriveMap, IsTheSameTakenInByPieces) {
  const core::Recording run = circuit_of(4);
  LabelledDrive drive(run, true);
  DriveMap whole(drive.start(), 20.0);
  whole.take(drive.tape, drive.filter);
  whole.settle();

  Tape tape(100000);
  DriveMap map(drive.start(), 20.0);
  int entries = 0;
  drive.tape.read_from(0, [&](const Tape::Entry& entry) {
    tape.append(entry);
    if (++entries % 97 != 0) return;
    map.take(tape, drive.filter);
    map.settle();
    tape.hand_on(map.end());
    tape.settle(tape.end());
    EXPECT_FALSE(tape.holds_drive());
    EXPECT_TRUE(tape.holds_since(map.end()));
    EXPECT_EQ(tape.stops(), 0);
  });
  map.take(tape, drive.filter);
  map.settle();
  EXPECT_NEAR(map.cost(), whole.cost(), 1e-9);
  EXPECT_EQ(map.path().size(), whole.path().size());
  const std::vector<core::LandmarkId> ids = drive.filter.landmarks();
  expect_same(map.atlas().joint(ids), whole.atlas().joint(ids));
}

// A drive that is solved anew, because its noise is known better, has a map of its own.
TEST(DriveMap, GoesOnWithWhatAnotherOfTheDriveRemembers) {
  const core::Recording run = circuit_of(5);
  LabelledDrive drive(run, false);
  DriveMap before(drive.start(), 20.0);
  before.take(drive.tape, drive.filter);
  before.settle();
  before.remember(drive.filter);
  DriveMap anew(drive.start(), 20.0);
  anew.remember(before);
  anew.take(drive.tape, drive.filter);
  anew.settle();
  for (const core::LandmarkId id : drive.filter.landmarks()) {
    EXPECT_EQ(anew.remembered(id).covariance_m2, drive.filter.landmark(id).covariance_m2) << id;
  }
}

}  // namespace
}  // namespace helixnav::supervisor
