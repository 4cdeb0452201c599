// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_config.hpp"

#include <gtest/gtest.h>

#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

class Config : public ::testing::Test {
 protected:
  SlamConfig read(const std::string& content) const { return read_slam_config(folder_.write("a.ini", content)); }
  std::string refusal(const std::string& content) const {
    return testing::input_error_of([&] { read(content); });
  }

  testing::TemporaryFolder folder_;
};

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

TEST_F(Config, TakesTheKeysOfKfSlamWithItsComments) {
  const SlamConfig config = read(
      "# a comment\n[MappingApplication]\nkf_implementation = CRangeBearingKFSLAM2D\nground_truth_file=\n"
      "logOutput_dir=LOG_EKF-SLAM  // where\nSAVE_LOG_FREQUENCY=10\nSHOW_3D_LIVE   = true\nSAVE_DA_LOG=0\n"
      "SAVE_MAP_REPRESENTATIONS=1\n"
      "[RangeBearingKFSLAM_KalmanFilter]\nmethod=0\n"
      "[RangeBearingKFSLAM]\nstdXY_no_odo=0.2\nstd_sensor_range     = 0.03  // meters\nstd_sensor_yaw_deg = 0.1\n"
      "std_sensor_pitch_deg = 0.1\n[HelixNav]\nsave_png = no\nstd_sensor_range = 0.04\n");
  EXPECT_EQ(config.logOutput_dir, "LOG_EKF-SLAM");
  EXPECT_EQ(config.SAVE_LOG_FREQUENCY, 10U);
  EXPECT_TRUE(config.SHOW_3D_LIVE);
  EXPECT_FALSE(config.SAVE_DA_LOG);
  EXPECT_FALSE(config.save_png);
  EXPECT_EQ(config.ground_truth_file, "");
  EXPECT_DOUBLE_EQ(config.builder.stdXY_no_odo, 0.2);
  EXPECT_DOUBLE_EQ(config.builder.std_sensor_range, 0.04);  // our section has the last word
  EXPECT_EQ(config.without_effect, (std::vector<std::string>{"[MappingApplication] SAVE_MAP_REPRESENTATIONS",
                                                             "[RangeBearingKFSLAM] std_sensor_pitch_deg"}));
}

TEST_F(Config, NamesOfMrptsPlainFilterMeanTheStandardRetractionUnlessTheFileSaysIt) {
  const std::string kalman = "[RangeBearingKFSLAM_KalmanFilter]\n";
  for (const char* method : {"0  # Full EKF", "1", "kfEKFNaive", "kfEKFAlaDavison"}) {
    const SlamConfig config = read(kalman + "method = " + method + "\n");
    EXPECT_EQ(config.builder.retraction, "standard") << method;
    EXPECT_TRUE(config.without_effect.empty()) << method;
  }
  const std::string plain = kalman + "method=0\n";
  EXPECT_EQ(read(plain + "[HelixNav]\nretraction = right-invariant\n").builder.retraction, "right-invariant");
  EXPECT_EQ(read(plain + "[RangeBearingKFSLAM]\nretraction = right-invariant\n").builder.retraction, "right-invariant");
}

TEST_F(Config, NoNameOrOneOfAnIteratedFilterLeavesOurRetraction) {
  const std::string kalman = "[RangeBearingKFSLAM_KalmanFilter]\n";
  EXPECT_EQ(read(kalman + "IKF_iterations=5\n").builder.retraction, "right-invariant");
  EXPECT_EQ(read("[RangeBearingKFSLAM]\nmethod=0\n").builder.retraction, "right-invariant");
  for (const char* method : {"2", "3", "kfIKFFull", "kfIKF"}) {
    const SlamConfig config = read(kalman + "method=" + method + "\n");
    EXPECT_EQ(config.builder.retraction, "right-invariant") << method;
    EXPECT_EQ(config.without_effect, std::vector<std::string>{"[RangeBearingKFSLAM_KalmanFilter] method"}) << method;
  }
}

TEST_F(Config, NamesFileSectionKeyAndValueOfWhatIsWrong) {
  expect_words(testing::input_error_of([&] { read_slam_config(folder_.path() / "none.ini"); }),
               {"none.ini", "found nothing there"});
  expect_words(testing::input_error_of([&] { read_slam_config(folder_.path()); }), {"found a folder"});
  expect_words(refusal("[Other]\nkey = 1\n"), {"a.ini", "[MappingApplication]", "found none"});
  expect_words(refusal("\x1f\x8b no text at all"), {"found none"});
  expect_words(refusal("[MappingApplication]\nSAVE_LOG_FREQUENCY=often\n"),
               {"a.ini", "[MappingApplication] SAVE_LOG_FREQUENCY", "'often'"});
  expect_words(refusal("[MappingApplication]\nSHOW_3D_LIVE=maybe\n"), {"SHOW_3D_LIVE", "true or false", "'maybe'"});
  expect_words(refusal("[MappingApplication]\nkf_implementation=CFastSLAM\n"), {"kf_implementation", "'CFastSLAM'"});
  for (const char* method : {"4", "-1", "00", "UKF", ""}) {
    expect_words(refusal(std::string("[RangeBearingKFSLAM_KalmanFilter]\nmethod=") + method + "\n"),
                 {"a.ini", "[RangeBearingKFSLAM_KalmanFilter] method", "kfIKF (3)", std::string("'") + method + "'"});
  }
  expect_words(refusal("[HelixNav]\nsave_pgn=1\n"), {"[HelixNav] save_pgn", "did you mean 'save_png'"});
  expect_words(refusal("[RangeBearingKFSLAM]\nstd_sensor_range=-1\n"), {"a.ini", "std_sensor_range"});
}

}  // namespace
}  // namespace helixnav::apps
