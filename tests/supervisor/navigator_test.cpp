// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/navigator.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "campaign.hpp"
#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

using core::Outcome;

/// Matches, over one run, to a landmark that was begun by another label.
struct Association {
  int matched = 0;
  int wrong = 0;
  int duplicates = 0;  ///< labels that have a second mature landmark in the end
  double final_nees = 0.0;
};

Association associate_unknown(const core::Recording& run, Navigator& navigator) {
  Association result;
  std::map<core::LandmarkId, core::Label> label_of;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    for (const core::AssociationReport& a : navigator.observe(scan).associations) {
      const core::Label label = run.labels[i][static_cast<std::size_t>(a.observation)];
      if (a.outcome == Outcome::augmented) label_of[a.landmark] = label;
      if (a.outcome != Outcome::matched) continue;
      ++result.matched;
      if (label_of.at(a.landmark) != label) ++result.wrong;
    }
  });
  std::map<core::Label, int> mature;
  for (const core::MapLandmark& landmark : navigator.map()) {
    if (landmark.state == core::LandmarkState::mature && ++mature[label_of.at(landmark.id)] == 2) ++result.duplicates;
  }
  result.final_nees = nees(navigator.pose(), run.true_poses.back().T_world_robot);
  return result;
}

TEST(NavigatorCampaign, MakesNoWrongMatchAmongWellSeparatedLandmarksAndIsConsistent) {
  const int runs = support::campaign_runs(20);
  double nees_sum = 0.0;
  for (const std::uint64_t seed : support::campaign_seeds(1, 20)) {
    SCOPED_TRACE(seed);
    const core::Recording run = sim::simulate(wide_circuit(), seed);
    Navigator navigator(run.start);
    const Association result = associate_unknown(run, navigator);
    EXPECT_GT(result.matched, 1000);
    EXPECT_EQ(result.wrong, 0);
    EXPECT_EQ(result.duplicates, 0);
    nees_sum += result.final_nees;
  }
  // One pose a run, so that the sum is χ² with 3 degrees of freedom a run; false alarm 1 %.
  const support::Band band = support::chi2_band(runs, 3, 0.01);
  EXPECT_GE(nees_sum, band.low);
  EXPECT_LE(nees_sum, band.high);
}

TEST(Navigator, BuriesWhatClutterBegan) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 1.0;
  int born_of_clutter = 0;
  int mature_of_clutter = 0;
  int left_of_clutter = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const core::Recording run = sim::simulate(scenario, seed);
    Navigator navigator(run.start);
    std::map<core::LandmarkId, int> looks_at_trees;
    drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
      for (const core::AssociationReport& a : navigator.observe(scan).associations) {
        const bool is_tree = run.labels[i][static_cast<std::size_t>(a.observation)] != core::no_label;
        if (a.outcome == Outcome::augmented && !is_tree) ++born_of_clutter;
        if (a.landmark != core::no_landmark) looks_at_trees[a.landmark] += is_tree ? 1 : 0;
      }
    });
    for (const core::MapLandmark& landmark : navigator.map()) {
      if (looks_at_trees[landmark.id] > 0) continue;
      ++left_of_clutter;
      mature_of_clutter += landmark.state == core::LandmarkState::mature ? 1 : 0;
    }
  }
  EXPECT_GT(born_of_clutter, 500);
  EXPECT_EQ(mature_of_clutter, 0);
  EXPECT_LT(left_of_clutter, 5 * 30);  // those of the last metres, not yet due to be dropped
}

// Beside a laser that sees where the trees are, a radio measures how far something is.
TEST(Navigator, LeavesRangesAndBearingsAloneUnused) {
  Navigator navigator((core::PoseGaussian()));
  core::Scan laser, radio;
  laser.field_of_view = radio.field_of_view = {0.0, 30.0, -core::pi, core::pi, 30.0};
  for (const double bearing_rad : {-1.0, 0.0, 1.0}) {
    laser.observations.push_back(core::make_range_bearing(10.0, bearing_rad, 0.05, 0.005));
  }
  radio.observations = {core::make_range(10.02, 0.05), core::make_bearing(1.001, 0.005)};
  for (int k = 0; k < 20; ++k) {
    core::Odometry moved = core::no_motion(1'000'000'000L * (k + 1));
    moved.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    laser.t_ns = radio.t_ns = moved.t_ns;
    navigator.move(moved);
    navigator.observe(laser);
    const core::PoseGaussian before = navigator.pose();
    for (const core::AssociationReport& one : navigator.observe(radio).associations) {
      EXPECT_EQ(one.outcome, Outcome::ambiguous);
    }
    EXPECT_EQ(navigator.pose().mean.vector(), before.mean.vector());
    EXPECT_EQ(navigator.map().size(), 3U) << "not refuted by what the radio does not tell";
  }
}

TEST(Navigator, KeepsNoTraceOfALandmarkThatDied) {
  const core::Recording run = sim::simulate(wide_circuit(), 7);
  constexpr std::size_t spoilt_scan = 30;
  Navigator clean(run.start);
  Navigator spoilt(run.start);
  core::LandmarkId ghost = core::no_landmark;
  bool was_mapped = false;
  drive(run, clean, [&](const core::Scan& scan, std::size_t) { clean.observe(scan); });
  drive(run, spoilt, [&](const core::Scan& scan, std::size_t i) {
    core::Scan seen = scan;
    if (i == spoilt_scan) seen.observations.push_back(core::make_range_bearing(29.5, 0.6, 0.1, 0.017));
    const core::StepReport report = spoilt.observe(seen);
    if (i != spoilt_scan) return;
    ASSERT_EQ(report.associations.back().outcome, Outcome::augmented) << "the place is taken: choose another";
    ghost = report.associations.back().landmark;
    was_mapped = spoilt.filter().contains(ghost);
  });
  EXPECT_TRUE(was_mapped);
  EXPECT_FALSE(spoilt.filter().contains(ghost));
  EXPECT_LT((spoilt.pose().mean.vector() - clean.pose().mean.vector()).norm(), 1e-9);
  EXPECT_LT((spoilt.pose().covariance - clean.pose().covariance).norm(), 1e-9 * clean.pose().covariance.norm());
  const std::vector<core::MapLandmark> with = spoilt.map();
  const std::vector<core::MapLandmark> without = clean.map();
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_LT((with[i].point.mean_m - without[i].point.mean_m).norm(), 1e-9);
    EXPECT_EQ(with[i].observations, without[i].observations);
    EXPECT_EQ(with[i].state, without[i].state);
  }
}

TEST(Navigator, ReportsEveryObservationOnceAndInOrder) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 1.0;
  const core::Recording run = sim::simulate(scenario, 3);
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan);
    EXPECT_EQ(report.step, static_cast<std::int64_t>(i));
    EXPECT_EQ(report.t_ns, scan.t_ns);
    ASSERT_EQ(report.associations.size(), scan.observations.size());
    int rows = 0;
    for (std::size_t k = 0; k < report.associations.size(); ++k) {
      EXPECT_EQ(report.associations[k].observation, static_cast<int>(k));
      if (report.associations[k].outcome == Outcome::matched) rows += report.associations[k].dof;
    }
    EXPECT_EQ(report.joint_dof, rows);
    EXPECT_EQ(report.mapped_landmarks, navigator.filter().mapped_count());
  });
}

}  // namespace
}  // namespace helixnav::supervisor
