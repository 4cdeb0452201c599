// SPDX-License-Identifier: BSD-3-Clause
#include "tile_sum.hpp"

namespace helixnav::pf_relocalize {
namespace {

std::vector<Eigen::Vector2d> points_of(const ReferenceMap& map) {
  std::vector<Eigen::Vector2d> points;
  for (const core::PointGaussian& landmark : map.landmarks) points.push_back(landmark.mean_m);
  return points;
}

}  // namespace

LandmarkTable::LandmarkTable(const ReferenceMap& map)
    : modes(static_cast<std::size_t>(map.latent.cols())), grid(points_of(map)) {
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const core::PointGaussian& landmark = map.landmarks[i];
    x.push_back(landmark.mean_m.x());
    y.push_back(landmark.mean_m.y());
    sxx.push_back(landmark.covariance_m2(0, 0));
    sxy.push_back(landmark.covariance_m2(0, 1));
    syy.push_back(landmark.covariance_m2(1, 1));
    variance.push_back(largest_variance(landmark.covariance_m2));
    largest = std::max(largest, variance.back());
    if (modes == 0) continue;  // an empty matrix has no rows to take
    const auto V = map.latent.middleRows<2>(2 * static_cast<Eigen::Index>(i));
    for (Eigen::Index k = 0; k < V.cols(); ++k) latent.insert(latent.end(), {V(0, k), V(1, k)});
    latent_reach_m = std::max(latent_reach_m, 4.0 * V.norm());
  }
}

ParticleTile::ParticleTile(const LandmarkTable& landmarks, const Particles& particles, std::size_t begin,
                           std::size_t end)
    : table(landmarks), source(particles), first(begin) {
  poses.n = end - begin;
  poses.x = particles.x_m.data() + begin;
  poses.y = particles.y_m.data() + begin;
  for (std::size_t p = 0; p < poses.n; ++p) {
    poses.cos_heading[p] = std::cos(particles.heading_rad[begin + p]);
    poses.sin_heading[p] = std::sin(particles.heading_rad[begin + p]);
  }
}

TileLandmark ParticleTile::landmark(std::uint32_t i) {
  TileLandmark landmark{table.x[i], table.y[i], table.sxx[i], table.sxy[i], table.syy[i]};
  if (table.modes == 0) return landmark;
  shift_x.fill(0.0);
  shift_y.fill(0.0);
  const double* V = table.latent.data() + 2 * table.modes * i;
  for (std::size_t k = 0; k < table.modes; ++k) {
    const double* xi = source.latent[k].data() + first;
    for (std::size_t p = 0; p < poses.n; ++p) {
      shift_x[p] += V[2 * k] * xi[p];
      shift_y[p] += V[2 * k + 1] * xi[p];
    }
  }
  landmark.shift_x = shift_x.data();
  landmark.shift_y = shift_y.data();
  return landmark;
}

}  // namespace helixnav::pf_relocalize
