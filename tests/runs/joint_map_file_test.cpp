// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/joint_map_file.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

core::JointMap three_landmarks() {
  core::JointMap map;
  map.next_name = 12;
  map.reach_m = 12.5;
  map.joint.pose = core::Pose2(1.0 / 3.0, -2.0, 0.1);
  map.joint.ids = {2, 5, 11};
  map.joint.points_m = {{1.0, 2.0}, {-3.0, 1e-9}, {0.1, 0.7}};
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(9, 9);
  map.joint.covariance = root * root.transpose();
  map.joint.covariance = (0.5 * (map.joint.covariance + map.joint.covariance.transpose())).eval();
  map.states = {core::LandmarkState::mature, core::LandmarkState::tentative, core::LandmarkState::mature};
  map.observations = {7, 1, 30};
  return map;
}

class JointMapFile : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "map.bin").string(); }
  core::JointMap read(const std::string& bytes) const {
    std::ofstream(path(), std::ios::binary) << bytes;
    return read_joint_map(path());
  }
  void expect_refused(const std::string& bytes, const std::string& because) const {
    try {
      read(bytes);
      ADD_FAILURE() << "was read: " << because;
    } catch (const core::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path()), std::string::npos) << "names the file";
      EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
    }
  }

  testing::TemporaryFolder folder_;
};

TEST_F(JointMapFile, GoesThereAndBackBitForBit) {
  const core::JointMap map = three_landmarks();
  const core::JointMap back = read(joint_map_bytes(map));
  EXPECT_EQ(back.next_name, map.next_name);
  EXPECT_EQ(back.reach_m, map.reach_m);
  EXPECT_EQ(back.joint.ids, map.joint.ids);
  EXPECT_EQ(back.joint.points_m, map.joint.points_m);
  EXPECT_EQ(back.joint.pose.vector(), map.joint.pose.vector());
  EXPECT_EQ(back.joint.covariance, map.joint.covariance);
  EXPECT_EQ(back.states, map.states);
  EXPECT_EQ(back.observations, map.observations);
  EXPECT_EQ(joint_map_bytes(back), joint_map_bytes(map));
}

TEST_F(JointMapFile, AMapWithoutLandmarksIsAMap) {
  core::JointMap map;
  map.joint.covariance = Eigen::MatrixXd::Identity(3, 3);
  EXPECT_TRUE(read(joint_map_bytes(map)).joint.ids.empty());
}

TEST_F(JointMapFile, EveryFlippedByteIsFound) {
  const std::string whole = joint_map_bytes(three_landmarks());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string flipped = whole;
    flipped[k] = static_cast<char>(flipped[k] ^ 0x10);
    std::ofstream(path(), std::ios::binary) << flipped;
    EXPECT_THROW(read_joint_map(path()), core::InputError) << "byte " << k;
  }
}

TEST_F(JointMapFile, EveryOtherLengthIsFound) {
  const std::string whole = joint_map_bytes(three_landmarks());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(path(), std::ios::binary) << whole.substr(0, length);
    EXPECT_THROW(read_joint_map(path()), core::InputError) << "length " << length;
  }
  expect_refused(whole + 'x', "cut short or damaged");
}

TEST_F(JointMapFile, SaysWhatIsWrong) {
  const std::string whole = joint_map_bytes(three_landmarks());
  expect_refused("", "empty");
  expect_refused("id,x,y,sxx,sxy,syy,observations,state\n", "HELIXMAP");
  std::string newer = whole;
  newer[8] = 3;
  expect_refused(newer, "version 3");
  std::string larger = whole;
  larger[15] = 1;
  expect_refused(larger, "at most 2000");
  expect_refused(whole.substr(0, 100), "cut short");
  std::string flipped = whole;
  flipped[60] = static_cast<char>(flipped[60] ^ 1);
  expect_refused(flipped, "checksum");
  EXPECT_THROW(read_joint_map(path() + "x"), core::InputError);
}

TEST_F(JointMapFile, WhatIsNoMapIsRefusedThoughItsChecksumFits) {
  core::JointMap map = three_landmarks();
  map.joint.ids = {5, 2, 11};
  expect_refused(joint_map_bytes(map), "ascending");
  map = three_landmarks();
  map.next_name = 11;
  expect_refused(joint_map_bytes(map), "next name");
  map = three_landmarks();
  map.joint.covariance(4, 4) = -1.0;
  expect_refused(joint_map_bytes(map), "covariance");
  map = three_landmarks();
  map.joint.covariance(4, 3) = map.joint.covariance(3, 4) = 1.1 * map.joint.covariance.diagonal().maxCoeff();
  expect_refused(joint_map_bytes(map), "covariance");
  map = three_landmarks();
  const double sigma_m = std::sqrt(map.joint.covariance(0, 0) * map.joint.covariance(1, 1));
  map.joint.covariance(1, 0) = map.joint.covariance(0, 1) = 0.99 * sigma_m;
  map.joint.covariance(2, 0) = map.joint.covariance(0, 2) = 0.0;
  map.joint.covariance(2, 1) = map.joint.covariance(1, 2) =
      0.9 * std::sqrt(map.joint.covariance(1, 1) * map.joint.covariance(2, 2));
  expect_refused(joint_map_bytes(map), "covariance");  // of the pose: no correlation above one, yet invalid
  map = three_landmarks();
  map.joint.points_m[1].x() = 1e9;
  expect_refused(joint_map_bytes(map), "coordinates");
  map = three_landmarks();
  map.next_name = std::numeric_limits<core::LandmarkId>::max();
  expect_refused(joint_map_bytes(map), "next name");
  map = three_landmarks();
  map.observations[2] = -1;
  expect_refused(joint_map_bytes(map), "observed");
  map = three_landmarks();
  map.states[0] = core::LandmarkState::dead;
  expect_refused(joint_map_bytes(map), "state");
}

TEST_F(JointMapFile, PartsThatDoNotFitAreNotWritten) {
  core::JointMap map = three_landmarks();
  map.states.pop_back();
  EXPECT_THROW(joint_map_bytes(map), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::runs
