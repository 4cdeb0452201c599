// SPDX-License-Identifier: BSD-3-Clause
// Matches of a robot that is as uncertain of its place as landmarks are apart.
#include "doubtful_matches.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::team {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Landmarks known to 5 cm, and a robot at the origin that is known to sigma_m and sigma_rad.
core::JointGaussian joint_of(const Points& points_m, double sigma_m, double sigma_rad) {
  core::JointGaussian joint;
  const auto n = static_cast<Eigen::Index>(3 + 2 * points_m.size());
  joint.covariance = 0.05 * 0.05 * Eigen::MatrixXd::Identity(n, n);
  joint.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2().asDiagonal();
  joint.points_m = points_m;
  for (std::size_t i = 0; i < points_m.size(); ++i) joint.ids.push_back(static_cast<core::LandmarkId>(i));
  return joint;
}

/// These, as seen from where the robot really is.
core::Scan scan_of(const Points& points_m, const core::Pose2& pose) {
  core::Scan scan;
  scan.field_of_view = {0.2, 15.0, -M_PI, M_PI, 15.0};
  for (const Eigen::Vector2d& point_m : points_m) {
    const Eigen::Vector2d at_m = core::transform(core::inverse(pose), point_m);
    scan.observations.push_back(core::make_range_bearing(at_m.norm(), std::atan2(at_m.y(), at_m.x()), 0.1, 0.02));
  }
  return scan;
}

/// Outcomes of the scan; the assignment is the likelihood-ratio method's.
association::Assignment asked(const core::Scan& scan, const core::JointGaussian& joint) {
  const association::Gates gates;
  association::Options options;
  options.extraneous = association::density_in_view(scan, 0.5, options.extraneous);
  const association::InnovationProblem problem = association::make_innovation_problem(joint, scan, gates);
  association::Assignment assignment = association::associate(association::Method::likelihood_ratio, problem, options);
  leave_doubtful(scan, scan, joint, gates, options, assignment);
  return assignment;
}

/// [outcome] how many
long count(const association::Assignment& assignment, association::Outcome outcome) {
  return std::count_if(assignment.observations.begin(), assignment.observations.end(),
                       [&](const auto& one) { return one.outcome == outcome; });
}

TEST(DoubtfulMatches, ARobotThatKnowsItsPlaceHasNone) {
  const Points points_m{{8.0, 0.0}, {8.0, 3.0}, {5.0, -4.0}};
  const core::JointGaussian joint = joint_of(points_m, 0.1, 0.02);
  EXPECT_EQ(count(asked(scan_of({points_m[0]}, {0.05, 0.0, 0.0}), joint), association::Outcome::matched), 1);
}

TEST(DoubtfulMatches, ALandmarkThatNobodyHasBegunIsARivalOfARobotThatHardlyKnowsItsPlace) {
  const Points points_m{{8.0, 0.0}};
  const core::Scan scan = scan_of(points_m, {0.05, 0.0, 0.0});
  EXPECT_EQ(count(asked(scan, joint_of(points_m, 4.0, 0.6)), association::Outcome::ambiguous), 1);
  EXPECT_EQ(count(asked(scan, joint_of(points_m, 0.3, 0.05)), association::Outcome::matched), 1);
}

TEST(DoubtfulMatches, ThreeLandmarksSeenTogetherOutweighTheNew) {
  const Points points_m{{8.0, 0.0}, {8.0, 3.0}, {5.0, -4.0}};
  const core::JointGaussian joint = joint_of(points_m, 4.0, 0.6);
  EXPECT_EQ(count(asked(scan_of(points_m, {0.05, 0.0, 0.0}), joint), association::Outcome::matched), 3);
}

TEST(DoubtfulMatches, AScanWithoutObservationsHasNone) {
  EXPECT_TRUE(asked(scan_of({}, {}), joint_of({{8.0, 0.0}}, 2.0, 0.3)).observations.empty());
}

/// Turned by two and a half standard deviations: the true landmark is beyond the gate of the linear prediction, and another one is
/// near where it should be.
TEST(DoubtfulMatches, TheTrueLandmarkMayBeBeyondTheGate) {
  const core::Pose2 pose(1.5, -1.0, -0.5);
  const Points points_m{{9.0, -6.0}, {10.5, 0.5}};
  const core::JointGaussian joint = joint_of(points_m, 0.7, 0.2);
  const core::Scan scan = scan_of({points_m[0]}, pose);
  const association::InnovationProblem problem = association::make_innovation_problem(joint, scan);
  ASSERT_TRUE(std::any_of(problem.pairs.begin(), problem.pairs.end(), [](const auto& one) {
    return one.candidate == 1 && one.nis < 13.8;
  })) << "or nothing is shown";
  EXPECT_EQ(count(asked(scan, joint), association::Outcome::matched), 0);
}

TEST(DoubtfulMatches, SeveralTogetherDecideWhatOneDoesNot) {
  const Points seen_m{{8.0, 0.0}, {6.0, 3.5}, {3.0, -5.0}, {9.5, -4.0}};
  Points points_m = seen_m;
  points_m.insert(points_m.end(), {{10.0, 1.5}, {7.0, 5.5}, {2.0, -7.5}, {11.0, -6.0}});
  const core::JointGaussian joint = joint_of(points_m, 0.7, 0.1);
  const core::Pose2 pose(0.5, 0.3, 0.05);
  EXPECT_EQ(count(asked(scan_of({seen_m[0]}, pose), joint), association::Outcome::matched), 0);
  const association::Assignment together = asked(scan_of(seen_m, pose), joint);
  for (std::size_t i = 0; i < seen_m.size(); ++i) {
    EXPECT_EQ(together.observations[i].outcome, association::Outcome::matched) << i;
    EXPECT_EQ(together.observations[i].candidate, static_cast<int>(i));
  }
}

TEST(DoubtfulMatches, InALatticeSeveralDecideNothing) {
  Points points_m;
  for (int row = -4; row <= 4; ++row) {
    for (int column = 1; column <= 6; ++column) points_m.emplace_back(2.0 * column, 2.0 * row);
  }
  const core::JointGaussian joint = joint_of(points_m, 0.8, 0.02);
  const Points seen_m{{4.0, 0.0}, {4.0, 2.0}, {6.0, 0.0}, {6.0, 2.0}};
  EXPECT_EQ(count(asked(scan_of(seen_m, {0.9, 0.8, 0.0}), joint), association::Outcome::matched), 0);
}

}  // namespace
}  // namespace helixnav::team
