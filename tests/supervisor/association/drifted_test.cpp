// SPDX-License-Identifier: BSD-3-Clause
// Meeting what the vehicle no longer knows where to look for is a return, however short the way was.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "association/gated_scan.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {
namespace {

core::Observation glimpse(double range_m, double bearing_rad) {
  return core::make_range_bearing(range_m, bearing_rad, 0.05, 0.01);
}

/// A camera that sees 10 m far, 40° to either side.
core::Scan scan_of(std::vector<core::Observation> observations) {
  core::Scan scan;
  scan.field_of_view = {0.2, 10.0, -0.7, 0.7};
  scan.observations = std::move(observations);
  return scan;
}

core::Odometry turned(double turn_rad, double sigma_rad) {
  core::Odometry odometry;
  odometry.T_before_after.heading_rad = turn_rad;
  odometry.covariance.diagonal() << 1e-6, 1e-6, sigma_rad * sigma_rad;
  return odometry;
}

core::Odometry ahead(double way_m) {
  core::Odometry odometry;
  odometry.T_before_after.x_m = way_m;
  odometry.covariance.diagonal() << 1e-6, 1e-6, 1e-8;
  return odometry;
}

/// Two landmarks are mapped 5 m ahead; then the vehicle turns once on the spot, seeing nothing.
Navigator that_turned_around(double sigma_rad) {
  Navigator navigator{core::PoseGaussian{}};
  for (int i = 0; i < 12; ++i) {
    const double way_m = 0.1 * i;
    navigator.observe(scan_of({glimpse(std::hypot(6.0 - way_m, 0.0), 0.0),
                               glimpse(std::hypot(6.0 - way_m, 3.0), std::atan2(3.0, 6.0 - way_m))}));
    navigator.move(ahead(0.1));
  }
  constexpr int parts = 16;
  for (int i = 0; i < parts; ++i) {
    navigator.move(turned(2.0 * core::pi / parts, sigma_rad / std::sqrt(static_cast<double>(parts))));
    navigator.observe(scan_of({}));
  }
  return navigator;
}

TEST(Drifted, ALoneMatchDoesNotTurnAVehicleThatNoLongerKnowsWhereItLooks) {
  Navigator navigator = that_turned_around(0.4);
  const double before_rad2 = navigator.pose().covariance(2, 2);
  ASSERT_GT(before_rad2, 0.1);
  for (int again = 0; again < 3; ++again) {
    const core::StepReport report = navigator.observe(scan_of({glimpse(4.8, -0.5)}));  // not a mapped landmark
    EXPECT_NE(report.associations.front().outcome, core::Outcome::matched) << again;
    navigator.move(ahead(0.02));
  }
  EXPECT_GT(navigator.pose().covariance(2, 2), 0.9 * before_rad2);
}

TEST(Drifted, OneThatKnowsWhereItLooksMatchesAsBefore) {
  Navigator navigator = that_turned_around(0.01);
  const core::StepReport report =
      navigator.observe(scan_of({glimpse(4.8, 0.0), glimpse(std::hypot(4.8, 3.0), std::atan2(3.0, 4.8))}));
  for (const core::AssociationReport& one : report.associations) EXPECT_EQ(one.outcome, core::Outcome::matched);
}

struct Turned {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  association::LandmarkLife life;
  std::vector<core::LandmarkId> ids;

  /// Landmarks at 5 and 8 m, the second one tentative.
  explicit Turned(double sigma_rad) {
    for (const double range_m : {5.0, 8.0}) ids.push_back(filter.augment(glimpse(range_m, 0.0), {}));
    life.observe({0.0, 0.0}, {}, {ids[0]}, {});
    for (double x = 1.0; x <= 5.0; x += 1.0) life.observe({x, 0.0}, {ids[0]}, {}, {});
    life.observe({5.0, 0.0}, {}, {ids[1]}, {});
    filter.predict(turned(0.0, sigma_rad));
  }
};

TEST(Drifted, IsWhatTheWayThereHasMadeWide) {
  const core::Scan scan = scan_of({glimpse(5.0, 0.1), glimpse(8.0, 0.1)});
  Turned wide(0.3);
  const Gating far(wide.filter, wide.ids, scan, {});
  EXPECT_EQ(drifted_from(far.problem, scan), wide.ids);
  EXPECT_EQ(old_or_drifted(wide.filter, wide.life, scan, 60.0), std::vector{wide.ids[0]}) << "the other is tentative";
  EXPECT_TRUE(old_or_drifted(wide.filter, wide.life, scan_of({}), 60.0).empty()) << "no noise to compare with";

  Turned narrow(0.05);
  const Gating near(narrow.filter, narrow.ids, scan, {});
  EXPECT_TRUE(drifted_from(near.problem, scan).empty());
  EXPECT_TRUE(old_or_drifted(narrow.filter, narrow.life, scan, 60.0).empty());
  narrow.life.drive(100.0);
  EXPECT_EQ(old_or_drifted(narrow.filter, narrow.life, scan, 60.0), std::vector{narrow.ids[0]}) << "old as before";
}

TEST(Drifted, OnAReturnAsMuchMayStandInNoMapAsInIt) {
  Turned wide(0.3);
  const core::Scan scan = scan_of({glimpse(5.0, 0.1)});
  NavigatorOptions options;
  options.search.learn_extraneous = true;
  ASSERT_GT(wide.life.seen_per_scan(), 2.0 * wide.life.born_per_scan());
  GatedScan gated = gate_scan(wide.filter, {wide.ids[0]}, scan, options);
  look_for_returns(wide.filter, wide.life, scan, options, scan.field_of_view, gated);
  ASSERT_EQ(gated.returns.size(), 1u);
  const auto as_dense =
      returns_in_gate(wide.filter, gated.gating->problem, scan, {wide.ids[0]}, wide.life.seen_per_scan());
  EXPECT_DOUBLE_EQ(gated.returns.front().expected_confusers, as_dense.front().expected_confusers);
}

TEST(Drifted, ATentativeLandmarkBeginsNoSearchAndIsLeftUnused) {
  RevisitAmbiguity tentative;
  tentative.landmark = 3;
  tentative.expected_confusers = 5.0;
  tentative.is_mature = false;
  RevisitAmbiguity mature;
  mature.landmark = 7;
  mature.expected_confusers = 0.2;
  EXPECT_EQ(most_ambiguous({tentative}), nullptr);
  const std::vector<RevisitAmbiguity> both{tentative, mature};
  ASSERT_NE(most_ambiguous(both), nullptr);
  EXPECT_EQ(most_ambiguous(both)->landmark, 7);

  Turned wide(0.3);
  const core::Scan scan = scan_of({glimpse(8.0, 0.1)});
  NavigatorOptions options;
  GatedScan gated = gate_scan(wide.filter, wide.ids, scan, options);
  look_for_returns(wide.filter, wide.life, scan, options, scan.field_of_view, gated);
  EXPECT_EQ(gated.doubtful, std::vector{wide.ids[1]});
  Confirmation confirmation;
  for (const core::AssociationReport& report : associate_scan(gated, scan, options, 0.0, confirmation)) {
    EXPECT_NE(report.outcome, core::Outcome::matched);
  }
}

}  // namespace
}  // namespace helixnav::supervisor
