// SPDX-License-Identifier: BSD-3-Clause
#include "closing/duplicate_segment.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double pitch_m = 4.5;

/// An orchard of four rows seen from an aisle, and seen again from poses that are `shift_m` off along it, by a vehicle
/// that knows this to `sigma_m`; the second drive sees the columns from `first_again` to `last_again` only.
struct Orchard {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> old;
  Branch branch;
  std::vector<core::LandmarkId> original;  ///< of branch.confirmed, no_landmark for a new tree

  Orchard(int columns, int first_again, int last_again, double shift_m, double sigma_m, double jitter_m = 0.05)
      : jitter_m_(jitter_m) {
    core::RandomStream jitter(1, "duplicate_segment_test");
    const Eigen::Matrix2d R = 2.5e-3 * Eigen::Matrix2d::Identity();
    std::vector<Eigen::Vector2d> trees;
    for (int column = 0; column < columns; ++column) {
      for (const double y_m : {-4.0 - pitch_m, -4.0, 4.0, 4.0 + pitch_m}) {
        trees.emplace_back(column * pitch_m + jitter.normal(0.0, jitter_m), y_m + jitter.normal(0.0, jitter_m));
        old.push_back(see(trees.back(), R, jitter));
      }
    }
    core::Odometry odometry;
    odometry.covariance.diagonal() << sigma_m * sigma_m, 0.04, 1e-6;
    filter.predict(odometry);
    for (int column = first_again; column <= last_again; ++column) {
      for (int row = 0; row < 4; ++row) {
        const auto tree = static_cast<std::size_t>(4 * column + row);
        const Eigen::Vector2d at_m =
            tree < trees.size() ? trees[tree] : Eigen::Vector2d(column * pitch_m, trees[tree % 4].y());
        branch.confirmed.push_back(see(at_m + Eigen::Vector2d(shift_m, 0.0), R, jitter));
        original.push_back(tree < trees.size() ? old[tree] : core::no_landmark);
      }
    }
    look_around({-10.0, columns * pitch_m + 10.0}, branch.old_drive);
    look_around({first_again * pitch_m + shift_m, last_again * pitch_m + shift_m}, branch.new_drive);
  }

  KeptRemoved placed() const { return DuplicateSegment(filter, branch).place(filter, old, {}); }

  KeptRemoved surely_placed() const {
    std::vector<core::LandmarkId> tried;
    return DuplicateSegment(filter, branch).place_next(filter, old, {}, tried).value_or(KeptRemoved{});
  }

  int wrong(const KeptRemoved& pairs) const {
    int wrong = 0;
    for (const auto& [kept, removed] : pairs) {
      const auto k = std::find(branch.confirmed.begin(), branch.confirmed.end(), removed) - branch.confirmed.begin();
      wrong += original[static_cast<std::size_t>(k)] != kept ? 1 : 0;
    }
    return wrong;
  }

 private:
  double jitter_m_;  ///< of the trees, and of where they are seen

  core::LandmarkId see(const Eigen::Vector2d& at_m, const Eigen::Matrix2d& R, core::RandomStream& noise) {
    return filter.augment(
        core::make_cartesian(at_m + Eigen::Vector2d(noise.normal(0.0, jitter_m_), noise.normal(0.0, jitter_m_)), R),
        {});
  }

  static void look_around(const std::pair<double, double>& x_m, pf_relocalize::Coverage& ground) {
    for (double x = x_m.first; x <= x_m.second; x += 3.0) ground.T_frame_sensor.emplace_back(x, 0.0, 0.0);
    ground.field_of_view.max_range_m = 15.0;
    ground.field_of_view.min_bearing_rad = -core::pi;
    ground.field_of_view.max_bearing_rad = core::pi;
  }
};

TEST(DuplicateSegment, IsPlacedAsAWholeWhereNoTreeCanBeToldAlone) {
  const Orchard orchard(9, 0, 8, 1.9, 1.5);
  EXPECT_TRUE(leftovers(orchard.filter, orchard.branch.confirmed, orchard.old, SearchOptions{}).empty());
  const KeptRemoved pairs = orchard.placed();
  EXPECT_EQ(pairs.size(), 36u);
  EXPECT_EQ(orchard.wrong(pairs), 0);
}

TEST(DuplicateSegment, IsPlacedByItsShapeWhereItIsLikelierAPitchOffAndMatchesMoreThere) {
  const Orchard orchard(12, 4, 15, 2.8, 1.5);
  const KeptRemoved pairs = orchard.placed();
  EXPECT_EQ(pairs.size(), 32u);
  EXPECT_EQ(orchard.wrong(pairs), 0);
}

TEST(DuplicateSegment, IsPlacedByTheEndOfALatticeThatHasNoShapeWhereItIsLikelierAPitchOff) {
  const Orchard orchard(12, 4, 11, 2.8, 1.5, 0.0);
  const KeptRemoved pairs = orchard.placed();
  EXPECT_EQ(pairs.size(), 32u);
  EXPECT_EQ(orchard.wrong(pairs), 0);
}

/// Between two bent maps the covariance decides nothing: here it favours one pitch, and the ground has the pattern on every pitch.
TEST(DuplicateSegment, StaysBetweenBentMapsWhereTheGroundRepeats) {
  const Orchard orchard(30, 10, 14, 0.5, 0.6, 0.0);
  EXPECT_EQ(orchard.placed().size(), 20u);
  EXPECT_TRUE(orchard.surely_placed().empty());
}

TEST(DuplicateSegment, ComesUpInTurnUntilAllWereTried) {
  const Orchard orchard(30, 2, 27, 0.5, 0.6, 0.0);
  const DuplicateSegment segment(orchard.filter, orchard.branch);
  std::vector<core::LandmarkId> tried;
  while (segment.place_next(orchard.filter, orchard.old, {}, tried)) ASSERT_LT(tried.size(), 20u);
  EXPECT_GE(tried.size(), 4u);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GT((segment.before_m(tried[i]) - segment.before_m(tried[k])).norm(), 20.0);
    }
  }
}

TEST(DuplicateSegment, StaysWhereNothingTellsOnePitchFromAnother) {
  EXPECT_TRUE(Orchard(30, 10, 12, 2.0, 3.0).placed().empty());
}

/// Its cost is bounded: one step took more than ten minutes after a jump had left a stretch that uncertain.
TEST(DuplicateSegment, StaysWhereItMayBeNearlyAnywhere) { EXPECT_TRUE(Orchard(80, 0, 8, 2.0, 100.0).placed().empty()); }

TEST(DuplicateSegment, IsNothingWithoutCopies) {
  Orchard orchard(6, 0, 5, 0.0, 0.5);
  orchard.old.clear();
  EXPECT_TRUE(orchard.placed().empty());
}

}  // namespace
}  // namespace helixnav::supervisor
