// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <gtest/gtest.h>

#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

class OwnLogRefusal : public ::testing::Test {
 protected:
  /// The error contains this if the file has that text.
  void expect(const std::string& file, const std::string& text, const std::string& said) const {
    const OwnLogFolder log;
    log.write(file, text);
    const std::string error = log.error();
    EXPECT_NE(error.find(said), std::string::npos) << "no \"" << said << "\" in: " << error;
  }
};

TEST_F(OwnLogRefusal, OfAMissingColumnNamesIt) {
  expect("odometry.csv", "v,omega\n1,0\n", "odometry.csv:1:1: expected a column t_s, found only: v, omega");
  expect("odometry.csv", "t,v\n0,1\n", "odometry.csv:1:1: expected a column");
  expect("odometry.csv", "t,dx\n0,1\n", "odometry.csv:1:1: expected a column dheading_rad");
  expect("odometry.csv", "t,a,b\n0,1,1\n", "odometry.csv:1:1: no odometry in these columns");
  expect("detections.csv", "range_m,bearing_deg\n1,1\n", "detections.csv:1:1: expected a column t_s");
  expect("detections.csv", "t,x_m\n0,1\n", "detections.csv:1:1: expected a column y_m");
  expect("detections.csv", "t\n0\n", "detections.csv:1:1: no detections in these columns");
  expect("fixes.csv", "t,x\n0,1\n", "fixes.csv:1:1: expected a column y_m");
  expect("truth_poses.csv", "t,y,heading\n0,1,1\n", "truth_poses.csv:1:1: expected a column x_m");
  expect("truth_landmarks.csv", "id,x\n0,1\n", "truth_landmarks.csv:1:1: expected a column y_m");
}

TEST_F(OwnLogRefusal, OfADoubledColumnNamesBoth) {
  expect("odometry.csv", "t,v,v,omega\n0,1,1,0\n", "odometry.csv:1:5: column 'v' is there twice");
  expect("odometry.csv", "t,v_mps,omega_radps,omega_degps\n0,1,1,0\n",
         "odometry.csv:1:21: column 'omega_radps' and 'omega_degps' are the same; keep one");
  expect("odometry.csv", "t,v,omega,dx,dheading\n0,1,0,1,0\n", "the columns make two kinds of odometry");
}

TEST_F(OwnLogRefusal, OfAMisspeltColumnProposesTheNearest) {
  expect("odometry.csv", "t,v_msp,omega\n0,1,0\n", "odometry.csv:1:3: unknown column 'v_msp'; did you mean 'v_mps'?");
  expect("detections.csv", "t,rnage_m,bearing_deg\n0,1,0\n",
         "detections.csv:1:3: unknown column 'rnage_m'; did you mean 'range_m'?");
  expect("detections.csv", "t,range_m,bearing_degr\n0,1,0\n", "did you mean 'bearing_deg'?");
}

TEST_F(OwnLogRefusal, OfNumbersThatAreNoneNamesThePlace) {
  expect("detections.csv", "t,range_m,bearing_deg\n0,1,2\n0, x1,2\n",
         "detections.csv:3:4: expected a number for range_m, found 'x1'");
  expect("detections.csv", "t,range_m,bearing_deg\n0,nan,2\n",
         "detections.csv:2:3: expected a number for range_m, found 'nan'");
  expect("odometry.csv", "t,v,omega\n0,,2\n", "odometry.csv:2:3: expected a number for v, found an empty cell");
  expect("odometry.csv", "t;v;omega\n0;1,5;2\n",
         "odometry.csv:2:3: expected a number with a decimal point for v, found '1,5'");
}

/// Found by fuzzing: it was taken for a bug in the program and ended it.
TEST_F(OwnLogRefusal, OfAZeroByteInAClassNamesThePlace) {
  const std::string zero(1, '\0');
  expect("detections.csv", "t,range_m,bearing_deg,class\n0,1,2,o" + zero + "k\n",
         "detections.csv:2:7: a zero byte in class");
}

TEST_F(OwnLogRefusal, OfUnitsThatCannotBeMeantSaysWhatToDo) {
  expect(
      "detections.csv", "t,range_m,bearing\n0,1,90\n",
      "detections.csv:2:5: expected bearing within ±2π radians; if it is in degrees, end its name in _deg, found '90'");
  expect("detections.csv", "t,range_m,bearing_deg\n0,1,400\n", "expected bearing_deg within ±360 degrees");
  expect("detections.csv", "t,range_m,bearing_deg\n0,-1,4\n", "detections.csv:2:3: expected range_m greater than 0");
  expect("detections.csv", "t,range_m,bearing_deg\n0,0,4\n", "detections.csv:2:3: expected range_m greater than 0");
  expect("odometry.csv", "t,v,omega\n1e19,1,1\n", "odometry.csv:2:1: expected t from -4e+09 to 4e+09");
}

TEST_F(OwnLogRefusal, OfEmptyFilesAndTablesNamesThem) {
  expect("odometry.csv", "", "odometry.csv:1:1: expected a line that names the columns, found nothing");
  expect("detections.csv", "t,range_m,bearing_deg\n", "detections.csv:1:1: a line of columns and no rows below it");
}

TEST_F(OwnLogRefusal, OfTimesThatGoBackByMoreThanASecondNamesThePlace) {
  expect("odometry.csv", "t,v,omega\n0,1,0\n5,1,0\n3.5,1,0\n",
         "odometry.csv:4:1: the time goes back by 1.5 s, to 3.5 s; rows are sorted within 1 s only");
}

TEST_F(OwnLogRefusal, OfHalfANoiseOrOneThatIsNone) {
  expect("detections.csv", "t,range_m,bearing_deg,sigma_range_m,sigma_bearing_deg\n0,1,1,0.1,\n", "detections.csv:2:");
  expect("detections.csv", "t,x_m,y_m,cov_xx,cov_xy,cov_yy\n0,1,1,1,2,1\n",
         "detections.csv:2:7: this covariance is not positive definite");
  expect("odometry.csv", "t,dx,dheading,cov_xx,cov_xy,cov_xh,cov_yy,cov_yh,cov_hh\n0,1,0,1,2,0,1,0,1\n",
         "odometry.csv:2:7: this covariance is not positive semidefinite");
  expect("odometry.csv", "t,x,y,heading,sigma_x,sigma_heading\n0,1,0,1,2,0\n",
         "odometry.csv:1:1: column sigma_x does not fit");
}

TEST_F(OwnLogRefusal, OfAPointAndARangeInOneRow) {
  expect("detections.csv", "t,range_m,bearing_deg,x_m,y_m\n0,1,1,1,1\n",
         "detections.csv:2:7: a point and a range or bearing in one row");
}

TEST_F(OwnLogRefusal, OfClocksThatDoNotOverlapSaysWhatToDo) {
  expect("detections.csv", "t,range_m,bearing_deg\n1700000000,1,1\n", "do not overlap");
}

TEST_F(OwnLogRefusal, OfAVehicleThatDoesNotTellWhatIsNeeded) {
  expect("vehicle.toml", "", "vehicle.toml: no noise of a detection is given");
  expect("vehicle.toml", "[[sensor]]\nsigma_range_m=1\nsigma_bearing_deg=1\n",
         "vehicle.toml: no noise of the odometry is given");
  expect("vehicle.toml", "[[sensor]]\nsigma_range_m = 0.1\n", "sigma_bearing_deg in section [[sensor]]");
  expect("odometry.csv", "t,v,steering_deg\n0,1,0\n2,1,0\n", "needs wheelbase_m");
  expect("odometry.csv", "t,v_left,v_right\n0,1,0\n2,1,0\n", "needs track_m");
  expect("detections.csv", "t,range_m,bearing_deg,sensor\n0,1,1,left\n0,1,1,right\n", "nothing thrown");
  expect("vehicle.toml", "[[sensor]]\nname='a'\n[[sensor]]\nname='b'\n",
         "the column sensor of the detections is missing, or empty in a row, and the vehicle (");
  expect("vehicle.toml", "[[sensor]]\nname='a'\n[[sensor]]\nname='b'\n", "has the sensors a, b: expected one of them");
}

TEST_F(OwnLogRefusal, OfAFolderWithoutATableSaysWhatIsThere) {
  const testing::TemporaryFolder folder;
  folder.write("odometry.csv", "t,v,omega\n0,1,0\n");
  const std::string error = testing::input_error_of([&] { read_own_log(folder.path()); });
  EXPECT_NE(
      error.find("detections.csv: a log needs odometry.csv and detections.csv; found in the folder: odometry.csv"),
      std::string::npos)
      << error;
}

TEST_F(OwnLogRefusal, OfJsonLinesNamesLineAndPlace) {
  const testing::TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    const auto path = folder.write("a.jsonl", text);
    return testing::input_error_of([&] { read_own_log(path); });
  };
  EXPECT_NE(error("{\"odometri\": {}}\n").find("a.jsonl:1:2: unknown name 'odometri'; the nearest is 'odometry'"),
            std::string::npos);
  EXPECT_NE(
      error("{\"odometry\": {\"t\": 0, \"v_msp\": 1, \"omega\": 0}}\n").find("a.jsonl:1:23: unknown column 'v_msp'"),
      std::string::npos);
  EXPECT_NE(error("{\"odometry\": {\"t\": 0, \"v\": \"fast\", \"omega\": 0}}\n")
                .find("a.jsonl:1:23: expected a number for v, found 'fast'"),
            std::string::npos);
  EXPECT_NE(error("[1]\n").find("a.jsonl:1:1: expected an object in braces"), std::string::npos);
  EXPECT_NE(error("{\"odometry\": {\"t\": 0, \"v\": 1, \"omega\": 0}}\n").find("a.jsonl: no line of detections"),
            std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
