// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <matio.h>

#include "helixnav/logs/acfr_log.hpp"
#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

class CarPark : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("carpark/raw/data_set.mat"); }
};

TEST_F(CarPark, HasTheReadingsTheirOrderAndTheSurveyedPoles) {
  const AcfrLog log = read_car_park_mat(path_);
  EXPECT_EQ(log.dead_reckoning.size(), 5001u);
  EXPECT_EQ(log.scans.size(), 586u);
  EXPECT_EQ(log.gps.size(), 626u);
  EXPECT_EQ(log.order.size(), 6213u);
  ASSERT_EQ(log.beacons.size(), 15u);
  EXPECT_NEAR(log.beacons[0].point_m.x(), 2.8953, 1e-4);
  EXPECT_NEAR(log.beacons[0].point_m.y(), -4.0353, 1e-4);
  EXPECT_EQ(log.dead_reckoning[0].t_ns, 45'024'000'000);
  EXPECT_NEAR(log.gps[0].position_m.x(), 5.1048, 1e-4);
  EXPECT_EQ(log.scans[0].range_cm[334], 1156);
  EXPECT_EQ(log.scans[0].reflectivity[334], 1);
  EXPECT_EQ(log.scans[0].reflectivity[20], 4);
}

class VictoriaParkMat : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("victoria_park/raw"); }
};

TEST_F(VictoriaParkMat, StandsOnTheClockOfTheTextRelease) {
  const AcfrLog mat = read_victoria_park_mat(path_);
  const AcfrLog text = read_acfr_ascii(path_ / "victoria_park_ascii.zip");
  ASSERT_EQ(mat.dead_reckoning.size(), 61945u);
  ASSERT_EQ(mat.gps.size(), 4466u);
  EXPECT_EQ(mat.scans.size(), 7230u);
  for (std::size_t i = 0; i < text.dead_reckoning.size(); ++i) {
    ASSERT_EQ(mat.dead_reckoning[i].t_ns, text.dead_reckoning[i].t_ns);
    ASSERT_NEAR(mat.dead_reckoning[i].wheel_speed_mps, text.dead_reckoning[i].wheel_speed_mps, 6e-4);
  }
  std::size_t found = 0;
  for (const GpsFix& fix : text.gps) {
    found += std::any_of(mat.gps.begin(), mat.gps.end(), [&](const GpsFix& all) {
      const Eigen::Vector2d moved_m = all.position_m - mat.gps[0].position_m;
      return all.t_ns == fix.t_ns && (moved_m - fix.position_m).lpNorm<Eigen::Infinity>() < 6e-3;
    });
  }
  EXPECT_EQ(found, text.gps.size());
}

TEST_F(VictoriaParkMat, IsInOrderOfTime) {
  const AcfrLog log = read_victoria_park_mat(path_);
  EXPECT_EQ(log.order.size(), log.dead_reckoning.size() + log.gps.size() + log.scans.size());
}

/// Writes a real matrix (by columns) into an open file.
void add(mat_t* file, const std::string& name, std::size_t rows, std::size_t columns, std::vector<double> values) {
  std::size_t size[2] = {rows, columns};
  matvar_t* variable = Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, values.data(), 0);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
}

/// A car park log with one reading of each sensor.
struct SmallCarPark {
  std::vector<double> dead_reckoning_times{1.0, 1.5};
  std::vector<double> speeds{2.0, 2.0};
  std::size_t beams = 361;
  double range_m = 5.0;
  bool has_intensity = true;
  std::vector<double> order_of_rows{1, 1, 1, 2};

  std::filesystem::path write(const TemporaryFolder& folder) const {
    const std::filesystem::path path = folder.path() / "data_set.mat";
    mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
    add(file, "Time", 1, 4, {1.0, 1.1, 1.2, 1.5});
    add(file, "Sensor", 1, 4, {2, 1, 3, 2});
    add(file, "Index", 1, 4, order_of_rows);
    add(file, "Time_VS", 1, 2, dead_reckoning_times);
    add(file, "Velocity", 1, speeds.size(), speeds);
    add(file, "Steering", 1, 2, {0.1, 0.1});
    add(file, "TimeGPS", 1, 1, {1.1});
    add(file, "GPSLon", 1, 1, {3.0});
    add(file, "GPSLat", 1, 1, {4.0});
    add(file, "TimeLaser", 1, 1, {1.2});
    add(file, "Laser", 1, beams, std::vector<double>(beams, range_m));
    if (has_intensity) {
      add(file, "Intensity", 1, beams, std::vector<double>(beams, 8192.0));
    }
    Mat_Close(file);
    return path;
  }

  std::string error() const {
    const TemporaryFolder folder;
    const auto path = write(folder);
    const std::string message = input_error_of([&] { read_car_park_mat(path); });
    return message.substr(std::min(message.size(), path.string().size() + 2));
  }
};

TEST(CarParkMat, ReadsASmallOneWithoutSurvey) {
  const TemporaryFolder folder;
  const AcfrLog log = read_car_park_mat(SmallCarPark().write(folder));
  EXPECT_EQ(log.order.size(), 4u);
  EXPECT_EQ(log.scans.at(0).range_cm[7], 500);
  EXPECT_TRUE(log.beacons.empty());
}

TEST(CarParkMat, NamesTheVariableThatIsWrong) {
  SmallCarPark nan;
  nan.speeds[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(nan.error(), "variable Velocity, element 2: expected a finite number");
  SmallCarPark wild;
  wild.speeds[0] = 1e6;
  EXPECT_EQ(
      wild.error(),
      "variables Velocity, Steering, element 1: expected up to 100 m/s and 1.2 rad, found 1000000.000000 and 0.100000");
  SmallCarPark backwards;
  backwards.dead_reckoning_times = {1.0, 0.5};
  EXPECT_EQ(backwards.error(),
            "variable Time_VS, element 2: expected a time that does not go backwards, found 0.500000 s");
  SmallCarPark longer;
  longer.speeds.push_back(1.0);
  EXPECT_EQ(longer.error(), "variable Velocity: expected a vector of 2 numbers, found 1 by 3");
  SmallCarPark narrow;
  narrow.beams = 181;
  EXPECT_EQ(narrow.error(), "variable Laser: expected 1 by 361, found 1 by 181");
  SmallCarPark negative;
  negative.range_m = -1.0;
  EXPECT_EQ(negative.error(), "variable Laser: expected values in 0 … 655.350000, found -1.000000");
  SmallCarPark dark;
  dark.has_intensity = false;
  EXPECT_NE(dark.error().find("expected a variable Intensity, found Time, Sensor"), std::string::npos);
  SmallCarPark disorder;
  disorder.order_of_rows[3] = 1;
  EXPECT_NE(disorder.error().find("element 4: expected row 2 of sensor 2"), std::string::npos);
}

TEST(CarParkMat, RefusesAFileCutOffAnywhere) {
  const TemporaryFolder folder;
  const auto path = SmallCarPark().write(folder);
  const double whole = static_cast<double>(std::filesystem::file_size(path));
  for (const double kept : {0.9, 0.7, 0.5, 0.3, 0.1, 0.03, 0.0}) {
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(kept * whole));
    EXPECT_NE(input_error_of([&] { read_car_park_mat(path); }).find("data_set.mat: "), std::string::npos) << kept;
  }
}

TEST(CarParkMat, RefusesGarbageAndNothing) {
  const TemporaryFolder folder;
  const auto garbage = folder.write("data_set.mat", std::string(5000, '\xa7'));
  EXPECT_NE(input_error_of([&] { read_car_park_mat(garbage); }).find("data_set.mat: "), std::string::npos);
  EXPECT_NE(
      input_error_of([&] { read_car_park_mat(folder.path() / "none.mat"); }).find("expected a file that can be read"),
      std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
