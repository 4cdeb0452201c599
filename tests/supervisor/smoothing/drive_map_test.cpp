// SPDX-License-Identifier: BSD-3-Clause
// The drive on the atlas, taken in whole and by pieces; smooth_drive_test.cpp judges it against least squares over all poses.
#include "smoothing/drive_map.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/odometry.hpp"
#include "labelled_drive.hpp"
#include "smoothing/same_estimate.hpp"

namespace helixnav::supervisor {
namespace {

core::Recording circuit_of(std::uint64_t seed) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 0.5;
  return sim::simulate(scenario, seed);
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

// Seen twice and removed: its phase keeps what it measured, but not its name.
TEST(DriveMap, ForgetsWhatWasTakenForALandmarkInPassing) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  Tape tape(100000);
  const std::vector<double> to_left_m = {3.0, 2.0};
  for (int k = 0; k < 4; ++k) {
    core::Odometry metre = core::no_motion(k);
    metre.T_before_after.x_m = 1.0;
    metre.covariance = 0.01 * Eigen::Matrix3d::Identity();
    filter.predict(metre);
    tape.append(Tape::Motion{metre, 1.0});
    Tape::Scan entry;
    entry.scan.t_ns = k;
    for (core::LandmarkId id = 0; id < (k < 3 ? 2 : 1); ++id) {
      const Eigen::Vector2d at_m(8.0 - k, to_left_m[static_cast<std::size_t>(id)]);
      entry.scan.observations.push_back(core::make_cartesian(at_m, 0.01 * Eigen::Matrix2d::Identity()));
      if (k == 0) filter.augment(entry.scan.observations.back(), {});
      core::AssociationReport one;
      one.observation = id;
      one.landmark = id;
      one.outcome = k == 0 ? core::Outcome::augmented : core::Outcome::matched;
      entry.fate.push_back(one);
    }
    if (k == 3) entry.died = {1};
    tape.append(entry);
  }
  filter.remove(1);
  DriveMap map(core::PoseGaussian{}, 20.0);
  map.take(tape, filter);
  map.settle();
  EXPECT_TRUE(map.atlas().knows(0));
  EXPECT_FALSE(map.atlas().knows(1));
  EXPECT_EQ(map.path().size(), 4u);
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
  const std::vector<core::LandmarkId> ids = drive.filter.landmarks();
  const std::vector<core::PointGaussian> remembered = anew.remembered(ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(remembered[i].covariance_m2, drive.filter.landmark(ids[i]).covariance_m2) << ids[i];
    EXPECT_EQ(remembered[i].mean_m, anew.atlas().landmark(ids[i])) << ids[i];
  }
}

}  // namespace
}  // namespace helixnav::supervisor
