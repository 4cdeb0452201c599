// SPDX-License-Identifier: BSD-3-Clause
// A filter that starts with a joint estimate continues like the one that made it.
#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "random_program.hpp"

namespace helixnav::cekf {
namespace {

class JointStart : public testing::TestWithParam<Retraction> {};

/// The program's filter from its estimate alone. `backwards` names the landmarks in reverse order.
CompressedEkf begun_again(const RandomProgram& program, bool backwards) {
  std::vector<core::LandmarkId> ids = program.filter.landmarks();
  if (backwards) std::reverse(ids.begin(), ids.end());
  return {program.filter.joint(ids), program.filter.next_name(), program.filter.options()};
}

TEST_P(JointStart, KeepsTheWholeEstimate) {
  RandomProgram program(21, {GetParam(), 220, 40, false});
  for (int k = 0; k < 300; ++k) program.step();
  const CompressedEkf filter = begun_again(program, true);
  EXPECT_EQ(filter.landmarks(), program.filter.landmarks());
  EXPECT_EQ(filter.mapped_count(), program.filter.mapped_count());
  const Differences d = compare(filter, program.oracle);
  EXPECT_LE(d.mean, 1e-9);
  EXPECT_LE(d.covariance, 1e-8);
  EXPECT_GT(filter.active_count(), 0);
  EXPECT_LT(filter.active_count(), filter.mapped_count());
}

TEST_P(JointStart, KeepsAnEstimateThatIsReadInParts) {
  RandomProgram program(24, {GetParam(), 450, 40, false});
  for (int k = 0; k < 420; ++k) program.step();
  program.filter.keep_since(program.filter.phase());
  program.filter.switch_region({});
  for (int k = 0; k < 5; ++k) program.step();
  EXPECT_GT(program.filter.mapped_count() - program.filter.active_count(), 130) << "more than are read at once";
  const Differences d = compare(begun_again(program, true), program.oracle);
  EXPECT_LE(d.mean, 1e-9);
  EXPECT_LE(d.covariance, 1e-8);
}

TEST_P(JointStart, GoesOnAsTheFullFilter) {
  RandomProgram program(22, {GetParam(), 220, 40, false});
  for (int k = 0; k < 200; ++k) program.step();
  program.filter = begun_again(program, false);
  for (int k = 0; k < 300; ++k) program.step();
  const Differences d = compare(program.filter, program.oracle);
  EXPECT_LE(d.mean, 1e-7);
  EXPECT_LE(d.covariance, 1e-7);
  EXPECT_GT(program.switches, 3);
}

TEST_P(JointStart, CanBeRolledBackToItsBegin) {
  RandomProgram program(23, {GetParam(), 220, 0, false});
  for (int k = 0; k < 200; ++k) program.step();
  CompressedEkf filter = begun_again(program, false);
  filter.keep_since(filter.phase());
  const Snapshot begin = filter.snapshot();
  const std::vector<core::LandmarkId> ids = filter.landmarks();
  const core::JointGaussian before = filter.joint(ids);
  core::Odometry motion;
  motion.T_before_after = core::Pose2(30.0, 0.0, 0.3);
  motion.covariance = Eigen::Vector3d(0.1, 0.1, 0.01).asDiagonal();
  filter.predict(motion);
  filter.remove(ids.front());
  filter.activate(ids.back());
  filter.switch_region();
  filter.restore(begin);
  const core::JointGaussian after = filter.joint(ids);
  EXPECT_LE((after.covariance - before.covariance).cwiseAbs().maxCoeff(), 1e-12 * before.covariance.norm());
}

INSTANTIATE_TEST_SUITE_P(Retractions, JointStart, testing::Values(Retraction::standard, Retraction::right_invariant));

core::JointGaussian two_landmarks() {
  core::JointGaussian joint;
  joint.ids = {4, 2};
  joint.points_m = {{1.0, 2.0}, {3.0, 4.0}};
  joint.covariance = Eigen::MatrixXd::Identity(7, 7);
  return joint;
}

TEST(JointStart, NamesNewLandmarksFromTheNameGiven) {
  CompressedEkf filter(two_landmarks(), 7);
  EXPECT_EQ(filter.next_name(), 7);
  EXPECT_EQ(filter.landmark_mean(2), Eigen::Vector2d(3.0, 4.0));
  EXPECT_FALSE(filter.contains(3));
}

TEST(JointStart, HasNoLandmarksWhereNoneAreGiven) {
  core::JointGaussian joint;
  joint.covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(CompressedEkf(joint, 0).mapped_count(), 0);
}

TEST(JointStart, RefusesWhatIsNoJointEstimate) {
  const auto expect_refused = [](void (*spoil)(core::JointGaussian&)) {
    core::JointGaussian joint = two_landmarks();
    spoil(joint);
    EXPECT_THROW(CompressedEkf(joint, 5), core::PreconditionError);
  };
  using Joint = core::JointGaussian;
  expect_refused([](Joint& joint) { joint.ids[1] = 4; });
  expect_refused([](Joint& joint) { joint.ids[1] = -1; });
  expect_refused([](Joint& joint) { joint.ids[1] = 5; });
  expect_refused([](Joint& joint) { joint.points_m.pop_back(); });
  expect_refused([](Joint& joint) { joint.covariance.resize(5, 5); });
  expect_refused([](Joint& joint) { joint.covariance(4, 4) = -1.0; });
  expect_refused([](Joint& joint) { joint.covariance(5, 3) = std::numeric_limits<double>::quiet_NaN(); });
  expect_refused([](Joint& joint) { joint.points_m[0].x() = std::numeric_limits<double>::infinity(); });
}

}  // namespace
}  // namespace helixnav::cekf
