// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/detect_trees.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "helixnav/core/angle.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "real_data.hpp"

namespace helixnav::logs {
namespace {

struct PublishedTree {
  double range_m;
  double bearing_rad;
  double diameter_m;
};

std::map<std::size_t, std::vector<PublishedTree>> published_trees(const std::filesystem::path& csv) {
  std::map<std::size_t, std::vector<PublishedTree>> trees;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::size_t scan = 0;
    char comma = ',';
    double t_s = 0.0;
    PublishedTree tree{};
    fields >> scan >> comma >> t_s >> comma >> tree.range_m >> comma >> tree.bearing_rad >> comma >> tree.diameter_m;
    tree.bearing_rad -= core::pi / 2.0;
    trees[scan].push_back(tree);
  }
  return trees;
}

/// Equal to half a unit of the last digit in the file (5 of range and diameter, 6 of bearing), plus 1e-6.
bool equal(const SickDetection& ours, const PublishedTree& theirs) {
  return std::abs(ours.range_m - theirs.range_m) < 6e-6 && std::abs(ours.bearing_rad - theirs.bearing_rad) < 1.5e-6 &&
         std::abs(ours.diameter_m - theirs.diameter_m) < 6e-6;
}

bool equal(const std::vector<SickDetection>& ours, const std::vector<PublishedTree>& theirs) {
  bool all = ours.size() == theirs.size();
  for (std::size_t i = 0; all && i < ours.size(); ++i) {
    all = equal(ours[i], theirs[i]);
  }
  return all;
}

class DetectTreesInVictoriaPark : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("victoria_park"); }
};

TEST_F(DetectTreesInVictoriaPark, EqualsThePublishedDetectionsOnEveryScan) {
  const AcfrLog log = read_acfr_ascii(path_ / "raw/victoria_park_ascii.zip");
  auto published = published_trees(path_ / "tree_detections.csv");
  ASSERT_EQ(log.scans.size(), 7230u);
  int different = 0;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    different += equal(detect_trees(log.scans[i]), published[i]) ? 0 : 1;
  }
  EXPECT_EQ(different, 0);
}

SickScan empty_scan() {
  SickScan scan;
  scan.range_cm.fill(8191);
  return scan;
}

/// `beams` returns at `range_cm` from `first` on.
void put(SickScan& scan, std::size_t first, std::size_t beams, std::uint16_t range_cm) {
  for (std::size_t i = first; i < first + beams; ++i) {
    scan.range_cm[i] = range_cm;
  }
}

TEST(DetectTrees, FindsNothingWhereNothingReturns) { EXPECT_TRUE(detect_trees(empty_scan()).empty()); }

TEST(DetectTrees, PlacesALoneTrunkAtItsCentreCounterClockwiseFromAhead) {
  SickScan scan = empty_scan();
  put(scan, 269, 3, 1000);
  const auto trees = detect_trees(scan);
  ASSERT_EQ(trees.size(), 1u);
  const double diameter_m = 3 * core::pi / 360.0 * 10.0;
  EXPECT_NEAR(trees[0].diameter_m, diameter_m, 1e-12);
  EXPECT_NEAR(trees[0].range_m, 10.0 + diameter_m / 2.0, 1e-12);
  EXPECT_NEAR(trees[0].bearing_rad, core::pi / 4.0, 1e-12);
  EXPECT_EQ(trees[0].beams_hit, 3);
}

TEST(DetectTrees, RejectsTwoTrunksThatStandTooCloseForTrees) {
  SickScan scan = empty_scan();
  put(scan, 180, 2, 1000);
  put(scan, 195, 2, 1000);
  EXPECT_TRUE(detect_trees(scan).empty());
  TreeRules rules;
  rules.isolation_m = 1.0;
  EXPECT_EQ(detect_trees(scan, rules).size(), 2u);
}

TEST(DetectTrees, RejectsTheTrunkBehindAnother) {
  SickScan scan = empty_scan();
  put(scan, 180, 3, 1000);
  put(scan, 183, 3, 2000);
  const auto trees = detect_trees(scan);
  ASSERT_EQ(trees.size(), 1u);
  EXPECT_LT(trees[0].range_m, 11.0);
}

TEST(DetectTrees, RejectsAWall) {
  SickScan scan = empty_scan();
  put(scan, 100, 20, 1000);
  EXPECT_TRUE(detect_trees(scan).empty());
}

TEST(DetectTrees, TakesNothingAtTheEndsOfTheFieldOfView) {
  SickScan scan = empty_scan();
  put(scan, 5, 2, 1000);
  put(scan, 354, 2, 1000);
  EXPECT_TRUE(detect_trees(scan).empty());
}

}  // namespace
}  // namespace helixnav::logs
