// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {

/// A grove by which two maps are joined and, after a bare stretch, an avenue. Drives go along x from the origin; by the end of the bare
/// stretch two maps of it are some metres off against each other, so that a tree of one may be several of the other's.
struct BentAvenue {
  double spacing_m = 9.0;       ///< from tree to tree on each side
  double jitter_m = 0.0;        ///< of the spacing: uniform to either side
  double claimed = 1.0;         ///< the covariance of a map over what its errors are drawn from, in standard deviations
  double bare_until_m = 160.0;  ///< from the grove's end at 60 m
  double avenue_until_m = 400.0;
  std::vector<Eigen::Vector2d> trees_m;

  BentAvenue(std::uint64_t seed, double jitter) : jitter_m(jitter) {
    core::RandomStream random(seed, "bent avenue");
    while (trees_m.size() < 60) {
      const double x_m = random.uniform(0.0, 60.0);
      const Eigen::Vector2d at_m(x_m, random.uniform(-20.0, 20.0));
      const bool is_apart = std::all_of(trees_m.begin(), trees_m.end(),
                                        [&](const Eigen::Vector2d& other_m) { return (at_m - other_m).norm() > 3.0; });
      if (is_apart) trees_m.push_back(at_m);
    }
    for (const double y_m : {-6.0, 6.0}) {
      for (double x_m = bare_until_m; x_m < avenue_until_m; x_m += spacing_m) {
        const double off_m = random.uniform(-jitter_m, jitter_m);
        trees_m.emplace_back(x_m + off_m, y_m + random.uniform(-jitter_m, jitter_m) / 3.0);
      }
    }
  }

  /// What a drive knows of the trees in the grove and of those between two values of x. Tree i is its landmark 2·i. Every metre adds
  /// errors along the drive and in heading.
  core::JointMap drive(double from_m, double to_m, std::uint64_t seed) const {
    constexpr double along_m = 0.2, turn_rad = 3e-4, sigma_m = 0.03;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < trees_m.size(); ++i) {
      const double x_m = trees_m[i].x();
      if (x_m <= 60.0 || (x_m >= from_m && x_m <= to_m)) seen.push_back(i);
    }
    const auto n = static_cast<Eigen::Index>(seen.size());
    const auto metres = static_cast<Eigen::Index>(avenue_until_m + spacing_m);
    Eigen::MatrixXd by_metre = Eigen::MatrixXd::Zero(2 * n, 2 * metres);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d& at_m = trees_m[seen[static_cast<std::size_t>(i)]];
      for (Eigen::Index k = 0; k < metres && static_cast<double>(k) < at_m.x(); ++k) {
        by_metre(2 * i, 2 * k) = along_m;
        by_metre(2 * i, 2 * k + 1) = -turn_rad * at_m.y();
        by_metre(2 * i + 1, 2 * k + 1) = turn_rad * (at_m.x() - static_cast<double>(k));
      }
    }
    core::RandomStream random(seed, "drive on a bent avenue");
    Eigen::VectorXd white(2 * metres);
    for (Eigen::Index k = 0; k < white.size(); ++k) white[k] = random.normal(0.0, 1.0);
    const Eigen::VectorXd error_m = by_metre * white;
    core::JointMap map;
    map.joint.covariance = sigma_m * sigma_m * Eigen::MatrixXd::Identity(3 + 2 * n, 3 + 2 * n);
    map.joint.covariance.bottomRightCorner(2 * n, 2 * n) += claimed * claimed * by_metre * by_metre.transpose();
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t tree = seen[static_cast<std::size_t>(i)];
      const double dx_m = random.normal(0.0, sigma_m);
      map.joint.ids.push_back(2 * static_cast<core::LandmarkId>(tree));
      map.joint.points_m.push_back(trees_m[tree] + error_m.segment<2>(2 * i) +
                                   Eigen::Vector2d(dx_m, random.normal(0.0, sigma_m)));
    }
    map.states.assign(seen.size(), core::LandmarkState::mature);
    map.observations.assign(seen.size(), 5);
    map.next_name = 1000;
    map.reach_m = 30.0;
    return map;
  }
};

}  // namespace helixnav::supervisor
