// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"

namespace helixnav::pf_relocalize::test {

/// Two rows of trees along x at y = ±4 from x = 0 to `length`, every `pitch` metres, driven twice along y = 0. The
/// second drive enters at `entered` and is at `now`; what it mapped is exact.
struct Lattice {
  double pitch_m = 5.0;
  double length_m = 150.0;
  double entered_m = 40.0;
  double now_m = 90.0;
  double old_from_m = -10.0, old_to_m = 160.0;  ///< of the first drive
  double range_m = 30.0;

  std::vector<Eigen::Vector2d> trees() const {
    std::vector<Eigen::Vector2d> all;
    for (double x = 0.0; x <= length_m + 1e-9; x += pitch_m) {
      all.emplace_back(x, 4.0);
      all.emplace_back(x, -4.0);
    }
    return all;
  }

  core::Pose2 truth() const { return {now_m, 0.0, 0.0}; }

  Coverage coverage(double from_m, double to_m, double origin_m) const {
    Coverage coverage;
    for (double x = from_m; x <= to_m; x += 2.0) coverage.T_frame_sensor.emplace_back(x - origin_m, 0.0, 0.0);
    coverage.field_of_view = {0.0, range_m, -core::pi / 2, core::pi / 2};
    return coverage;
  }

  Constellation constellation() const {
    Constellation c;
    const std::vector<Eigen::Vector2d> all = trees();
    c.old_drive = coverage(old_from_m, old_to_m, 0.0);
    c.new_drive = coverage(entered_m, now_m, now_m);
    c.new_drive.least_views = 2;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto id = static_cast<core::LandmarkId>(i);
      c.old_landmarks.push_back({id, {all[i], 0.01 * Eigen::Matrix2d::Identity()}});
      const Eigen::Vector2d seen = core::transform(core::inverse(truth()), all[i]);
      if (c.new_drive.covers(seen)) c.branch.push_back({1000 + id, seen, 5});
    }
    return c;
  }

  ReferenceMap map(double sigma_along_m, double sigma_across_m, double sigma_rad) const {
    ReferenceMap map;
    for (const OldLandmark& old : constellation().old_landmarks) {
      map.ids.push_back(old.id);
      map.landmarks.push_back(old.point);
    }
    map.prior.mean = truth();
    map.prior.covariance =
        Eigen::Vector3d(sigma_along_m * sigma_along_m, sigma_across_m * sigma_across_m, sigma_rad * sigma_rad)
            .asDiagonal();
    map.latent.resize(2 * static_cast<Eigen::Index>(map.landmarks.size()), 0);
    map.prior_by_latent.resize(3, 0);
    return map;
  }
};

}  // namespace helixnav::pf_relocalize::test
