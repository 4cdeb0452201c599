// SPDX-License-Identifier: BSD-3-Clause
// map.bin of a map that is kept as factors.
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

std::shared_ptr<const core::RelativeGaussian> some_gaussian(Eigen::Index rows, double scale) {
  auto gaussian = std::make_shared<core::RelativeGaussian>();
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(rows, rows);
  gaussian->information = scale * root * root.transpose();
  gaussian->vector = Eigen::VectorXd::Random(rows);
  gaussian->mean = 10.0 * Eigen::VectorXd::Random(rows);
  gaussian->chi2 = 1.0 / 3.0;
  return gaussian;
}

core::AbsoluteFix some_fix() {
  core::AbsoluteFix fix;
  fix.t_ns = -1234567890123;
  fix.position_world_m = {4.5e5, -5.1e6};
  fix.covariance_m2 << 0.3, 0.1, 0.1, 0.4;
  fix.antenna_robot_m = {0.1, -0.2};
  return fix;
}

/// Two phases with a landmark in both and one in the second; a third was taken in by the first.
std::shared_ptr<const core::MapFactors> some_factors() {
  auto map = std::make_shared<core::MapFactors>();
  map->start.mean = core::Pose2(0.1, 0.2, 0.3);
  map->start.covariance = Eigen::Vector3d(1.0, 2.0, 0.5).asDiagonal();
  map->world = 6;
  for (const int dim : {3, 3, 3, 3, 2, 2, 3}) {
    const double k = static_cast<double>(map->variables.size());
    map->variables.push_back({dim, Eigen::Vector3d(k / 3.0, -k, 0.01 * k)});
  }
  map->poses = {0, 1, 2, 3};
  map->landmarks = {{2, 4}, {11, 5}};
  map->phases.resize(3);
  map->phases[0].parts = {{{0, 1, 4}, some_gaussian(5, 1.0), {}}, {{6, 0}, some_gaussian(3, 2.0), some_fix()}};
  map->phases[0].revisits = 1;
  map->phases[1].parts = {{{1, 2, 4, 5}, some_gaussian(7, 1e9), {}}};
  map->phases[2].host = 0;
  map->phases[2].T_host_entry = core::Pose2(1.0, 1.0 / 7.0, -0.1);
  return map;
}

core::JointMap large_map() {
  core::JointMap map;
  map.next_name = 12;
  map.reach_m = 30.0;
  map.joint.pose = core::Pose2(1.0 / 3.0, -2.0, 0.1);
  map.joint.covariance = Eigen::Vector3d(0.1, 0.2, 0.003).asDiagonal();
  map.joint.ids = {2, 11};
  map.joint.points_m = {{1.0, 2.0}, {-3.0, 1e-9}};
  map.covariances_m2 = {0.1 * Eigen::Matrix2d::Identity(), 0.2 * Eigen::Matrix2d::Identity()};
  map.states = {core::LandmarkState::mature, core::LandmarkState::tentative};
  map.observations = {7, 1};
  map.factors = some_factors();
  return map;
}

class LargeMapFile : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "map.bin").string(); }
  core::JointMap read(const std::string& bytes) const {
    std::ofstream(path(), std::ios::binary) << bytes;
    return read_joint_map(path());
  }

  testing::TemporaryFolder folder_;
};

void expect_equal(const core::MapFactors::Part& a, const core::MapFactors::Part& b) {
  EXPECT_EQ(a.variables, b.variables);
  EXPECT_EQ(a.gaussian->information.full(), b.gaussian->information.full());
  EXPECT_EQ(a.gaussian->vector, b.gaussian->vector);
  EXPECT_EQ(a.gaussian->mean, b.gaussian->mean);
  EXPECT_EQ(a.gaussian->chi2, b.gaussian->chi2);
  ASSERT_EQ(a.fix.has_value(), b.fix.has_value());
  if (!a.fix) return;
  EXPECT_EQ(a.fix->t_ns, b.fix->t_ns);
  EXPECT_EQ(a.fix->position_world_m, b.fix->position_world_m);
  EXPECT_EQ(a.fix->covariance_m2, b.fix->covariance_m2);
  EXPECT_EQ(a.fix->antenna_robot_m, b.fix->antenna_robot_m);
}

TEST_F(LargeMapFile, GoesThereAndBackBitForBit) {
  const core::JointMap map = large_map();
  const core::JointMap back = read(joint_map_bytes(map));
  EXPECT_FALSE(back.has_covariance());
  EXPECT_EQ(back.joint.covariance, map.joint.covariance);
  EXPECT_EQ(back.covariances_m2, map.covariances_m2);
  EXPECT_EQ(back.joint.points_m, map.joint.points_m);
  const core::MapFactors& one = *map.factors;
  const core::MapFactors& other = *back.factors;
  EXPECT_EQ(one.start.mean.vector(), other.start.mean.vector());
  EXPECT_EQ(one.start.covariance, other.start.covariance);
  EXPECT_EQ(one.world, other.world);
  EXPECT_EQ(one.poses, other.poses);
  EXPECT_EQ(one.landmarks, other.landmarks);
  ASSERT_EQ(one.variables.size(), other.variables.size());
  for (std::size_t v = 0; v < one.variables.size(); ++v) {
    EXPECT_EQ(one.variables[v].dim, other.variables[v].dim);
    EXPECT_EQ(one.variables[v].value, other.variables[v].value);
  }
  ASSERT_EQ(one.phases.size(), other.phases.size());
  for (std::size_t k = 0; k < one.phases.size(); ++k) {
    EXPECT_EQ(one.phases[k].revisits, other.phases[k].revisits);
    EXPECT_EQ(one.phases[k].host, other.phases[k].host);
    EXPECT_EQ(one.phases[k].T_host_entry.vector(), other.phases[k].T_host_entry.vector());
    ASSERT_EQ(one.phases[k].parts.size(), other.phases[k].parts.size());
    for (std::size_t i = 0; i < one.phases[k].parts.size(); ++i) {
      expect_equal(one.phases[k].parts[i], other.phases[k].parts[i]);
    }
  }
  EXPECT_EQ(joint_map_bytes(back), joint_map_bytes(map));
}

TEST_F(LargeMapFile, SaysWhetherItsFactorsAreSolved) {
  core::JointMap map = large_map();
  EXPECT_TRUE(read(joint_map_bytes(map)).factors->is_solved);
  core::MapFactors unsolved = *map.factors;
  unsolved.is_solved = false;
  map.factors = std::make_shared<const core::MapFactors>(unsolved);
  EXPECT_FALSE(read(joint_map_bytes(map)).factors->is_solved);
}

TEST_F(LargeMapFile, MayHaveAJointCovarianceAsWell) {
  core::JointMap map = large_map();
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(7, 7);
  map.joint.covariance = root * root.transpose();
  map.joint.covariance = (0.5 * (map.joint.covariance + map.joint.covariance.transpose())).eval();
  map.covariances_m2.clear();
  const core::JointMap back = read(joint_map_bytes(map));
  EXPECT_TRUE(back.has_covariance());
  EXPECT_EQ(back.joint.covariance, map.joint.covariance);
  EXPECT_NE(back.factors, nullptr);
}

TEST_F(LargeMapFile, FlippedBytesAndOtherLengthsAreFound) {
  const std::string whole = joint_map_bytes(large_map());
  for (std::size_t k = 0; k < whole.size(); k += 11) {
    std::string flipped = whole;
    flipped[k] = static_cast<char>(flipped[k] ^ 0x10);
    EXPECT_THROW(read(flipped), core::InputError) << "byte " << k;
    EXPECT_THROW(read(whole.substr(0, k)), core::InputError) << "length " << k;
  }
}

/// As another program may have written it: the digest fits.
TEST_F(LargeMapFile, WhatRefersToNothingIsRefused) {
  const auto is_refused = [this](const core::MapFactors& factors) {
    core::JointMap map = large_map();
    map.factors = std::make_shared<const core::MapFactors>(factors);
    EXPECT_THROW(read(joint_map_bytes(map)), core::InputError);
  };
  core::MapFactors factors = *some_factors();
  factors.phases[1].parts[0].variables[3] = 7;
  is_refused(factors);
  factors = *some_factors();
  factors.poses[2] = -1;
  is_refused(factors);
  factors = *some_factors();
  factors.landmarks.pop_back();
  is_refused(factors);
  factors = *some_factors();
  factors.variables[1].dim = 4;
  is_refused(factors);
  factors = *some_factors();
  factors.variables[1].value.x() = 1e300;
  is_refused(factors);
}

}  // namespace
}  // namespace helixnav::runs
