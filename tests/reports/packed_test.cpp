// SPDX-License-Identifier: BSD-3-Clause
#include "player/packed.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "helixnav/core/random.hpp"
#include "player/packed_ellipse.hpp"
#include "unpacked.hpp"

namespace helixnav::reports {
namespace {

TEST(Packed, EqualsBytesWrittenByHand) {
  EXPECT_EQ(packed({}, 0), "");
  EXPECT_EQ(packed({0, -1, 1, 64}, 0), "AAECgAE=");  // 0, 1, 2, and 128 in two bytes
  EXPECT_EQ(packed({5, 6, 7}, 1), "CgIC");
  EXPECT_EQ(packed({5, 10, 15}, 2), "CgAA");
}

TEST(Packed, GivesBackEveryNumberOfEveryOrder) {
  core::RandomStream random(1, "packed");
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < 500; ++i) {
    numbers.push_back(static_cast<std::int64_t>(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(0.0, 9.0))));
  }
  for (const int order : {0, 1, 2}) EXPECT_EQ(unpacked(packed(numbers, order), order), numbers) << order;
}

TEST(Packed, TakesTwoBytesForAPlaceOfASteadyDrive) {
  std::vector<std::int64_t> x_cm;
  for (int k = 0; k < 3000; ++k) x_cm.push_back(45 * k);
  EXPECT_LE(packed(x_cm, 1).size(), 2 * x_cm.size());
}

TEST(Quantised, RoundsAndPutsZeroForWhatIsNoNumber) {
  EXPECT_EQ(quantised(1.236, 0.01), 124);
  EXPECT_EQ(quantised(-1.236, 0.01), -124);
  EXPECT_EQ(quantised(std::nan(""), 0.01), 0);
  EXPECT_EQ(quantised(INFINITY, 0.01), 0);
  EXPECT_EQ(quantised(1e12, 0.01), 0);
}

TEST(PackedEllipses, KeepHalfAxesToThreePercentAndTheAngle) {
  const double angle_rad = 0.6;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  PackedEllipses ellipses;
  ellipses.add(R * Eigen::Vector2d(4.0, 0.01).asDiagonal() * R.transpose());
  ellipses.add(Eigen::Matrix2d::Zero());
  const Json json = ellipses.json();
  const auto half_axis_m = [](std::int64_t steps) { return 1e-3 * std::exp2(static_cast<double>(steps) / 24.0); };
  EXPECT_NEAR(half_axis_m(unpacked(json["a"], 1)[0]), 2.0, 0.03 * 2.0);
  const std::int64_t shorter = unpacked(json["a"], 1)[0] - unpacked(json["b_less"], 0)[0];
  EXPECT_NEAR(half_axis_m(shorter), 0.1, 0.03 * 0.1);
  EXPECT_NEAR(static_cast<double>(unpacked(json["angle"], 1)[0]) * M_PI / 64.0, angle_rad, M_PI / 64.0);
  EXPECT_EQ(unpacked(json["a"], 1)[1], 0);
}

}  // namespace
}  // namespace helixnav::reports
