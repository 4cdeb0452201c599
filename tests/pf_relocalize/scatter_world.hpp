// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"

namespace helixnav::pf_relocalize::test {

/// Landmarks scattered at a mean spacing over a square, a vehicle in the middle, and a map of them with errors: the world
/// of THEORY §3.5.
struct ScatterOptions {
  double spacing_m = 8.0;
  double side_m = 120.0;
  double unmapped = 0.0;        // share of the landmarks that the map lacks
  double map_sigma_m = 0.3;     // of x and of y
  double prior_sigma_m = 10.0;  // of x and of y
  double prior_sigma_rad = 10.0 * core::pi / 180.0;
  double detection_probability = 0.85;
  double clutter_per_scan = 2.0;
  double range_m = 30.0;
};

struct ScatterWorld {
  ScatterWorld(const ScatterOptions& chosen, std::uint64_t seed) : options(chosen), random(seed, "scatter world") {
    const double half = 0.5 * options.side_m;
    const int n = static_cast<int>((options.side_m / options.spacing_m) * (options.side_m / options.spacing_m));
    map.T_world_base = core::Pose2();
    map.latent.resize(0, 0);
    map.prior_by_latent.resize(3, 0);
    for (int i = 0; i < n; ++i) {
      landmarks.emplace_back(random.uniform(-half, half), random.uniform(-half, half));
      const Eigen::Vector2d error(random.normal(0.0, options.map_sigma_m), random.normal(0.0, options.map_sigma_m));
      if (random.bernoulli(options.unmapped)) continue;
      map.ids.push_back(i);
      map.landmarks.push_back(
          {landmarks.back() + error, std::pow(options.map_sigma_m, 2) * Eigen::Matrix2d::Identity()});
    }
    map.latent.resize(2 * static_cast<Eigen::Index>(map.landmarks.size()), 0);
    truth = core::Pose2(random.uniform(-15.0, 15.0), random.uniform(-15.0, 15.0), random.uniform(-3.0, 3.0));
    map.prior.covariance = Eigen::Vector3d(std::pow(options.prior_sigma_m, 2), std::pow(options.prior_sigma_m, 2),
                                           std::pow(options.prior_sigma_rad, 2))
                               .asDiagonal();
    map.prior.mean = core::Pose2(truth.vector() + random.normal3(map.prior.covariance));
  }

  core::Scan scan() {
    core::Scan scan;
    scan.t_ns = t_ns;
    scan.field_of_view = {0.0, options.range_m, -core::pi / 2, core::pi / 2};
    const double sigma_range = 0.1, sigma_bearing = core::pi / 180.0;
    for (const Eigen::Vector2d& m : landmarks) {
      const Eigen::Vector2d d = core::transform(core::inverse(truth), m);
      const double range = d.norm(), bearing = std::atan2(d.y(), d.x());
      if (range > options.range_m || std::abs(bearing) > core::pi / 2) continue;
      if (!random.bernoulli(options.detection_probability)) continue;
      const double seen = std::max(0.1, range + random.normal(0.0, sigma_range));
      scan.observations.push_back(
          core::make_range_bearing(seen, bearing + random.normal(0.0, sigma_bearing), sigma_range, sigma_bearing));
    }
    const int clutter = random.poisson(options.clutter_per_scan);
    for (int k = 0; k < clutter; ++k) {
      const double range = options.range_m * std::sqrt(random.uniform(1e-4, 1.0));
      scan.observations.push_back(
          core::make_range_bearing(range, random.uniform(-core::pi / 2, core::pi / 2), sigma_range, sigma_bearing));
    }
    return scan;
  }

  /// Drives a metre, with the noise that the odometry admits.
  core::Odometry drive() {
    core::Odometry odometry;
    t_ns += 100'000'000;
    odometry.t_ns = t_ns;
    const double sigma_rad = 0.5 * core::pi / 180.0;
    odometry.covariance = Eigen::Vector3d(0.0025, 0.0025, sigma_rad * sigma_rad).asDiagonal();
    odometry.T_before_after = core::Pose2(1.0, 0.0, random.normal(0.0, 0.05));
    const Eigen::Vector3d noise = random.normal3(odometry.covariance);
    truth = core::compose(truth, core::Pose2(odometry.T_before_after.vector() + noise));
    return odometry;
  }

  bool is_right(const core::Pose2& pose) const {
    const core::Pose2 error = core::between(truth, pose);
    return error.position_m().norm() < 2.0 && std::abs(error.heading_rad) < 8.0 * core::pi / 180.0;
  }

  ScatterOptions options;
  core::RandomStream random;
  std::vector<Eigen::Vector2d> landmarks;
  ReferenceMap map;
  core::Pose2 truth;
  core::Nanoseconds t_ns = 0;
};

}  // namespace helixnav::pf_relocalize::test
