// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"
#include "slip/relative_geometry.hpp"
#include "slip/slip_evidence.hpp"

namespace helixnav::supervisor {

constexpr double degree = core::pi / 180.0;
constexpr double extraneous_per_m2 = 1.0 / 1400.0;  // about one a scan
const double a_pair_nats = pair_nats(0.9, extraneous_per_m2);

/// Landmarks known to 5 cm, and what a vehicle displaced by `truth` sees of them, noise of 10 cm.
struct SlipScene {
  SlipScene(std::vector<Eigen::Vector2d> points_m, const Eigen::Vector3d& truth, std::uint64_t seed)
      : geometry(joint_of(points_m)) {
    core::RandomStream random(seed, "slip decision test");
    const core::Pose2 T_displaced_predicted = core::inverse(core::Pose2(truth));
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      Eigen::Vector2d seen_m = core::transform(T_displaced_predicted, points_m[i]);
      seen_m += Eigen::Vector2d(random.normal(0.0, 0.1), random.normal(0.0, 0.1));
      seen.push_back({static_cast<int>(i), seen_m, 0.01 * Eigen::Matrix2d::Identity()});
    }
  }

  static core::JointGaussian joint_of(const std::vector<Eigen::Vector2d>& points_m) {
    core::JointGaussian joint;
    joint.points_m = points_m;
    for (std::size_t i = 0; i < points_m.size(); ++i) joint.ids.push_back(static_cast<core::LandmarkId>(100 + i));
    const auto size = 3 + 2 * static_cast<Eigen::Index>(points_m.size());
    joint.covariance = 0.0025 * Eigen::MatrixXd::Identity(size, size);
    joint.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    return joint;
  }

  RelativeGeometry geometry;
  std::vector<SeenPoint> seen;
};

inline std::vector<Eigen::Vector2d> scattered(std::uint64_t seed, int count = 8) {
  core::RandomStream random(seed, "slip landmarks");
  std::vector<Eigen::Vector2d> points_m;
  while (static_cast<int>(points_m.size()) < count) {
    const Eigen::Vector2d point_m(random.uniform(2.0, 28.0), random.uniform(-18.0, 18.0));
    const bool crowded = std::any_of(points_m.begin(), points_m.end(),
                                     [&](const Eigen::Vector2d& other) { return (other - point_m).norm() < 6.0; });
    if (!crowded) points_m.push_back(point_m);
  }
  return points_m;
}

inline std::vector<PointPair> all_pairs(std::size_t count) {
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < count; ++i) pairs.push_back({i, i});
  return pairs;
}

}  // namespace helixnav::supervisor
