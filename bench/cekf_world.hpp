// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::bench {

/// A filter that has mapped a number of landmarks, a given number of them active and around the vehicle, and sees eight
/// of them from every place.
class CekfWorld {
 public:
  CekfWorld(cekf::Retraction retraction, int landmarks, int active) : filter(start(), options(retraction)) {
    const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
    while (filter.mapped_count() < landmarks) {
      move({random_.uniform(-40, 40), random_.uniform(-40, 40), random_.uniform(-1, 1)}, 1e-2, 1e-5);
      for (int i = 0; i < 40 && filter.mapped_count() < landmarks; ++i) {
        filter.augment(core::make_cartesian({random_.uniform(-30, 30), random_.uniform(-30, 30)}, R), {});
      }
      filter.switch_region(std::vector<core::LandmarkId>{});
    }
    std::vector<std::pair<double, core::LandmarkId>> near;
    for (const core::LandmarkId id : filter.landmarks()) {
      near.emplace_back((filter.landmark(id).mean_m - filter.pose().mean.position_m()).norm(), id);
    }
    std::sort(near.begin(), near.end());
    for (int i = 0; i < active; ++i) active_.push_back(near[static_cast<std::size_t>(i)].second);
    filter.switch_region(active_);
  }

  cekf::CompressedEkf filter;

  const std::vector<core::LandmarkId>& active() const { return active_; }

  core::Odometry odometry() const {
    core::Odometry result;
    result.T_before_after = core::Pose2(0.05, 0.0, 0.01);
    result.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    return result;
  }

  /// The matches seen after the increment.
  const std::vector<cekf::Match>& look() {
    const core::Pose2 pose = core::compose(filter.pose().mean, odometry().T_before_after);
    matches_.clear();
    for (std::size_t i = 0; i < 8; ++i) {
      const core::LandmarkId id = active_[(5 * scans_ + 3 * i) % active_.size()];
      const core::PredictedObservation p =
          core::predict_observation(core::ObservationKind::range_bearing, pose, {}, filter.landmark(id).mean_m);
      matches_.push_back({id,
                          core::make_range_bearing(std::max(0.1, p.z_hat[0] + random_.normal(0, 0.05)),
                                                   p.z_hat[1] + random_.normal(0, 0.005), 0.1, 0.01),
                          {}});
    }
    ++scans_;
    return matches_;
  }

 private:
  static core::PoseGaussian start() { return {}; }

  static cekf::FilterOptions options(cekf::Retraction retraction) {
    cekf::FilterOptions result;
    result.retraction = retraction;
    return result;
  }

  void move(const core::Pose2& increment, double variance_m2, double variance_rad2) {
    core::Odometry odometry;
    odometry.T_before_after = increment;
    odometry.covariance = Eigen::Vector3d(variance_m2, variance_m2, variance_rad2).asDiagonal();
    filter.predict(odometry);
  }

  core::RandomStream random_{1, "cekf world"};
  std::vector<core::LandmarkId> active_;
  std::vector<cekf::Match> matches_;
  std::size_t scans_ = 0;
};

}  // namespace helixnav::bench
