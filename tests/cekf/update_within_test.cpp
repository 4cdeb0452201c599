// SPDX-License-Identifier: BSD-3-Clause
// An update that is rolled back if its innovation is too large, and the innovation by itself.
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::cekf {
namespace {

core::Observation looks(double range_m, double bearing_rad) {
  return core::make_range_bearing(range_m, bearing_rad, 0.1, 0.01);
}

/// Two landmarks, and a vehicle that has moved since.
class UpdateWithin : public ::testing::Test {
 protected:
  UpdateWithin() {
    a_ = filter_.augment(looks(10.0, 0.3), {});
    b_ = filter_.augment(looks(14.0, -0.4), {});
    core::Odometry motion = core::no_motion(1);
    motion.T_before_after = {1.0, 0.0, 0.0};
    motion.covariance = Eigen::Vector3d(0.04, 0.01, 1e-4).asDiagonal();
    filter_.predict(motion);
    matches_ = {{a_, looks(9.2, 0.31), {}}, {b_, looks(13.1, -0.42), {}}};
  }

  CompressedEkf filter_{core::PoseGaussian{}};
  core::LandmarkId a_ = core::no_landmark, b_ = core::no_landmark;
  std::vector<Match> matches_;
};

TEST_F(UpdateWithin, IsTheUpdateWhereTheInnovationIsUsual) {
  CompressedEkf other = filter_;
  const UpdateResult expected = other.update(matches_);
  const std::optional<UpdateResult> result = filter_.update_within(matches_, expected.nis);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->nis, expected.nis);
  EXPECT_EQ(result->dof, 4);
  EXPECT_EQ(filter_.pose().mean.vector(), other.pose().mean.vector());
  EXPECT_EQ(filter_.pose().covariance, other.pose().covariance);
}

TEST_F(UpdateWithin, ChangesNothingWhereItIsNot) {
  const CompressedEkf before = filter_;
  CompressedEkf other = filter_;
  const double nis = other.update(matches_).nis;
  EXPECT_FALSE(filter_.update_within(matches_, 0.999 * nis).has_value());
  EXPECT_EQ(filter_.pose().mean.vector(), before.pose().mean.vector());
  EXPECT_EQ(filter_.joint({a_, b_}).covariance, before.joint({a_, b_}).covariance);
  filter_.update(matches_);
  EXPECT_EQ(filter_.joint({a_, b_}).covariance, other.joint({a_, b_}).covariance);
}

TEST_F(UpdateWithin, ActivatesNothingWhereItIsNot) {
  filter_.switch_region(std::vector<core::LandmarkId>{});
  const CompressedEkf before = filter_;
  EXPECT_FALSE(filter_.update_within(matches_, 1e-9).has_value());
  EXPECT_FALSE(filter_.is_active(a_));
  EXPECT_EQ(filter_.joint({a_, b_}).covariance, before.joint({a_, b_}).covariance);
}

TEST_F(UpdateWithin, TheInnovationIsWhatItsNisIsOf) {
  const Innovation innovation = filter_.innovation(matches_);
  ASSERT_EQ(innovation.nu.size(), 4);
  CompressedEkf other = filter_;
  EXPECT_NEAR(innovation.nu.dot(innovation.S.inverse() * innovation.nu), other.update(matches_).nis, 1e-9);
  EXPECT_LT((innovation.S - innovation.S.transpose()).norm(), 1e-12);
}

}  // namespace
}  // namespace helixnav::cekf
