// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/LU>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::cekf {

/// Noise of the circuit of THEORY §1b, per step.
struct CircuitNoise {
  double speed_fraction = 0.05;
  double turn_rad = core::pi / 180.0;
  double range_m = 0.1;
  double bearing_rad = 2.0 * core::pi / 180.0;
};

inline CircuitNoise moderate_noise() { return {}; }
inline CircuitNoise large_noise() { return {0.05, 2.0 * core::pi / 180.0, 0.3, 5.0 * core::pi / 180.0}; }

/// Sums over one or many runs.
struct Consistency {
  double nees = 0.0;  ///< of the pose (3 degrees of freedom), summed over the last quarter of the steps
  int poses = 0;
  double nis = 0.0;  ///< of all joint updates
  int nis_dof = 0;

  double mean_nees() const { return nees / poses; }
  double mean_nis() const { return nis / nis_dof; }
  void add(const Consistency& other) {
    nees += other.nees;
    poses += other.poses;
    nis += other.nis;
    nis_dof += other.nis_dof;
  }
};

/// One run: four laps of a circle of 8 m among 20 landmarks seen up to 8 m away, known association, start known exactly.
inline Consistency drive_circuit(Retraction retraction, const CircuitNoise& noise, std::uint64_t seed) {
  constexpr double radius_m = 8.0;
  constexpr double step_m = 0.25;
  constexpr int steps = 800;
  core::RandomStream random(seed, "circuit");
  std::vector<Eigen::Vector2d> landmarks;
  for (int i = 0; i < 20; ++i) {
    const double angle = random.uniform(0.0, 2.0 * core::pi);
    const double r = radius_m + random.uniform(-4.0, 4.0);
    landmarks.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  std::vector<core::LandmarkId> ids(landmarks.size(), core::no_landmark);
  core::Pose2 truth(radius_m, 0.0, 0.5 * core::pi);
  core::PoseGaussian start;
  start.mean = truth;
  FilterOptions options;
  options.retraction = retraction;
  options.cell_side_m = 6.0;  // small on purpose: the study includes switches and lazy activations
  options.hysteresis_m = 1.0;
  CompressedEkf filter(start, options);
  Consistency result;
  for (int k = 0; k < steps; ++k) {
    const core::Pose2 moved(step_m, 0.0, step_m / radius_m);
    truth = core::compose(truth, moved);
    core::Odometry odometry;
    const double sigma_m = noise.speed_fraction * step_m;
    odometry.T_before_after = core::Pose2(moved.x_m + random.normal(0.0, sigma_m), 0.0,
                                          moved.heading_rad + random.normal(0.0, noise.turn_rad));
    odometry.covariance = Eigen::Vector3d(sigma_m * sigma_m, 0.0, noise.turn_rad * noise.turn_rad).asDiagonal();
    filter.predict(odometry);
    std::vector<Match> matches;
    std::vector<std::pair<std::size_t, core::Observation>> fresh;
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const Eigen::Vector2d p = core::transform(core::inverse(truth), landmarks[i]);
      if (p.norm() > 8.0) continue;
      const double range_m = std::max(0.05, p.norm() + random.normal(0.0, noise.range_m));
      const double bearing_rad = core::wrap_to_pi(std::atan2(p.y(), p.x()) + random.normal(0.0, noise.bearing_rad));
      const core::Observation z = core::make_range_bearing(range_m, bearing_rad, noise.range_m, noise.bearing_rad);
      if (ids[i] == core::no_landmark) {
        fresh.emplace_back(i, z);
      } else {
        matches.push_back({ids[i], z, {}});
      }
    }
    const UpdateResult update = filter.update(matches);
    result.nis += update.nis;
    result.nis_dof += update.dof;
    for (const auto& [i, z] : fresh) ids[i] = filter.augment(z, {});
    filter.switch_region_if_due();
    if (k < steps * 3 / 4) continue;
    const core::PoseGaussian pose = filter.pose();
    Eigen::Vector3d error = truth.vector() - pose.mean.vector();
    error[2] = core::wrap_to_pi(error[2]);
    result.nees += error.dot(pose.covariance.inverse() * error);
    ++result.poses;
  }
  return result;
}

}  // namespace helixnav::cekf
