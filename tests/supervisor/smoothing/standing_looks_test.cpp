// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/standing_looks.hpp"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double phase_m = 20.0;  // the vehicle stands within 0.05 m

Stop stop_after(double forward_m, const std::vector<core::LandmarkId>& seen) {
  Stop stop;
  stop.motion = core::no_motion(0);
  stop.motion->T_before_after = core::Pose2(forward_m, 0.0, 0.0);
  for (const core::LandmarkId id : seen) stop.seen.push_back({id, {}, {}});
  return stop;
}

std::size_t looks_in(const std::vector<Stop>& stops) {
  return std::accumulate(stops.begin(), stops.end(), std::size_t{0},
                         [](std::size_t sum, const Stop& stop) { return sum + stop.seen.size(); });
}

TEST(StandingLooks, AreKeptOfEachPlace64TimesAndAtTheEnd) {
  StandingLooks looks(phase_m);
  std::vector<Stop> stops(100, stop_after(0.0, {3, 4}));
  looks.thin(stops);
  EXPECT_EQ(looks_in(stops), 2 * 65);
  EXPECT_FALSE(stops[63].repeats);
  EXPECT_TRUE(stops[64].repeats);
  EXPECT_FALSE(stops[99].repeats);

  std::vector<Stop> next(100, stop_after(0.0, {3, 4}));  // of the same place
  next[10].seen.push_back({5, {}, {}});                  // what came into view meanwhile
  looks.thin(next);
  EXPECT_EQ(looks_in(next), 2 + 1);
  EXPECT_FALSE(next[10].repeats);

  std::vector<Stop> elsewhere(100, stop_after(0.0, {3, 4}));
  elsewhere[0] = stop_after(0.06, {3, 4});
  looks.thin(elsewhere);
  EXPECT_EQ(looks_in(elsewhere), 2 * 65);
}

TEST(StandingLooks, OfAVehicleThatCreepsAreKept) {
  StandingLooks looks(phase_m);
  std::vector<Stop> stops(1000, stop_after(0.001, {3}));
  looks.thin(stops);
  EXPECT_EQ(looks_in(stops), 1000);
}

// A scan of which nothing is used is a stop like any other: it has a place on the path.
TEST(StandingLooks, LeaveScansThatSawNothingAlone) {
  StandingLooks looks(phase_m);
  std::vector<Stop> stops(100, stop_after(0.0, {}));
  looks.thin(stops);
  for (const Stop& stop : stops) EXPECT_FALSE(stop.repeats);
}

Tape tape_of_a_pause(int scans) {
  Tape tape(100000);
  for (int i = 0; i < scans; ++i) {
    core::Odometry still = core::no_motion(i);
    still.covariance = Eigen::Vector3d(1e-8, 1e-8, 1e-10).asDiagonal();
    tape.append(Tape::Motion{still, 0.0});
    Tape::Scan scan;
    scan.scan.t_ns = i;
    for (const int id : {0, 1}) {
      core::Observation seen;
      seen.kind = core::ObservationKind::range_bearing;
      seen.z = Eigen::Vector2d(8.0 + id, 0.4 - id);
      seen.R = Eigen::Vector2d(0.01, 1e-4).asDiagonal();
      scan.scan.observations.push_back(seen);
      scan.fate.push_back({id, i == 0 ? core::Outcome::augmented : core::Outcome::matched, id});
    }
    tape.append(scan);
  }
  return tape;
}

// What is left out can only make the map less certain; each scan keeps its place on the path.
TEST(StandingLooks, AreLeftOutOfTheDriveConservatively) {
  const auto solved = [](int scans) {
    DriveMap map({}, phase_m);
    cekf::CompressedEkf filter({});
    map.take(tape_of_a_pause(scans), filter);
    map.settle();
    return map;
  };
  const DriveMap some = solved(64), all = solved(1000);
  EXPECT_EQ(all.path().size(), 1000U);
  const Eigen::MatrixXd kept = all.atlas().joint({0, 1}).covariance;
  const Eigen::MatrixXd less = some.atlas().joint({0, 1}).covariance;
  const double ratio = kept.bottomRightCorner<4, 4>().trace() / less.bottomRightCorner<4, 4>().trace();
  EXPECT_LE(ratio, 1.0);
  EXPECT_GE(ratio, 0.9) << "with all of 1000 looks it would be a sixteenth";
}

}  // namespace
}  // namespace helixnav::supervisor
