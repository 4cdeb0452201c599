// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/thin_scan.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"

namespace helixnav::core {
namespace {

Scan circle_of(std::size_t count, double radius_m, double sigma_m) {
  Scan scan;
  for (std::size_t i = 0; i < count; ++i) {
    const double bearing_rad = 2.0 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count) - pi;
    scan.observations.push_back(make_range_bearing(radius_m, bearing_rad, sigma_m, sigma_m / radius_m));
  }
  return scan;
}

TEST(ThinScan, LeavesScansOfUsualSizeAlone) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, most_observations_used}) {
    const std::vector<std::size_t> used = observations_to_use(circle_of(count, 10.0, 5.0));
    ASSERT_EQ(used.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(used[i], i);
  }
}

TEST(ThinScan, KeepsOneOfThoseThatTheSensorCannotTellApart) {
  Scan scan;
  for (int i = 0; i < 3000; ++i) {
    const double place_m = i % 3 == 0 ? 10.0 : i % 3 == 1 ? 20.0 : 30.0;
    scan.observations.push_back(make_range_bearing(place_m + 1e-4 * (i % 7), 1.0, 0.1, 0.01));
  }
  const std::vector<std::size_t> used = observations_to_use(scan);
  ASSERT_EQ(used.size(), 3u);
  std::vector<double> ranges_m;
  for (const std::size_t i : used) ranges_m.push_back(std::round(scan.observations[i].z[0]));
  std::sort(ranges_m.begin(), ranges_m.end());
  EXPECT_EQ(ranges_m, (std::vector<double>{10.0, 20.0, 30.0}));
}

TEST(ThinScan, SpreadsWhatItKeepsOverTheScan) {
  const Scan scan = circle_of(10'000, 100.0, 1e-3);
  const std::vector<std::size_t> used = observations_to_use(scan);
  ASSERT_EQ(used.size(), most_observations_used);
  EXPECT_TRUE(std::is_sorted(used.begin(), used.end()));
  for (std::size_t k = 1; k < used.size(); ++k) {
    EXPECT_GE(used[k] - used[k - 1], 39u);
    EXPECT_LE(used[k] - used[k - 1], 40u);
  }
}

TEST(ThinScan, SpreadsAlsoWhatIsLittleMoreThanEnough) {
  const std::vector<std::size_t> used = observations_to_use(circle_of(most_observations_used + 9, 100.0, 1e-3));
  ASSERT_EQ(used.size(), most_observations_used);
  for (std::size_t k = 1; k < used.size(); ++k) EXPECT_LE(used[k] - used[k - 1], 2u);
}

TEST(ThinScan, KeepsBearingsAcrossTheSeamForOneObject) {
  Scan scan;
  for (int i = 0; i < 400; ++i) scan.observations.push_back(make_bearing(i % 2 == 0 ? pi - 1e-4 : -pi + 1e-4, 0.01));
  EXPECT_EQ(observations_to_use(scan).size(), 1u);
}

TEST(ThinScan, NamesReportsInTheWholeScan) {
  std::vector<AssociationReport> all = reports_of_none(6);
  std::vector<AssociationReport> reports(2);
  reports[0] = {0, Outcome::matched, 7, 1.5, 2, 3.0};
  reports[1] = {1, Outcome::augmented, 8, 0.0, 0, 0.0};
  name_in_whole_scan({1, 4}, all, reports);
  ASSERT_EQ(reports.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const AssociationReport& report = reports[static_cast<std::size_t>(i)];
    EXPECT_EQ(report.observation, i);
    EXPECT_EQ(report.outcome, i == 1 ? Outcome::matched : i == 4 ? Outcome::augmented : Outcome::ambiguous);
    EXPECT_EQ(report.landmark, i == 1 ? 7 : i == 4 ? 8 : no_landmark);
  }
}

}  // namespace
}  // namespace helixnav::core
