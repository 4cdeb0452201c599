// SPDX-License-Identifier: BSD-3-Clause
#include "closing/tied_by_view.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

using Ids = std::vector<core::LandmarkId>;

/// A scan one metre further on that saw these landmarks; the first sighting of a landmark begins it.
void drive_and_see(Tape& tape, const Ids& ids) {
  tape.append(Tape::Motion{core::no_motion(0), 1.0});
  Tape::Scan scan;
  for (const core::LandmarkId id : ids) {
    core::AssociationReport report;
    report.observation = static_cast<int>(scan.fate.size());
    report.outcome = core::Outcome::matched;
    report.landmark = id;
    scan.fate.push_back(report);
    scan.scan.observations.push_back(core::make_cartesian({1.0, 0.0}, Eigen::Matrix2d::Identity()));
  }
  tape.append(scan);
}

/// Ten scans of landmarks 1 to 3, some that see `between`, ten of landmarks 4 to 6, ending at 100 m.
double tied_m(const std::vector<Ids>& between, double gap_m = 5.0) {
  Tape tape(1000);
  for (int k = 0; k < 10; ++k) drive_and_see(tape, {1, 2, 3});
  for (const Ids& ids : between) drive_and_see(tape, ids);
  for (int k = 0; k < 10; ++k) drive_and_see(tape, {4, 5, 6});
  return tied_since_m(tape, 100.0, gap_m);
}

TEST(TiedByView, EndsWhereNothingIsInView) {
  EXPECT_DOUBLE_EQ(tied_m({{}, {}, {}}), 91.0);
  EXPECT_DOUBLE_EQ(tied_m({{3}, {3}, {3, 4}}), 91.0) << "one alone turns about itself";
}

TEST(TiedByView, ReachesAcrossWhereTwoAreSeenFromBothSides) {
  EXPECT_DOUBLE_EQ(tied_m({{2, 3}, {2, 3, 4, 5}}), 79.0);
  EXPECT_DOUBLE_EQ(tied_m({{2, 3, 4, 5}, {}, {}}), 78.0) << "a scan that sees nothing is no gap";
  EXPECT_DOUBLE_EQ(tied_m({{2, 3, 4, 5}, {}, {}, {}, {}, {}, {}}), 91.0) << "six are";
}

TEST(TiedByView, IsOfNothingWhereNoTwoWereSeenTogether) {
  Tape tape(1000);
  drive_and_see(tape, {1});
  drive_and_see(tape, {1});
  EXPECT_DOUBLE_EQ(tied_since_m(tape, 100.0, 5.0), 100.0);
  EXPECT_DOUBLE_EQ(tied_since_m(Tape(1000), 100.0, 5.0), 100.0);
}

TEST(TiedByView, KeepsWhatWasSeenSince) {
  association::LandmarkLife life;
  life.observe({0.0, 0.0}, {}, {1, 2}, {});
  life.drive(10.0);
  life.observe({10.0, 0.0}, {2}, {3}, {});
  EXPECT_EQ(seen_since(0.0, life, {1, 2, 3, 99}), (Ids{2, 3}));
}

}  // namespace
}  // namespace helixnav::supervisor
