// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/detect_reflectors.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "helixnav/core/angle.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "real_data.hpp"

namespace helixnav::logs {
namespace {

struct RecordedPole {
  double surface_range_m;
  double bearing_from_right_rad;
  int beams;
};

std::map<std::size_t, std::vector<RecordedPole>> recorded_poles(const std::filesystem::path& csv) {
  std::map<std::size_t, std::vector<RecordedPole>> poles;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::size_t scan = 0;
    char comma = ',';
    double t_s = 0.0;
    RecordedPole pole{};
    fields >> scan >> comma >> t_s >> comma >> pole.surface_range_m >> comma >> pole.bearing_from_right_rad >> comma >>
        pole.beams;
    poles[scan].push_back(pole);
  }
  return poles;
}

class DetectReflectorsInTheCarPark : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("carpark"); }
};

TEST_F(DetectReflectorsInTheCarPark, EqualsTheRecordedDetectionsOnEveryScan) {
  const AcfrLog log = read_car_park_mat(path_ / "raw/data_set.mat");
  auto recorded = recorded_poles(path_ / "reflector_detections.csv");
  const ReflectorRules rules;
  ASSERT_EQ(log.scans.size(), 586u);
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const auto poles = detect_reflectors(log.scans[i]);
    ASSERT_EQ(poles.size(), recorded[i].size()) << "scan " << i;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      EXPECT_NEAR(poles[k].range_m, recorded[i][k].surface_range_m + rules.pole_diameter_m / 2.0, 6e-5) << "scan " << i;
      EXPECT_NEAR(poles[k].bearing_rad, recorded[i][k].bearing_from_right_rad - core::pi / 2.0, 6e-7) << "scan " << i;
      EXPECT_EQ(poles[k].beams_hit, recorded[i][k].beams) << "scan " << i;
    }
  }
}

TEST(DetectReflectors, JoinsBrightBeamsAcrossSmallGapsOnly) {
  SickScan scan;
  scan.range_cm.fill(1000);
  scan.reflectivity[180] = scan.reflectivity[183] = scan.reflectivity[187] = 1;
  const auto poles = detect_reflectors(scan);
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_EQ(poles[0].beams_hit, 2);
  EXPECT_NEAR(poles[0].bearing_rad, 1.5 * core::pi / 360.0, 1e-12);
  EXPECT_NEAR(poles[0].range_m, 10.03, 1e-12);
}

TEST(DetectReflectors, IgnoresDarkAndFarBeams) {
  SickScan scan;
  scan.range_cm.fill(1000);
  scan.range_cm[180] = 3000;
  scan.reflectivity[180] = 4;
  EXPECT_TRUE(detect_reflectors(scan).empty());
}

}  // namespace
}  // namespace helixnav::logs
