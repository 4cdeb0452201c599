// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "association/gated_scan.hpp"

namespace helixnav::supervisor {
namespace {

enum class Unseen { for_long, for_a_reach };

/// What becomes of a sighting of the only old landmark in view, 15 m ahead, at so many standard deviations to the side of
/// where it is expected, `before` as many just before, and with `another` object seen at so many. On this return, eighteen
/// objects in no map are seen in a scan.
core::Outcome outcome_at(double sigmas, double before, Unseen unseen = Unseen::for_long,
                         std::optional<double> another = std::nullopt) {
  constexpr double sigma_m = 0.4, range_m = 15.0, sigma_range_m = 0.1, sigma_bearing_rad = 0.006;
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  const core::LandmarkId id =
      filter.augment(core::make_range_bearing(range_m, 0.0, sigma_range_m, sigma_bearing_rad), {});
  core::Odometry drift;
  drift.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, 1e-8;
  filter.predict(drift);
  core::Scan scan;
  scan.field_of_view = {1.0, 30.0, -core::pi / 2, core::pi / 2};
  const double sigma_rad = std::hypot(sigma_m / range_m, std::sqrt(2.0) * sigma_bearing_rad);
  const auto sighting = [&](double off) {
    return core::make_range_bearing(range_m, off * sigma_rad, sigma_range_m, sigma_bearing_rad);
  };
  scan.observations.push_back(sighting(sigmas));
  if (another) scan.observations.push_back(sighting(*another));

  const NavigatorOptions options;
  GatedScan gated = gate_scan(filter, {id}, scan, options);
  (unseen == Unseen::for_long ? gated.returns : gated.away) =
      returns_in_gate(filter, gated.gating->problem, scan, {id}, 18.0);
  Confirmation confirmation;
  confirmation.confirms(isolated_hit(id, 0.0, sighting(before), filter.pose(), scan.T_robot_sensor),
                        options.search.confirmation_m);
  return associate_scan(gated, scan, options, 1.0, confirmation).front().outcome;
}

/// P_D N(ν; 0, S) is 19 λ at 1.55 standard deviations and λ at 2.88; the gate ends at 3.03.
TEST(IsolatedMatch, IsDeferredUnlessItIsSurelyNoObjectInNoMap) {
  EXPECT_EQ(outcome_at(0.0, 0.0), core::Outcome::matched);
  EXPECT_EQ(outcome_at(1.5, 1.5), core::Outcome::matched);
  EXPECT_EQ(outcome_at(2.2, 2.2), core::Outcome::ambiguous) << "likelier than an object in no map, but not by 19 to 1";
  EXPECT_EQ(outcome_at(2.9, 2.9), core::Outcome::ambiguous) << "less likely than an object in no map";
}

/// Of two observations of which one is the landmark, at ν₁ and ν₂ standard deviations, the odds are exp((ν₂² − ν₁²)/2): with ν₁ = 0,
/// 19 to 1 takes ν₂ = 2.43.
TEST(IsolatedMatch, IsDeferredBesideAnotherThatMayBeTheLandmarkAsWell) {
  EXPECT_EQ(outcome_at(0.0, 0.0, Unseen::for_long, 2.0), core::Outcome::ambiguous);
  EXPECT_EQ(outcome_at(0.0, 0.0, Unseen::for_long, 2.9), core::Outcome::matched);
}

TEST(IsolatedMatch, IsDeferredWhereTheHitBeforeWasSomewhereElseInTheGate) {
  EXPECT_EQ(outcome_at(0.5, 0.8), core::Outcome::matched);
  EXPECT_EQ(outcome_at(0.5, -1.5), core::Outcome::ambiguous);
}

/// One that is not old yet needs no second hit, but is as wrong at the rim of a gate.
TEST(IsolatedMatch, OfALandmarkThatHasBeenAwayIsDeferredAtTheRimOnly) {
  EXPECT_EQ(outcome_at(1.5, -1.5, Unseen::for_a_reach), core::Outcome::matched);
  EXPECT_EQ(outcome_at(2.9, 2.9, Unseen::for_a_reach), core::Outcome::ambiguous);
}

}  // namespace
}  // namespace helixnav::supervisor
