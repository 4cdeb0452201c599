// SPDX-License-Identifier: BSD-3-Clause
#include "repeated_looks.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::fastslam {
namespace {

/// Innovations of three landmarks whose noise keeps a share `rho` of that of the previous scan.
double own_share_where_noise_remembers(double rho) {
  core::RandomStream random(7, "repeated looks");
  RepeatedLooks repeated;
  std::vector<Eigen::Vector2d> noise(3, Eigen::Vector2d::Zero());
  constexpr int scans = 4000;
  for (int scan = 0; scan < scans; ++scan) {
    std::vector<std::pair<LineageId, Eigen::Vector2d>> innovations;
    for (std::size_t k = 0; k < noise.size(); ++k) {
      const double x = random.normal(0.0, 1.0);
      const double y = random.normal(0.0, 1.0);
      noise[k] = rho * noise[k] + std::sqrt(1.0 - rho * rho) * Eigen::Vector2d(x, y);
      innovations.emplace_back(static_cast<LineageId>(10 * k), noise[k]);
    }
    repeated.count(innovations);
  }
  return repeated.own_share();
}

TEST(RepeatedLooks, WhiteNoiseSaysSomethingNewInEveryScan) { EXPECT_GT(own_share_where_noise_remembers(0.0), 0.95); }

TEST(RepeatedLooks, NoiseThatStaysIsCountedOnce) { EXPECT_NEAR(own_share_where_noise_remembers(0.6), 0.4 / 1.6, 0.02); }

TEST(RepeatedLooks, BelievesEveryScanBeforeThereIsEvidence) {
  RepeatedLooks repeated;
  EXPECT_EQ(repeated.own_share(), 1.0);
  std::vector<std::pair<LineageId, Eigen::Vector2d>> first{{1, {1.0, 1.0}}}, other{{2, {1.0, 1.0}}};
  repeated.count(first);
  repeated.count(other);  // of another landmark: no pair
  EXPECT_EQ(repeated.own_share(), 1.0);
}

}  // namespace
}  // namespace helixnav::fastslam
