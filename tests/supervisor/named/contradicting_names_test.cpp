// SPDX-License-Identifier: BSD-3-Clause
#include "named/contradicting_names.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

/// Five landmarks around a vehicle that knows where it is to 5 cm and 0.3°.
class ContradictingNames : public ::testing::Test {
 protected:
  ContradictingNames() {
    assumed_.view.max_range_m = 30.0;
    assumed_.reach_m = 30.0;
    assumed_.wrong = 1e-3;
    for (const Eigen::Vector2d& at_m : points_m_) ids_.push_back(filter_.augment(seen(at_m, {}), {}));
    core::Odometry motion = core::no_motion(1);
    motion.covariance = Eigen::Vector3d(0.0025, 0.0025, 2.7e-5).asDiagonal();
    filter_.predict(motion);
  }

  static core::Observation seen(const Eigen::Vector2d& at_m, const core::Pose2& T_world_robot) {
    const Eigen::Vector2d p = core::transform(core::inverse(T_world_robot), at_m);
    return core::make_range_bearing(p.norm(), std::atan2(p.y(), p.x()), 0.1, 0.01);
  }

  /// All five, from a pose.
  std::vector<cekf::Match> from(const core::Pose2& T_world_robot) const {
    std::vector<cekf::Match> matches;
    for (std::size_t i = 0; i < ids_.size(); ++i) matches.push_back({ids_[i], seen(points_m_[i], T_world_robot), {}});
    return matches;
  }

  std::vector<std::size_t> contradicting(const std::vector<cekf::Match>& matches) const {
    std::vector<std::size_t> found;
    for (const ContradictingName& one : contradicting_names(filter_, matches, assumed_)) found.push_back(one.match);
    std::sort(found.begin(), found.end());
    return found;
  }

  double slip_nats(const std::vector<cekf::Match>& matches) const {
    return nats_for_slip(filter_, matches, contradicting_names(filter_, matches, assumed_), assumed_, {});
  }

  const std::vector<Eigen::Vector2d> points_m_{{12.0, 3.0}, {8.0, -9.0}, {20.0, 11.0}, {-6.0, 14.0}, {15.0, -17.0}};
  cekf::CompressedEkf filter_{core::PoseGaussian{}};
  std::vector<core::LandmarkId> ids_;
  AssumedOfNames assumed_;
};

TEST_F(ContradictingNames, AreNoneWhereAllAreRight) {
  EXPECT_TRUE(contradicting(from({})).empty());
  EXPECT_TRUE(contradicting(from({0.05, -0.05, 0.004})).empty());
}

TEST_F(ContradictingNames, AreThoseOfOtherLandmarks) {
  std::vector<cekf::Match> matches = from({});
  std::swap(matches[1].landmark, matches[3].landmark);
  EXPECT_EQ(contradicting(matches), (std::vector<std::size_t>{1, 3}));
  matches = from({});
  matches[4].landmark = ids_[0];
  EXPECT_EQ(contradicting(matches), std::vector<std::size_t>{4});
}

/// A sighting is judged as by a filter that has been updated with the others.
TEST_F(ContradictingNames, AreJudgedGivenAllOthers) {
  std::vector<cekf::Match> matches = from({});
  matches[2].observation.z[0] += 2.0;
  const std::vector<ContradictingName> found = contradicting_names(filter_, matches, assumed_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].match, 2u);
  cekf::CompressedEkf others = filter_;
  std::vector<cekf::Match> rest = matches;
  rest.erase(rest.begin() + 2);
  others.update(rest);
  const cekf::Innovation given = others.innovation({matches[2]});
  EXPECT_NEAR(found[0].nis / given.nu.dot(given.S.inverse() * given.nu), 1.0, 0.02);  // linearised elsewhere
  EXPECT_EQ(found[0].dof, 2);
}

/// Six standard deviations are the bound for a sensor that sees 30 m all round, with 1 in 1000.
TEST_F(ContradictingNames, BeginWhereAnythingInViewIsAsLikely) {
  std::vector<cekf::Match> matches = from({});
  matches[0].observation.z[0] += 0.5;
  EXPECT_TRUE(contradicting(matches).empty());
  matches[0].observation.z[0] += 0.7;
  EXPECT_EQ(contradicting(matches), std::vector<std::size_t>{0});
  assumed_.noise_scale = 9.0;  // the noise is known to be three times as large
  EXPECT_TRUE(contradicting(matches).empty());
}

TEST_F(ContradictingNames, AreOutweighedByASlip) {
  EXPECT_GT(slip_nats(from({0.6, 0.2, 0.05})), 10.0);
  std::vector<cekf::Match> swapped = from({});
  std::swap(swapped[1].landmark, swapped[3].landmark);
  EXPECT_LT(slip_nats(swapped), -100.0);
}

TEST_F(ContradictingNames, AreNotWhereAllAgreeAboutAPoseFarAway) {
  EXPECT_TRUE(agree_about_a_pose(filter_, from({9.0, -6.0, 0.5}), assumed_));
  std::vector<cekf::Match> swapped = from({});
  std::swap(swapped[1].landmark, swapped[3].landmark);
  EXPECT_FALSE(agree_about_a_pose(filter_, swapped, assumed_));
  EXPECT_FALSE(agree_about_a_pose(filter_, {from({9.0, -6.0, 0.5})[0]}, assumed_)) << "two rows, three unknowns";
}

/// Ranges alone have one row each.
TEST_F(ContradictingNames, AreFoundAmongRangesAlone) {
  std::vector<cekf::Match> matches;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    matches.push_back({ids_[i], core::make_range(points_m_[i].norm(), 0.1), {}});
  }
  EXPECT_TRUE(contradicting(matches).empty());
  matches[1].observation.z[0] = 25.0;
  EXPECT_EQ(contradicting(matches), std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace helixnav::supervisor
