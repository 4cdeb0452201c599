// SPDX-License-Identifier: BSD-3-Clause
// A map is saved as factors that nobody has solved; solved when it is taken up, they are the drive.
#include <cstdint>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "labelled_drive.hpp"
#include "smoothing/drive_map.hpp"
#include "smoothing/same_estimate.hpp"

namespace helixnav::supervisor {
namespace {

core::JointGaussian taken_up(const core::MapFactors& factors, const cekf::CompressedEkf& filter) {
  return atlas::Atlas::from_factors(factors).joint(filter.landmarks());
}

class UnsolvedFactors : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(UnsolvedFactors, AreTheSolvedDriveWhenTheyAreTakenUp) {
  const core::Recording run = sim::simulate(wide_circuit(), GetParam());
  const LabelledDrive drive(run, true);
  DriveMap solved(drive.start(), 20.0);
  solved.take(drive.tape, drive.filter);
  solved.settle();
  const core::MapFactors factors = DriveMap::unsolved(drive.start(), 20.0, drive.tape, drive.filter);
  EXPECT_FALSE(factors.is_solved);
  expect_same(taken_up(factors, drive.filter), solved.atlas().joint(drive.filter.landmarks()));
}

TEST_P(UnsolvedFactors, HaveTheirLandmarksWhereTheFilterHasThem) {
  const core::Recording run = sim::simulate(wide_circuit(), GetParam());
  const LabelledDrive drive(run, true);
  const core::MapFactors factors = DriveMap::unsolved(drive.start(), 20.0, drive.tape, drive.filter);
  for (const auto& [id, v] : factors.landmarks) {
    if (!drive.filter.contains(id)) continue;
    const Eigen::Vector3d& value = factors.variables[static_cast<std::size_t>(v)].value;
    EXPECT_LT((value.head<2>() - drive.filter.landmark(id).mean_m).norm(), 1e-3) << id;
  }
}

INSTANTIATE_TEST_SUITE_P(Circuits, UnsolvedFactors, ::testing::Range<std::uint64_t>(4, 8));

}  // namespace
}  // namespace helixnav::supervisor
