// SPDX-License-Identifier: BSD-3-Clause
// A session begun anywhere on the map of an earlier one.
#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/named_navigator.hpp"

namespace helixnav::supervisor {
namespace {

using Verdict = core::PlacedDecision::Verdict;

core::JointMap map_of(const core::Recording& run) {
  Navigator navigator(run.start);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  return joint_map(navigator.filter(), navigator.map());
}

/// The recording from this scan on.
core::Recording cut(const core::Recording& run, std::size_t scan) {
  core::Recording rest = run;
  std::size_t scans = 0;
  const auto first = std::find_if(run.events.begin(), run.events.end(), [&](const core::Event& event) {
    return std::holds_alternative<core::Scan>(event) && scans++ == scan;
  });
  rest.events.assign(first, run.events.end());
  const auto skipped = static_cast<std::ptrdiff_t>(scan);
  rest.labels.erase(rest.labels.begin(), rest.labels.begin() + skipped);
  rest.true_poses.erase(rest.true_poses.begin(), rest.true_poses.begin() + skipped);
  return rest;
}

struct Session {
  std::vector<core::PlacedDecision> decisions;
  std::optional<std::size_t> placed_at;
  std::vector<core::PoseGaussian> poses;
  std::vector<core::MapLandmark> map;
};

Session begin_anywhere(const core::Recording& run, const core::JointMap& earlier) {
  Session session;
  Navigator navigator(core::PoseGaussian{});
  navigator.look_for_place_in(earlier);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan);
    session.poses.push_back(report.pose);
    for (const core::Decision& decision : report.decisions) {
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      if (placed == nullptr) continue;
      session.decisions.push_back(*placed);
      if (placed->verdict == Verdict::accepted) session.placed_at = i;
    }
  });
  session.map = navigator.map();
  return session;
}

/// Another drive through the same world, begun at that scan.
core::Recording another_day(std::uint64_t world_seed, std::uint64_t day, std::size_t scan) {
  const sim::Scenario scenario = wide_circuit();
  return cut(sim::simulate_in(sim::build_world(scenario.world, world_seed), scenario, day), scan);
}

TEST(FindPlace, ASessionBegunAnywhereBecomesOneWithTheMap) {
  const core::Recording yesterday = sim::simulate(wide_circuit(), 1);
  const core::JointMap map = map_of(yesterday);
  for (const std::size_t scan : {40u, 130u}) {
    const core::Recording today = another_day(1, 71, scan);
    const Session session = begin_anywhere(today, map);
    ASSERT_TRUE(session.placed_at.has_value());
    EXPECT_EQ(session.decisions.front().verdict, Verdict::sought);
    EXPECT_LE(session.decisions.back().driven_m, 60.0);
    EXPECT_GE(session.decisions.back().pairs, 5);
    for (std::size_t i = *session.placed_at; i < session.poses.size(); ++i) {
      const core::Pose2& truth = today.true_poses[i].T_world_robot;
      EXPECT_LT((session.poses[i].mean.position_m() - truth.position_m()).norm(), 0.8) << "scan " << i;
    }
    const auto mature = std::count_if(session.map.begin(), session.map.end(), [](const core::MapLandmark& landmark) {
      return landmark.state == core::LandmarkState::mature;
    });
    EXPECT_GE(mature, 22);
    EXPECT_LE(mature, 26) << "25 stand there: one map, not two";
  }
}

TEST(FindPlace, AnotherWorldIsNotHereAndTheSessionGoesItsOwnWay) {
  const core::Recording today = another_day(3, 72, 0);
  const Session session = begin_anywhere(today, map_of(sim::simulate(wide_circuit(), 1)));
  EXPECT_FALSE(session.placed_at.has_value());
  ASSERT_GE(session.decisions.size(), 2u) << "was sought, and asked for";
  EXPECT_EQ(session.decisions.back().verdict, Verdict::not_here);
  Navigator alone(core::PoseGaussian{});
  drive(today, alone, [&](const core::Scan& scan, std::size_t i) {
    EXPECT_EQ(alone.observe(scan).pose.mean.vector(), session.poses[i].mean.vector());
  });
}

// So that it can be explained afterwards why there was no answer.
TEST(FindPlace, EveryAnswerIsKeptAndHowFewLandmarksThereWereBefore) {
  const Session session = begin_anywhere(another_day(3, 72, 0), map_of(sim::simulate(wide_circuit(), 1)));
  int questions = 0, most_before = 0;
  for (const core::PlacedDecision& decision : session.decisions) {
    if (decision.verdict == Verdict::sought) {
      EXPECT_EQ(questions, 0);
      EXPECT_TRUE(decision.landmarks == 0 || decision.landmarks > most_before);
      most_before = decision.landmarks;
    } else {
      EXPECT_EQ(decision.questions, ++questions);
    }
  }
  EXPECT_GT(questions, 1);
  EXPECT_GT(most_before, 0);
}

TEST(FindPlace, OnlyASessionThatHasNotBegunMayLook) {
  const core::Recording run = another_day(1, 73, 0);
  const core::JointMap map = map_of(run);
  Navigator navigator(core::PoseGaussian{});
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  EXPECT_THROW(navigator.look_for_place_in(map), core::PreconditionError);
  Navigator other(core::PoseGaussian{});
  core::JointMap none;
  none.joint.covariance = Eigen::MatrixXd::Zero(3, 3);
  EXPECT_THROW(other.look_for_place_in(none), core::PreconditionError);
  core::JointMap torn = map;
  torn.states.pop_back();
  EXPECT_THROW(other.look_for_place_in(torn), core::PreconditionError);
}

/// Interrupted at a scan, saved and resumed: with the same names, the same to 1e-7, at twenty scans drawn at random.
TEST(GoOn, ByNameIsAsIfThereHadBeenNoInterruption) {
  const core::Recording run = sim::simulate(wide_circuit(), 5);
  core::RandomStream random(5, "interruptions");
  for (int k = 0; k < 20; ++k) {
    const double drawn = random.uniform(1.0, static_cast<double>(run.true_poses.size()));
    const auto stop = static_cast<std::size_t>(drawn);
    NamedNavigator whole(run.start);
    std::optional<NamedNavigator> resumed;
    std::map<core::Label, core::LandmarkId> names;
    std::size_t scans = 0;
    for (const core::Event& event : run.events) {
      const bool is_scan = std::holds_alternative<core::Scan>(event);
      const std::vector<core::Label> labels = is_scan ? run.labels[scans++] : std::vector<core::Label>{};
      const auto report = whole.take(event, labels);
      if (resumed) resumed->take(event, labels);
      if (!report || scans > stop) continue;
      for (const core::AssociationReport& a : report->associations) {
        if (a.landmark >= 0) names[labels[static_cast<std::size_t>(a.observation)]] = a.landmark;
      }
      if (scans == stop) resumed.emplace(joint_map(whole.filter(), whole.map()), names);
    }
    const std::vector<core::LandmarkId> ids = whole.filter().landmarks();
    ASSERT_EQ(resumed->filter().landmarks(), ids) << "interrupted after scan " << stop;
    const core::JointGaussian a = whole.filter().joint(ids);
    const core::JointGaussian b = resumed->filter().joint(ids);
    EXPECT_LT((a.pose.vector() - b.pose.vector()).norm(), 1e-7);
    EXPECT_LT((a.covariance - b.covariance).cwiseAbs().maxCoeff(), 1e-7 * a.covariance.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_LT((a.points_m[i] - b.points_m[i]).norm(), 1e-7);
  }
}

TEST(GoOn, FromAKnownPlaceTheMapIsRecognisedAtOnce) {
  const core::Recording run = sim::simulate(wide_circuit(), 6);
  const core::JointMap map = map_of(run);
  Navigator navigator = Navigator::go_on_in(map);
  std::size_t matched = 0, augmented = 0;
  const core::Recording again = another_day(6, 74, 0);  // the drive ends where it began
  core::Recording first = again;
  first.events.resize(60);
  drive(first, navigator, [&](const core::Scan& scan, std::size_t) {
    for (const core::AssociationReport& a : navigator.observe(scan).associations) {
      matched += a.outcome == core::Outcome::matched;
      augmented += a.outcome == core::Outcome::augmented;
    }
  });
  EXPECT_GT(matched, 20 * augmented);
}

}  // namespace
}  // namespace helixnav::supervisor
