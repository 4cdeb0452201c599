// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that was carried, which no scan right after it reveals: what it maps from then on does. When it was, a pause tells, or the
// landmarks do.
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "pauses.hpp"

namespace helixnav::supervisor {
namespace {

struct ByPlace {
  core::CarriedDecision decision;
  std::size_t scan = 0;
};

struct FoundLater {
  std::vector<ByPlace> by_place;
  int refused = 0;  ///< places that the whole map had
  int placed = 0;
  double error_at_end_m = 0.0;
};

FoundLater drive_on(const core::Recording& run, const NavigatorOptions& options = {}) {
  FoundLater driven;
  Navigator navigator(run.start, options);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      const auto* carried = std::get_if<core::CarriedDecision>(&decision);
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      const auto* asked = std::get_if<core::WholeMapDecision>(&decision);
      driven.placed += placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
      driven.refused += asked != nullptr && asked->verdict == core::WholeMapDecision::Verdict::refused;
      const bool is_by_place = carried != nullptr && carried->cause == core::CarriedDecision::Cause::by_place;
      if (is_by_place) driven.by_place.push_back({*carried, i});
    }
  });
  driven.error_at_end_m =
      (navigator.pose().mean.position_m() - run.true_poses.back().T_world_robot.position_m()).norm();
  return driven;
}

/// The first scan at or after the time.
std::size_t first_scan(const core::Recording& run, core::Nanoseconds t_ns) {
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (!std::holds_alternative<core::Scan>(event)) continue;
    if (core::time_of(event) >= t_ns) return scans;
    ++scans;
  }
  return scans;
}

void expect_part_since_the_last_carry(const core::Recording& run, const FoundLater& driven) {
  ASSERT_EQ(driven.by_place.size(), 1u);
  const ByPlace& found = driven.by_place[0];
  EXPECT_EQ(found.scan - static_cast<std::size_t>(found.decision.scans), first_scan(run, run.true_carries_ns.back()));
  EXPECT_GE(driven.placed, 2) << "the first time it was noticed at once";
  EXPECT_EQ(driven.refused, 1) << "the answer that it was found by";
  EXPECT_LT(driven.error_at_end_m, 5.0);
}

/// Two trees are where two of those that it left would be. The map has two parts by then, and no drive is kept that could be cut.
TEST(PartAtPause, WhereTreesHappenToStandAsThoseItLeft) {
  const core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3400054);
  const FoundLater driven = drive_on(run);
  expect_part_since_the_last_carry(run, driven);  // 207 m off at the end, ten answers of the whole map refused
  ASSERT_EQ(driven.by_place.size(), 1u);
  EXPECT_LT(driven.by_place[0].decision.scans, 40);
}

/// Set down on a bare street. The search that then begins goes from one attempt to the next where its prior places the
/// vehicle, and asked the whole map after 541 m.
TEST(PartAtPause, WhereASearchGoesOnInAWrongPrior) {
  const core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3400030);
  const FoundLater driven = drive_on(run);
  expect_part_since_the_last_carry(run, driven);
  ASSERT_EQ(driven.by_place.size(), 1u);
  EXPECT_LT(driven.by_place[0].decision.scans, 120);
}

/// Set down on a bare street; what it mapped after that was cut off, and what it had mapped before stayed where it
/// never was: from then on the vehicle was found on either street in turn.
TEST(PartAtPause, LeavesNothingWhereItNeverWas) {
  const core::Recording run = sim::simulate(sim::named_scenario("kidnapped"), 3900028);
  const FoundLater driven = drive_on(run);
  EXPECT_EQ(driven.by_place.size(), 1u);
  EXPECT_EQ(driven.placed, 2);
  EXPECT_LT(driven.error_at_end_m, 5.0);
}

/// The first scan after the last time that it was carried.
std::size_t scan_after_last_carry(const core::Recording& run) {
  constexpr double farther_than_it_drives_m = 20.0;
  std::size_t scan = run.true_poses.size() - 1;
  const auto moved_m = [&] {
    return core::between(run.true_poses[scan - 1].T_world_robot, run.true_poses[scan].T_world_robot)
        .position_m()
        .norm();
  };
  while (scan > 1 && moved_m() < farther_than_it_drives_m) --scan;
  return scan;
}

/// No pause tells when it was carried, and no drive is kept that could be cut, as in an earlier session's map: the landmarks tell, which
/// are all new since. A few of those before were matched by chance.
TEST(PartAtPause, WhereTheLandmarksTellWhenItWas) {
  const core::Recording run = without_waiting(sim::simulate(sim::named_scenario("kidnapped"), 3400054));
  NavigatorOptions options;
  options.search.smooth_up_to_scans = 100;
  const FoundLater driven = drive_on(run, options);  // 246 m off at the end, 22 answers of the whole map refused
  ASSERT_EQ(driven.by_place.size(), 1u);
  const ByPlace& found = driven.by_place[0];
  const std::size_t begun = found.scan - static_cast<std::size_t>(found.decision.scans);
  EXPECT_GE(begun, scan_after_last_carry(run));
  EXPECT_LE(begun, scan_after_last_carry(run) + 20) << "for so long, trees stand as those that it left";
  EXPECT_LT(driven.error_at_end_m, 5.0);
}

/// What a search mapped before the whole map was sure, and before the search began, does not stay where it never was.
TEST(PartAtPause, WhereItWasCarriedLongBeforeTheSearch) {
  const core::Recording run = without_waiting(sim::simulate(sim::named_scenario("kidnapped"), 3400030));
  NavigatorOptions options;
  options.search.smooth_up_to_scans = 100;
  const FoundLater driven = drive_on(run, options);
  EXPECT_EQ(driven.by_place.size(), 2u);
  EXPECT_EQ(driven.placed, 2);
  EXPECT_LT(driven.error_at_end_m, 5.0);
}

/// A drive that is kept as a whole is cut instead.
TEST(PartAtPause, NotWithoutAPauseWhereTheDriveIsKept) {
  const core::Recording run = without_waiting(sim::simulate(sim::named_scenario("kidnapped"), 3400054));
  EXPECT_TRUE(drive_on(run).by_place.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
