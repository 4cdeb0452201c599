// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/navigator.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

using core::Outcome;

/// The compressed EKF driven by whoever knows all names: nothing of the supervisor.
cekf::CompressedEkf driven_by_hand(const core::Recording& run) {
  cekf::CompressedEkf filter(run.start);
  std::map<core::Label, core::LandmarkId> landmarks;
  std::optional<core::Odometry> motion;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
      continue;
    }
    const auto& scan = std::get<core::Scan>(event);
    if (motion) filter.predict(*motion);
    motion.reset();
    const std::vector<core::Label>& labels = run.labels[scans++];
    std::vector<cekf::Match> matches;
    std::vector<std::size_t> fresh;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (landmarks.count(labels[i]) > 0) {
        matches.push_back({landmarks[labels[i]], scan.observations[i], scan.T_robot_sensor});
      } else if (labels[i] != core::no_label) {
        fresh.push_back(i);
      }
    }
    if (!matches.empty()) filter.update(matches);
    for (const std::size_t i : fresh) landmarks[labels[i]] = filter.augment(scan.observations[i], scan.T_robot_sensor);
    filter.switch_region_if_due();
  }
  return filter;
}

TEST(Navigator, OfKnownAssociationIsTheCompressedEkfBitForBit) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 0.5;  // without a name, so without effect
  const core::Recording run = sim::simulate(scenario, 1);
  Navigator navigator(run.start);
  int switches = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    switches += navigator.observe(scan, run.labels[i]).switched_region ? 1 : 0;
  });
  const cekf::CompressedEkf by_hand = driven_by_hand(run);
  EXPECT_GE(switches, 5);
  EXPECT_EQ(navigator.pose().mean.vector(), by_hand.pose().mean.vector());
  EXPECT_EQ(navigator.pose().covariance, by_hand.pose().covariance);
  ASSERT_EQ(navigator.filter().landmarks(), by_hand.landmarks());
  for (const core::MapLandmark& landmark : navigator.map()) {
    EXPECT_EQ(landmark.point.mean_m, by_hand.landmark(landmark.id).mean_m);
    EXPECT_EQ(landmark.point.covariance_m2, by_hand.landmark(landmark.id).covariance_m2);
    EXPECT_EQ(landmark.state, core::LandmarkState::mature);
  }
}

/// Matches to a landmark that another label began, over one run.
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

TEST(Navigator, MakesNoWrongMatchAmongWellSeparatedLandmarksAndIsConsistent) {
  constexpr int runs = 20;
  double nees_sum = 0.0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
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
  EXPECT_GE(nees_sum, core::chi2_quantile(0.005, 3 * runs));
  EXPECT_LE(nees_sum, core::chi2_quantile(0.995, 3 * runs));
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
  EXPECT_LT(left_of_clutter, 5 * 30);  // those of the last metres, whose time has not come
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

/// One scan of one landmark ahead.
core::Scan one_look(core::Nanoseconds t_ns) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view.max_range_m = 30.0;
  scan.observations = {core::make_range_bearing(10.0, 0.1, 0.1, 0.02)};
  return scan;
}

core::Odometry one_metre(core::Nanoseconds t_ns) {
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = core::Pose2(1.0, 0.0, 0.02);
  odometry.covariance = Eigen::Vector3d(1e-2, 1e-3, 1e-4).asDiagonal();
  return odometry;
}

TEST(Navigator, RefusesAWrongNumberOfIdentitiesAndStaysAsItWas) {
  Navigator navigator(core::PoseGaussian{});
  navigator.move(one_metre(1));
  navigator.observe(one_look(1), {4});
  const core::PoseGaussian before = navigator.pose();
  navigator.move(one_metre(2));  // pending motion waits for the next scan that is taken
  const std::vector<std::int64_t> none;
  const std::vector<std::int64_t> two{4, 5};
  EXPECT_THROW(navigator.observe(one_look(2), none), core::PreconditionError);
  EXPECT_THROW(navigator.observe(one_look(2), two), core::PreconditionError);
  EXPECT_EQ(navigator.pose().mean.vector(), before.mean.vector());
  EXPECT_EQ(navigator.pose().covariance, before.covariance);
  EXPECT_EQ(navigator.filter().mapped_count(), 1);
  EXPECT_EQ(navigator.map().front().observations, 1);
}

TEST(Navigator, LosesNoMotionToACallThatItRefused) {
  Navigator refused(core::PoseGaussian{});
  Navigator plain(core::PoseGaussian{});
  for (Navigator* navigator : {&refused, &plain}) {
    navigator->observe(one_look(0), {4});
    navigator->move(one_metre(1));
  }
  EXPECT_THROW(refused.observe(one_look(1), std::vector<std::int64_t>{}), core::PreconditionError);
  const core::StepReport a = refused.observe(one_look(1), {4});
  const core::StepReport b = plain.observe(one_look(1), {4});
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.pose.mean.vector(), b.pose.mean.vector());
  EXPECT_EQ(a.pose.covariance, b.pose.covariance);
}

TEST(Navigator, TakesANewIdentityOnceAScan) {
  Navigator navigator(core::PoseGaussian{});
  core::Scan scan = one_look(0);
  scan.observations.push_back(scan.observations.front());
  const core::StepReport report = navigator.observe(scan, {4, 4});
  EXPECT_EQ(report.associations[0].outcome, Outcome::augmented);
  EXPECT_EQ(report.associations[1].outcome, Outcome::rejected);
  EXPECT_EQ(navigator.filter().mapped_count(), 1);
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
