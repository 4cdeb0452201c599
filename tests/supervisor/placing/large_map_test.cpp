// SPDX-License-Identifier: BSD-3-Clause
// Sessions on a map that the filter does not hold as a whole, and that is kept as factors.
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/pose_on_map.hpp"

namespace helixnav::supervisor {
namespace {

using Verdict = core::PlacedDecision::Verdict;

/// A loop counts as large.
NavigatorOptions small_windows() {
  NavigatorOptions options;
  options.map.whole = options.map.window = 30;
  options.search.relocalizer.threads = 1;
  return options;
}

core::Recording on_day(std::uint64_t day, std::uint64_t world_seed = 3) {
  const sim::Scenario scenario = sim::named_scenario("large-loop");
  return sim::simulate_in(sim::build_world(scenario.world, world_seed), scenario, day);
}

std::ptrdiff_t trees_in(const core::Recording& run) { return static_cast<std::ptrdiff_t>(run.true_landmarks.size()); }

struct LargeSession {
  Navigator navigator;
  std::vector<core::PoseGaussian> poses;
  std::vector<core::Decision> decisions;
};

LargeSession driven(const core::Recording& run, Navigator navigator) {
  LargeSession session{std::move(navigator), {}, {}};
  drive(run, session.navigator, [&](const core::Scan& scan, std::size_t) {
    const core::StepReport report = session.navigator.observe(scan);
    session.poses.push_back(report.pose);
    session.decisions.insert(session.decisions.end(), report.decisions.begin(), report.decisions.end());
  });
  return session;
}

core::JointMap large_map(std::uint64_t day) {
  const core::Recording run = on_day(day);
  const LargeSession session = driven(run, Navigator(run.start, small_windows()));
  std::optional<core::JointMap> map = session.navigator.factored_map();
  EXPECT_TRUE(map.has_value());
  return *map;
}

std::optional<core::PlacedDecision> placing_in(const LargeSession& session) {
  for (const core::Decision& decision : session.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr && placed->verdict == Verdict::accepted) return *placed;
  }
  return std::nullopt;
}

std::ptrdiff_t mature_in(const std::vector<core::MapLandmark>& map) {
  return std::count_if(map.begin(), map.end(),
                       [](const auto& landmark) { return landmark.state == core::LandmarkState::mature; });
}

TEST(LargeMap, HasFactorsAndNoJointCovariance) {
  const core::JointMap map = large_map(70);
  ASSERT_NE(map.factors, nullptr);
  EXPECT_FALSE(map.has_covariance());
  EXPECT_EQ(map.covariances_m2.size(), map.joint.ids.size());
  const core::Recording run = on_day(70);
  EXPECT_GE(static_cast<std::ptrdiff_t>(map.joint.ids.size()), trees_in(run) - 2);
  const LargeSession whole = driven(run, Navigator(run.start));
  EXPECT_TRUE(whole.navigator.factored_map().has_value()) << "also where one filter holds it";
}

TEST(LargeMap, ASessionBegunAnywhereBecomesOneWithTheMap) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(71);
  Navigator navigator(core::PoseGaussian{}, small_windows());
  navigator.look_for_place_in(map);
  const LargeSession session = driven(today, std::move(navigator));
  const std::optional<core::PlacedDecision> placed = placing_in(session);
  ASSERT_TRUE(placed.has_value());
  const core::Pose2& truth = today.true_poses.back().T_world_robot;
  EXPECT_LT((session.poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
  const std::vector<core::MapLandmark> both = session.navigator.map();
  EXPECT_GE(mature_in(both), trees_in(today) - 3);
  EXPECT_LE(mature_in(both), trees_in(today) + 1) << "one map, not two";
  EXPECT_LT(session.navigator.filter().mapped_count(), static_cast<int>(both.size())) << "the filter holds a part";
}

/// The path of the scans before, in the frame in which the session had it until then.
TEST(LargeMap, TheDriveBeforeItWasPlacedIsSolvedWithTheMap) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(72);
  Navigator navigator(core::PoseGaussian{}, small_windows());
  navigator.look_for_place_in(map);
  std::vector<core::StampedPose> solved;
  core::Pose2 T_map_session;
  drive(today, navigator, [&](const core::Scan& scan, std::size_t) {
    core::StepReport report = navigator.observe(scan);
    for (const core::Decision& decision : report.decisions) {
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      if (placed == nullptr || placed->verdict != Verdict::accepted) continue;
      T_map_session = placed->T_map_session;
      solved = std::move(report.solved);
    }
  });
  ASSERT_GT(solved.size(), 10u);
  for (std::size_t k = 0; k < solved.size(); ++k) {
    ASSERT_EQ(solved[k].t_ns, today.true_poses[k].t_ns);
    const core::Pose2 on_map = core::compose(T_map_session, solved[k].T_world_robot);
    EXPECT_LT((on_map.position_m() - today.true_poses[k].T_world_robot.position_m()).norm(), 0.8) << "scan " << k;
  }
}

/// From where the session that made the map ended: as if it had not been interrupted, but for open searches, what is not
/// linearised again, and how sure it was of each landmark.
TEST(LargeMap, GoesOnWhereTheMapEnded) {
  const core::Recording run = on_day(73);
  const std::size_t half = run.true_poses.size() / 2;
  Navigator first(run.start, small_windows());
  std::optional<Navigator> second;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    first.take(event);
    if (second) second->take(event);
    if (!std::holds_alternative<core::Scan>(event) || scans++ != half) continue;
    const std::optional<core::JointMap> map = first.factored_map();
    ASSERT_TRUE(map.has_value());
    second.emplace(Navigator::go_on_in(*map, small_windows()));
    EXPECT_LT((second->pose().mean.vector() - first.pose().mean.vector()).norm(), 0.02);
  }
  ASSERT_TRUE(second.has_value());
  EXPECT_LT((second->pose().mean.vector() - first.pose().mean.vector()).norm(), 0.05);
  EXPECT_NEAR(second->pose().covariance.trace(), first.pose().covariance.trace(),
              0.1 * first.pose().covariance.trace());
  EXPECT_EQ(mature_in(second->map()), mature_in(first.map()));
}

TEST(LargeMap, GoesOnFromAPoseThatWasGiven) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(74);
  const core::PoseGaussian start{today.start.mean, Eigen::Vector3d(0.25, 0.25, 0.0025).asDiagonal()};
  Navigator begun = Navigator::go_on_in(begun_at(map, start), small_windows());
  EXPECT_LT((begun.pose().mean.vector() - today.start.mean.vector()).norm(), 1e-3);
  const core::PoseGaussian on_map = pose_on_map(begun.filter(), map.next_name);
  EXPECT_LT((on_map.covariance - start.covariance).norm(), 0.01 * start.covariance.norm());
  const LargeSession session = driven(today, std::move(begun));
  const core::Pose2& truth = today.true_poses.back().T_world_robot;
  EXPECT_LT((session.poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
  EXPECT_LE(mature_in(session.navigator.map()), trees_in(today) + 1);
  EXPECT_TRUE(session.navigator.factored_map().has_value()) << "the next session can continue in it";
}

TEST(LargeMap, GoesOnFromAPoseThatIsCertain) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(74);
  Navigator begun = Navigator::go_on_in(begun_at(map, {today.start.mean, Eigen::Matrix3d::Zero()}), small_windows());
  const LargeSession session = driven(today, std::move(begun));
  const core::Pose2& truth = today.true_poses.back().T_world_robot;
  EXPECT_LT((session.poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
}

TEST(LargeMap, IsKeptAsFactorsWhenTheVehicleIsCarried) {
  const core::Recording run = on_day(75);
  LargeSession before = driven(run, Navigator(run.start, small_windows()));
  before.navigator.lose({});
  const std::map<int, core::JointMap> apart = before.navigator.maps_apart();
  ASSERT_EQ(apart.size(), 1u);
  EXPECT_NE(apart.begin()->second.factors, nullptr);
  const LargeSession after = driven(on_day(76), std::move(before.navigator));
  ASSERT_TRUE(placing_in(after).has_value());
  EXPECT_LE(mature_in(after.navigator.map()), trees_in(run) + 1);
}

/// For localisation: landmarks independent of each other, each known relative to its neighbours.
TEST(LargeMap, IsDrawnAsASmallOneIs) {
  const core::Recording run = on_day(70);
  const LargeSession session = driven(run, Navigator(run.start, small_windows()));
  const core::JointMap large = *session.navigator.factored_map();
  core::JointMap small = large;
  small.factors = nullptr;
  small.joint = session.navigator.joint(large.joint.ids);
  const core::JointMap drawn = as_drawn(large, 30.0, 0.15);
  const core::JointMap expected = as_drawn(small, 30.0, 0.15);
  ASSERT_NE(drawn.factors, nullptr);
  ASSERT_EQ(drawn.joint.ids, expected.joint.ids);
  const core::JointGaussian joint = atlas::Atlas::from_factors(*drawn.factors).joint(drawn.joint.ids);
  constexpr double rounding_m2 = 5e-5;  // of 0.01: the one is linearised in squares, the other all at once
  EXPECT_EQ(drawn.states, expected.states);
  for (std::size_t i = 0; i < joint.ids.size(); ++i) {
    EXPECT_LT((joint.points_m[i] - drawn.joint.points_m[i]).norm(), 1e-9);
    EXPECT_LT((drawn.covariances_m2[i] - expected.covariance_m2_of(i)).norm(), rounding_m2);
  }
  Eigen::MatrixXd difference = joint.covariance - expected.joint.covariance;
  difference.topLeftCorner<3, 3>().setZero();  // of the last pose, which means nothing
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), rounding_m2);
}

/// The vehicle is carried off the map, maps a little there, and is carried back: what it mapped there stays apart.
TEST(LargeMap, TheWindowMovesWhileAPartIsApart) {
  const core::Recording run = on_day(75);
  LargeSession before = driven(run, Navigator(run.start, small_windows()));
  before.navigator.lose({});
  core::Recording elsewhere = on_day(79, 4);
  elsewhere.events.resize(elsewhere.events.size() / 8);
  LargeSession off = driven(elsewhere, std::move(before.navigator));
  ASSERT_FALSE(placing_in(off).has_value());
  off.navigator.lose({});
  ASSERT_EQ(off.navigator.maps_apart().size(), 2u);
  const LargeSession after = driven(on_day(76), std::move(off.navigator));
  ASSERT_TRUE(placing_in(after).has_value());
  EXPECT_EQ(after.navigator.maps_apart().size(), 1u);
  EXPECT_LE(mature_in(after.navigator.map()), trees_in(run) + 1);
}

/// What came of a drive that was not kept is one factor of the map; the drive from there on is kept.
TEST(LargeMap, ASessionWhoseDriveWasNotKeptIsPlacedAndIsAPartOfTheMap) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(77);
  NavigatorOptions options = small_windows();
  options.search.smooth_up_to_scans = 0;
  Navigator navigator(core::PoseGaussian{}, options);
  navigator.look_for_place_in(map);
  const LargeSession session = driven(today, std::move(navigator));
  ASSERT_TRUE(placing_in(session).has_value());
  const core::Pose2& truth = today.true_poses.back().T_world_robot;
  EXPECT_LT((session.poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
  EXPECT_LE(mature_in(session.navigator.map()), trees_in(today) + 1);
  EXPECT_TRUE(session.navigator.factored_map().has_value());
}

TEST(LargeMap, CannotBeGoneOnInWithoutSearchesOrByRestarting) {
  const core::JointMap map = large_map(70);
  NavigatorOptions restarting = small_windows(), without = small_windows();
  restarting.search.closing = ClosingMethod::restart;
  without.search.enabled = false;
  for (const NavigatorOptions& options : {restarting, without}) {
    EXPECT_THROW(Navigator::go_on_in(map, options), core::PreconditionError);
    EXPECT_THROW(Navigator(core::PoseGaussian{}, options).look_for_place_in(map), core::PreconditionError);
  }
}

/// One filter holds it, and it is continued as a drive all the same: what came before the place was found is solved with it. Where no
/// drive can be kept, its joint covariance is used.
TEST(LargeMap, ASmallMapHasFactorsToo) {
  const core::Recording first = on_day(70), today = on_day(72);
  const LargeSession yesterday = driven(first, Navigator(first.start));
  const std::optional<core::JointMap> map = map_to_go_on_in(yesterday.navigator, yesterday.navigator.map(), 2000);
  ASSERT_TRUE(map.has_value());
  EXPECT_TRUE(map->has_covariance());
  ASSERT_NE(map->factors, nullptr);
  Navigator navigator(core::PoseGaussian{}, {});
  navigator.look_for_place_in(*map);
  std::size_t solved = 0;
  drive(today, navigator,
        [&](const core::Scan& scan, std::size_t) { solved += navigator.observe(scan).solved.size(); });
  EXPECT_GT(solved, 10u);
  EXPECT_EQ(navigator.filter().mapped_count(), static_cast<int>(navigator.map().size()));
  EXPECT_LE(mature_in(navigator.map()), trees_in(today) + 1);
  NavigatorOptions without;
  without.search.enabled = false;
  const Navigator in_one_filter = Navigator::go_on_in(*map, without);
  EXPECT_LT((in_one_filter.pose().covariance - map->joint.covariance.topLeftCorner<3, 3>()).norm(), 1e-12);
}

TEST(LargeMap, AnotherWorldIsNotHere) {
  const core::JointMap map = large_map(70);
  const core::Recording today = on_day(72, 4);
  Navigator navigator(core::PoseGaussian{}, small_windows());
  navigator.look_for_place_in(map);
  EXPECT_FALSE(placing_in(driven(today, std::move(navigator))).has_value());
}

}  // namespace
}  // namespace helixnav::supervisor
