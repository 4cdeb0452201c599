// SPDX-License-Identifier: BSD-3-Clause
#include "window/window.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "judged_drive.hpp"
#include "labelled_drive.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {
namespace {

association::LandmarkLife existence_of(const std::vector<core::LandmarkId>& ids) {
  association::LandmarkLife existence;
  for (const core::LandmarkId id : ids) {
    association::LandmarkRecord record;
    record.id = id;
    existence.adopt(record);
  }
  return existence;
}

/// Landmark i stands i metres from the origin; 4 is missing.
std::vector<atlas::Place> row_of_9() {
  std::vector<atlas::Place> places;
  for (const int i : {0, 1, 2, 3, 5, 6, 7, 8, 9}) places.push_back({i, {static_cast<double>(i), 0.0}});
  return places;
}

TEST(ChooseWindow, HoldsEverythingNearAndTheNearestOfTheRest) {
  const ChosenWindow few = choose_window(row_of_9(), {0.0, 0.0}, {6.5, 2, 100});
  EXPECT_EQ(few.ids, (std::vector<core::LandmarkId>{0, 1, 2, 3, 5, 6}));
  EXPECT_DOUBLE_EQ(few.window.radius_m, 7.0);
  EXPECT_DOUBLE_EQ(few.window.reach_from({3.0, 4.0}), 2.0);
  EXPECT_EQ(choose_window(row_of_9(), {0.0, 0.0}, {6.5, 7, 100}).ids.size(), 7u);
  EXPECT_EQ(choose_window(row_of_9(), {9.0, 0.0}, {6.5, 2, 3}).ids, (std::vector<core::LandmarkId>{7, 8, 9}));
  const ChosenWindow all = choose_window(row_of_9(), {0.0, 0.0}, {6.5, 50, 100});
  EXPECT_EQ(all.ids.size(), 9u);
  EXPECT_TRUE(std::isinf(all.window.radius_m));
}

TEST(PlacesAbout, AreAllThatAWindowIsChosenFrom) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  LabelledDrive drive(run, false);
  DriveMap map(drive.start(), 20.0);
  map.take(drive.tape, drive.filter);
  map.settle();
  std::vector<core::LandmarkId> ids = drive.filter.landmarks();
  ASSERT_GT(ids.size(), 15u);
  ids.erase(ids.begin() + 7);  // one that no longer exists
  const association::LandmarkLife existence = existence_of(ids);
  std::vector<atlas::Place> all = map.atlas().places_of(ids);
  for (const Eigen::Vector2d& center_m : {map.atlas().pose().position_m(), all[4].point_m}) {
    for (const WindowNeeds& needs : {WindowNeeds{20.0, 3, 100}, WindowNeeds{1.0, 8, 100}, WindowNeeds{60.0, 2, 6},
                                     WindowNeeds{500.0, 2, 9}, WindowNeeds{0.0, 1000, 1000}}) {
      const ChosenWindow expected = choose_window(all, center_m, needs);
      const auto about = places_about(map.atlas(), existence, center_m, needs, 5.0, 2000.0);
      const ChosenWindow chosen = choose_window(about, center_m, needs);
      EXPECT_EQ(chosen.ids, expected.ids) << needs.least_radius_m;
      EXPECT_EQ(chosen.window.radius_m, expected.window.radius_m) << needs.least_radius_m;
    }
  }
}

sim::Scenario town_of_3_km() {
  sim::Scenario scenario = sim::named_scenario("town");
  scenario.world.tour_m = 3000.0;
  return scenario;
}

long closed(const evaluation::RunScore& score) {
  return std::count_if(score.returns.begin(), score.returns.end(), [](const auto& one) { return one.closed; });
}

// A window far below what a town of this size needs, so that there are many hand-overs and every search widens it.
TEST(Window, ClosesWhatTheWholeMapCloses) {
  constexpr std::uint64_t seed = 5;
  NavigatorOptions narrow;
  narrow.map.whole = narrow.map.window = 200;
  const evaluation::RunScore whole = navigate_and_judge(town_of_3_km(), seed);
  const evaluation::RunScore window = navigate_and_judge(town_of_3_km(), seed, narrow);
  EXPECT_GE(whole.closures.size(), 2u) << "or it shows nothing";
  EXPECT_NE(window.verdict, evaluation::RunVerdict::false_closure);
  for (const evaluation::ClosureScore& closure : window.closures) EXPECT_EQ(closure.wrong_pairs, 0);
  EXPECT_GE(closed(window), closed(whole));
  EXPECT_LE(window.duplicates, whole.duplicates + 2);
  EXPECT_LT(window.map_rms_m, whole.map_rms_m + 0.1);
}

/// Landmarks in the filter after each scan.
std::vector<int> held_along(const sim::Scenario& scenario, const NavigatorOptions& options) {
  const core::Recording run = sim::simulate(scenario, 1);
  Navigator navigator(run.start, options);
  std::vector<int> held;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) {
    navigator.observe(scan);
    held.push_back(navigator.filter().mapped_count());
  });
  return held;
}

TEST(Window, HalvesTheFilterWhenItBegins) {
  sim::Scenario scenario = town_of_3_km();
  scenario.world.tour_m = 1500.0;
  NavigatorOptions narrow;
  narrow.map.whole = narrow.map.window = 60;
  const std::vector<int> held = held_along(scenario, narrow);
  std::size_t first = 1;
  while (first < held.size() && held[first] > held[first - 1] - 30) ++first;  // not a merge, nor landmarks dying
  ASSERT_LT(first, held.size()) << "no hand-over";
  EXPECT_GT(held[first - 1], 120);
  EXPECT_LT(held[first], 0.6 * held[first - 1]);
}

/// An exact drive past trees that a sensor sees all round up to 19 m away.
class LongWay {
 public:
  explicit LongWay(std::vector<Eigen::Vector2d> trees_m, const NavigatorOptions& options)
      : trees_m_(std::move(trees_m)), navigator_(core::PoseGaussian{}, options) {}

  void drive_to(const Eigen::Vector2d& goal_m) {
    const Eigen::Vector2d way_m = goal_m - at_.position_m();
    const double heading_rad = std::atan2(way_m.y(), way_m.x());
    const int steps = static_cast<int>(std::lround(way_m.norm()));
    for (int k = 0; k < steps; ++k) {
      const core::Pose2 next(at_.x_m + way_m.x() / steps, at_.y_m + way_m.y() / steps, heading_rad);
      core::Odometry odometry;
      odometry.T_before_after = core::between(at_, next);
      odometry.covariance.diagonal() << 1e-6, 1e-6, 1e-9;
      navigator_.move(odometry);
      at_ = next;
      navigator_.observe(scan());
    }
  }
  const Navigator& navigator() const { return navigator_; }

 private:
  core::Scan scan() const {
    core::Scan scan;
    scan.field_of_view = {0.5, 20.0, -core::pi, core::pi};
    for (const Eigen::Vector2d& tree_m : trees_m_) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(at_), tree_m);
      if (seen_m.norm() < 19.0)
        scan.observations.push_back(
            core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.05, 0.003));
    }
    return scan;
  }

  std::vector<Eigen::Vector2d> trees_m_;
  core::Pose2 at_{-60.0, 100.0, 0.0};
  Navigator navigator_;
};

// A lone tree is met again, which confirms nothing; then a bare stretch leads to a road that was mapped at the
// beginning and is no longer in the window.
TEST(Window, IsHandedOverAtItsEdgeWhereNothingHasConfirmedThePose) {
  std::vector<Eigen::Vector2d> trees_m{{-60.0, 104.0}};
  for (int i = 0; i < 21; ++i) trees_m.emplace_back(10.0 * i, -5.0);
  for (int i = 1; i < 30; ++i) trees_m.emplace_back(205.0, 10.0 * i);
  for (int i = 0; i < 26; ++i) trees_m.emplace_back(200.0 - 10.0 * i, 305.0);
  for (int i = 0; i < 14; ++i) trees_m.emplace_back(-65.0, 290.0 - 10.0 * i);
  NavigatorOptions narrow;
  narrow.map.whole = narrow.map.window = 30;
  LongWay way(trees_m, narrow);
  const Eigen::Vector2d lone_m(-60.0, 100.0), begin_m(0.0, 0.0);
  way.drive_to(begin_m);
  for (const Eigen::Vector2d& corner_m :
       {Eigen::Vector2d(200.0, 0.0), Eigen::Vector2d(200.0, 300.0), Eigen::Vector2d(-60.0, 300.0), lone_m, begin_m}) {
    way.drive_to(corner_m);
  }
  EXPECT_LT(way.navigator().filter().mapped_count(), 60) << "or there is no window";
  way.drive_to({200.0, 0.0});
  EXPECT_EQ(way.navigator().map().size(), trees_m.size());
}

TEST(Window, BeginsNotWhereAScanSeesATwentiethOfTheMap) {
  NavigatorOptions narrow;
  narrow.map.whole = narrow.map.window = 6;
  narrow.map.most = 8;
  const std::vector<int> held = held_along(wide_circuit(), narrow);  // of 25 landmarks a scan sees 4
  EXPECT_GT(held.back(), 20);
  for (std::size_t k = 1; k < held.size(); ++k) EXPECT_GT(held[k], held[k - 1] - 3) << k;
}

}  // namespace
}  // namespace helixnav::supervisor
