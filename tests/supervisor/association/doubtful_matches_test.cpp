// SPDX-License-Identifier: BSD-3-Clause
#include "association/doubtful_matches.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "association/association_report.hpp"

namespace helixnav::supervisor {
namespace {

core::Observation tree_at(double range_m) { return core::make_range_bearing(range_m, 0.0, 0.2, 0.01); }

core::Scan scan_with(const core::Observation& seen) {
  core::Scan scan;
  scan.field_of_view = {0.0, 30.0, -core::pi, core::pi, 30.0};
  scan.observations = {seen};
  return scan;
}

/// A vehicle that mapped one landmark 10 m ahead, among false alarms of which `died` have died since.
struct MappedTree {
  explicit MappedTree(int died) : filter(core::PoseGaussian{}), id(filter.augment(tree_at(10.0), core::Pose2())) {
    for (core::LandmarkId other = 1; other <= died; ++other) {
      life.observe({0.0, 0.0}, {}, {other}, {});
      life.drive(31.0);
      life.observe({0.0, 0.0}, {}, {}, {});
    }
    life.observe({0.0, 0.0}, {}, {id}, {});
  }

  std::vector<association::UnusedSighting> look(double range_m) {
    const core::Scan scan = scan_with(tree_at(range_m));
    const GatedScan gated = gate_scan(filter, {id}, scan, {});
    reports = association_reports(gated.assignment);
    EXPECT_EQ(reports.front().outcome, core::Outcome::matched) << "or it shows nothing";
    return leave_doubtful_unused(gated, life, scan, {}, reports);
  }

  cekf::CompressedEkf filter;
  association::LandmarkLife life;
  core::LandmarkId id;
  std::vector<core::AssociationReport> reports;
};

TEST(DoubtfulMatches, AreUsedWhereLandmarksBegunAreTrees) {
  MappedTree drive(0);
  EXPECT_TRUE(drive.look(10.1).empty());
  EXPECT_TRUE(drive.look(10.7).empty());  // NIS 6
  EXPECT_EQ(drive.reports.front().outcome, core::Outcome::matched);
}

TEST(DoubtfulMatches, AreLeftUnusedWhereMostLandmarksBegunWereFalseAlarms) {
  MappedTree drive(200);
  EXPECT_TRUE(drive.look(10.02).empty()) << "too near to be chance";
  const std::vector<association::UnusedSighting> doubtful = drive.look(10.8);  // NIS 8
  ASSERT_EQ(doubtful.size(), 1u);
  EXPECT_EQ(doubtful.front().id, drive.id);
  EXPECT_EQ(drive.reports.front().outcome, core::Outcome::ambiguous);
  // λ: (201 + 10)/(401 + 10) false alarms over 30 m · 2π; S twice the detector's noise.
  const double lambda = 211.0 / 411.0 / (30.0 * 2.0 * core::pi);
  const double likelihood = std::exp(-0.5 * 0.64 / 0.08) / (2.0 * core::pi * std::sqrt(0.08 * 2e-4));
  EXPECT_NEAR(doubtful.front().nats, std::log(0.9 * likelihood / lambda), 0.02);
}

TEST(DoubtfulMatches, NeverOfAMatureLandmark) {
  MappedTree drive(200);
  for (int k = 1; k <= 8; ++k) drive.life.observe({0.5 * k, 0.0}, {drive.id}, {}, {});
  ASSERT_EQ(drive.life.state(drive.id), core::LandmarkState::mature);
  EXPECT_TRUE(drive.look(10.8).empty());
}

}  // namespace
}  // namespace helixnav::supervisor
