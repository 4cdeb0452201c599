// SPDX-License-Identifier: BSD-3-Clause
#include "association/expected_landmarks.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

using Ids = std::vector<core::LandmarkId>;

constexpr OldGround ground{60.0, 30.0, 2.0};

/// A vehicle at the origin among old landmarks 0 to 3, ahead of it and precisely mapped, unseen for 100 m.
class AmongOldLandmarks : public testing::Test {
 protected:
  AmongOldLandmarks() {
    for (int i = 0; i < 4; ++i) {
      filter.augment(core::make_range_bearing(10.0, 0.5 * i, 0.1, 0.01), core::Pose2());
    }
    begin({0, 1, 2, 3});
    life.drive(100.0);
  }

  void begin(const Ids& born) {
    life.observe(at_m(), {}, born, {});
    for (int look = 0; look < 5; ++look) see(born);
  }

  /// These are seen one metre further on.
  void see(const Ids& ids) {
    life.drive(1.0);
    life.observe(at_m(), ids, {}, {});
  }

  Eigen::Vector2d at_m() const { return {life.path_m(), 0.0}; }

  /// Whether landmark 3 counts as missed if these were seen and it was not.
  bool is_missed(const Ids& seen) const {
    Ids expected{3};
    drop_what_may_be_elsewhere(filter, life, nullptr, ground, seen, expected);
    return !expected.empty();
  }

  cekf::CompressedEkf filter{core::PoseGaussian{}};
  association::LandmarkLife life;
};

TEST_F(AmongOldLandmarks, OneIsMissedWhereTwoAreSeen) {
  EXPECT_FALSE(is_missed({}));
  EXPECT_FALSE(is_missed({0}));
  EXPECT_TRUE(is_missed({0, 1}));
}

// If landmarks are far apart, a scan sees only one of them at a time; a felled one among them is missed all the same.
TEST_F(AmongOldLandmarks, OneIsMissedWhereAnotherIsSeenAndASecondWasLately) {
  see({0});
  life.drive(20.0);
  EXPECT_FALSE(is_missed({}));
  EXPECT_TRUE(is_missed({1}));
  life.drive(20.0);
  EXPECT_FALSE(is_missed({1})) << "40 m ago is not lately";
}

// After a slip the vehicle sees landmarks that it maps anew, and all the old ones are elsewhere.
TEST_F(AmongOldLandmarks, NoneIsMissedAmongLandmarksBegunSinceTheOldOnesWereSeen) {
  begin({10});
  see({0, 1, 10});
  EXPECT_TRUE(is_missed({10})) << "it was there when two old ones were seen";
  life.drive(1.0);
  begin({11});
  EXPECT_FALSE(is_missed({11}));
  see({0, 11});
  EXPECT_FALSE(is_missed({11})) << "only one old one was seen since it is there";
  see({1, 11});
  EXPECT_TRUE(is_missed({11}));
}

TEST_F(AmongOldLandmarks, NoneIsMissedWhoseDirectionIsNotKnown) {
  see({0});
  core::Odometry turn;
  turn.covariance(2, 2) = 0.1 * 0.1;  // σ 1 m at 10 m
  filter.predict(turn);
  EXPECT_FALSE(is_missed({1}));
}

}  // namespace
}  // namespace helixnav::supervisor
