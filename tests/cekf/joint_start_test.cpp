// SPDX-License-Identifier: BSD-3-Clause
// A filter that begins with a map known jointly is the full filter begun so, and goes on as the one that made the map.
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "random_program.hpp"

namespace helixnav::cekf {
namespace {

core::JointGaussian two_landmarks() {
  core::JointGaussian start;
  start.ids = {4, 2};
  start.points_m = {{1.0, 2.0}, {3.0, 4.0}};
  start.covariance = 0.01 * Eigen::MatrixXd::Identity(7, 7);
  return start;
}

class JointStart : public ::testing::TestWithParam<Retraction> {};

/// The oracle is never interrupted; the filter is made anew from its joint estimate four times on the way.
TEST_P(JointStart, GoesOnAsIfItHadNeverBeenInterrupted) {
  RandomProgram program(11, {GetParam(), 220, 14, false});
  for (int k = 1; k <= 400; ++k) {
    program.step();
    if (k % 80 != 50) continue;
    program.filter = CompressedEkf(program.filter.joint(program.filter.landmarks()), program.filter.next_name(),
                                   program.filter.options());
  }
  EXPECT_GE(program.filter.mapped_count(), 100);
  EXPECT_GE(program.removed, 10);
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LE(d.covariance, 1e-7);
  EXPECT_LE(d.mean, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Both, JointStart, ::testing::Values(Retraction::standard, Retraction::right_invariant));

TEST(JointStartOf, AnyOrderOfNamesIsTheSameMap) {
  const CompressedEkf filter(two_landmarks(), 9);
  EXPECT_EQ(filter.landmarks(), (std::vector<core::LandmarkId>{2, 4}));
  EXPECT_EQ(filter.next_name(), 9);
  EXPECT_EQ(filter.landmark(4).mean_m, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(filter.landmark(2).mean_m, Eigen::Vector2d(3.0, 4.0));
}

TEST(JointStartOf, APoseAloneIsAnEmptyMap) {
  core::JointGaussian start;
  start.covariance = Eigen::MatrixXd::Zero(3, 3);
  EXPECT_EQ(CompressedEkf(start, 5).mapped_count(), 0);
}

TEST(JointStartOf, WhatIsNoJointEstimateIsRefused) {
  const auto refused = [](const auto& spoil, core::LandmarkId next_name) {
    core::JointGaussian start = two_landmarks();
    spoil(start);
    EXPECT_THROW(CompressedEkf(start, next_name), core::PreconditionError);
  };
  refused([](core::JointGaussian&) {}, 4);
  refused([](core::JointGaussian& s) { s.ids[0] = 2; }, 9);
  refused([](core::JointGaussian& s) { s.ids[0] = -1; }, 9);
  refused([](core::JointGaussian& s) { s.points_m.pop_back(); }, 9);
  refused([](core::JointGaussian& s) { s.points_m[0].x() = std::numeric_limits<double>::quiet_NaN(); }, 9);
  refused([](core::JointGaussian& s) { s.covariance = Eigen::MatrixXd::Identity(5, 5); }, 9);
  refused([](core::JointGaussian& s) { s.covariance(4, 4) = -1.0; }, 9);
  refused([](core::JointGaussian& s) { s.covariance(4, 5) = 0.005; }, 9);
  refused([](core::JointGaussian& s) { s.covariance(4, 5) = s.covariance(5, 4) = 0.02; }, 9);
}

}  // namespace
}  // namespace helixnav::cekf
