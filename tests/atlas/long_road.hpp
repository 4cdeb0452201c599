// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <set>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::atlas::testing {

/// A circular road of 16 km, a landmark every 8 m on both sides, driven with noise. Without fixes it comes back with an
/// error of a hundred metres.
class LongRoad {
 public:
  explicit LongRoad(std::uint64_t seed) : random_(seed) {}

  long steps() const { return k_; }
  /// 2·(observations − landmarks): degrees of freedom of the measurements beyond the unknowns they determine.
  int dof() const { return 2 * (observations_ - static_cast<int>(landmarks_.size())); }

  /// Returns the clone at its end.
  int add_phase(Atlas& atlas) {
    auto log = std::make_shared<PhaseLog>();
    for (int i = 0; i < 9; ++i) log->steps.push_back(step());
    return atlas.add(derive_factor(*log, dead_reckon(*log)), log) + 1;
  }
  /// A fix of 1 m at the vehicle's present position, in a map frame in which the world is at `T_map_world`.
  void fix(Atlas& atlas, int clone, const core::Pose2& T_map_world = {}) {
    core::AbsoluteFix fix;
    fix.covariance_m2.setIdentity();
    fix.position_world_m = core::transform(T_map_world, pose(k_).position_m()) +
                           Eigen::Vector2d(random_.normal(0.0, 1.0), random_.normal(0.0, 1.0));
    atlas.fix(clone, fix);
  }
  Eigen::Vector2d position_m() const { return pose(k_).position_m(); }
  double error_m(const Atlas& atlas) const { return (atlas.pose().position_m() - pose(k_).position_m()).norm(); }

  static constexpr long steps_a_lap = 8000;

 private:
  static constexpr long count = 4000;
  static constexpr double radius_m = 4.0 * count / (2.0 * core::pi);

  static core::Pose2 pose(long k) {
    const double angle_rad = 2.0 * static_cast<double>(k) / radius_m;
    return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), core::wrap_to_pi(angle_rad)};
  }
  static Eigen::Vector2d landmark(long i) {
    const double angle_rad = (4.0 * static_cast<double>(i - i % 2) + 2.0) / radius_m;
    const double r_m = radius_m + (i % 2 == 0 ? -6.0 : 6.0);
    return {r_m * std::sin(angle_rad), radius_m - r_m * std::cos(angle_rad)};
  }

  LoggedStep step() {
    ++k_;
    LoggedStep step;
    step.covariance = Eigen::Vector3d(0.02, 0.01, 5e-4).cwiseAbs2().asDiagonal();
    step.T_before_after =
        core::Pose2(Eigen::Vector3d(core::between(pose(k_ - 1), pose(k_)).vector() + random_.normal3(step.covariance)));
    for (long i = k_ / 2 - 8; i <= k_ / 2 + 8; ++i) {
      const long name = (i + count) % count;
      const Eigen::Vector2d seen_m = core::transform(core::inverse(pose(k_)), landmark(name));
      if (seen_m.norm() > 25.0) continue;
      const Eigen::Vector2d noise_m(random_.normal(0.0, 0.1), random_.normal(0.0, 0.1));
      step.seen.push_back({static_cast<core::LandmarkId>(name), core::Pose2(),
                           core::make_cartesian(seen_m + noise_m, 0.01 * Eigen::Matrix2d::Identity())});
      landmarks_.insert(name);
      ++observations_;
    }
    return step;
  }

  core::RandomStream random_;
  long k_ = 0;
  int observations_ = 0;
  std::set<long> landmarks_;
};

}  // namespace helixnav::atlas::testing
