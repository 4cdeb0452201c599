// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/in_view.hpp"

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

FieldOfView view_deg(double from, double to) {
  FieldOfView view;
  view.min_bearing_rad = from * pi / 180.0;
  view.max_bearing_rad = to * pi / 180.0;
  return view;
}

TEST(InView, AcrossTheBackIsAsFromTheOtherSide) {
  for (const FieldOfView& view : {view_deg(90.0, 270.0), view_deg(-270.0, -90.0)}) {
    for (int degrees = -180; degrees <= 180; degrees += 10) {
      if (std::abs(degrees) == 90) continue;  // the edge itself
      EXPECT_EQ(is_between_bearings(view, degrees * pi / 180.0), std::abs(degrees) > 90) << degrees;
    }
  }
}

TEST(InView, DrawsBothSidesIn) {
  const FieldOfView view = view_deg(-30.0, 60.0);
  EXPECT_TRUE(is_between_bearings(view, 0.9, 0.1));
  EXPECT_FALSE(is_between_bearings(view, 1.0, 0.1));
  EXPECT_FALSE(is_between_bearings(view, -0.5, 0.1));
  EXPECT_FALSE(is_between_bearings(view, 0.26, 1.0)) << "nothing is left of it";
}

TEST(InView, AllAroundHasNoSides) {
  for (const FieldOfView& view : {FieldOfView(), view_deg(0.0, 360.0), view_deg(-400.0, 400.0)}) {
    for (const double bearing_rad : {-pi, -2.0, 0.0, 3.0, pi}) {
      EXPECT_TRUE(is_between_bearings(view, bearing_rad, 0.5)) << bearing_rad;
    }
  }
}

}  // namespace
}  // namespace helixnav::core
