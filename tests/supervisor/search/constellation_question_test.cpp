// SPDX-License-Identifier: BSD-3-Clause
#include "search/constellation_question.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {
namespace {

/// A row of landmarks mapped twice by a vehicle that came back without knowing it.
struct Twice {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  association::LandmarkLife life;
  CoverageTrace track{4.0};
  core::Scan scan;
  std::vector<core::LandmarkId> old;

  Twice() {
    scan.field_of_view = {0.5, 30.0, -core::pi, core::pi};
    old = map_row(0.0);
    life.observe({0.0, 0.0}, {}, old, {});
    core::Odometry motion;
    motion.covariance.diagonal() << 0.25, 0.25, 1e-3;
    filter.predict(motion);
    life.drive(100.0);
    const std::vector<core::LandmarkId> branch = map_row(0.2);
    life.observe({0.0, 0.0}, {}, branch, {});
    for (int look = 1; look <= 3; ++look) life.observe({1.0 * look, 0.0}, branch, {}, {});
  }

  std::vector<core::LandmarkId> map_row(double apart_m) {
    std::vector<core::LandmarkId> ids;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d at_m(4.0 * i - 12.0, i % 2 == 0 ? 5.0 : -6.0 - 0.3 * i);
      const Eigen::Vector2d off_m(apart_m * std::sin(3.0 * i), apart_m * std::cos(5.0 * i));
      ids.push_back(filter.augment(core::make_cartesian(at_m + off_m, 0.01 * Eigen::Matrix2d::Identity()), {}));
    }
    return ids;
  }

  ConstellationAnswer ask(const pf_relocalize::ReferenceMapOptions& reference) const {
    SearchOptions options;
    options.reference = reference;
    return ask_constellation({filter, life, track, scan}, old, 90.0, filter.pose().mean, options, 1);
  }
};

double farthest_m(const ConstellationAnswer& answer) {
  double farthest_m = 0.0;
  for (const auto& pair : answer.verdict.winner.pairs) farthest_m = std::max(farthest_m, pair.distance_m);
  return farthest_m;
}

TEST(ConstellationQuestion, HearsOfTheErrorsThatOldLandmarksShareAsTheParticleFilterDoes) {
  const Twice twice;
  pf_relocalize::ReferenceMapOptions scalar;
  scalar.decorrelation = pf_relocalize::Decorrelation::scalar_bound;
  const ConstellationAnswer marginals = twice.ask({});
  const ConstellationAnswer bounded = twice.ask(scalar);
  EXPECT_EQ(marginals.verdict.winner.matched, 8);
  EXPECT_EQ(bounded.verdict.winner.matched, 8);
  EXPECT_NE(farthest_m(marginals), farthest_m(bounded)) << "the pose is refined on other covariances";
}

}  // namespace
}  // namespace helixnav::supervisor
