// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/modes.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::pf_relocalize {
namespace {

bool within(const Particles& particles, std::size_t i, const core::Pose2& centre, const ModeRadius& radius) {
  const double dx = particles.x_m[i] - centre.x_m, dy = particles.y_m[i] - centre.y_m;
  if (dx * dx + dy * dy > radius.position_m * radius.position_m) return false;
  return std::abs(core::wrap_to_pi(particles.heading_rad[i] - centre.heading_rad)) <= radius.heading_rad;
}

/// Weighted sums of differences to a reference pose, near which headings do not wrap.
struct Moments {
  core::Pose2 reference;
  double mass = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(const Particles& particles, std::size_t i) {
    const double w = std::exp(particles.log_weight[i]);
    const Eigen::Vector3d d(particles.x_m[i] - reference.x_m, particles.y_m[i] - reference.y_m,
                            core::wrap_to_pi(particles.heading_rad[i] - reference.heading_rad));
    mass += w;
    first += w * d;
    second += w * d * d.transpose();
  }

  core::PoseGaussian gaussian() const {
    const Eigen::Vector3d mean = first / mass;
    return {core::Pose2(reference.vector() + mean), second / mass - mean * mean.transpose()};
  }
};

/// Moments of the free particles about `centre`; they become taken when `take`.
Moments gather(const Particles& particles, const core::Pose2& centre, const ModeRadius& radius, bool take,
               std::vector<std::uint8_t>& taken) {
  Moments moments{centre};
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (taken[i] != 0 || !within(particles, i, centre, radius)) continue;
    moments.add(particles, i);
    if (take) taken[i] = 1;
  }
  return moments;
}

}  // namespace

void find_modes(const Particles& particles, const ModeRadius& radius, std::size_t most, double rest,
                std::vector<std::uint8_t>& taken, std::vector<Mode>& modes) {
  modes.clear();
  taken.assign(particles.size(), 0);
  double left = 1.0;
  while (modes.size() < most && left > rest) {
    std::size_t best = particles.size();
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (taken[i] == 0 && (best == particles.size() || particles.log_weight[i] > particles.log_weight[best])) best = i;
    }
    if (best == particles.size()) break;
    const core::PoseGaussian first = gather(particles, particles.pose(best), radius, false, taken).gaussian();
    const Moments moments = gather(particles, first.mean, radius, true, taken);
    taken[best] = 1;  // even when the centre moved away from it
    if (moments.mass <= 0.0) continue;
    modes.push_back({moments.mass, moments.gaussian(), static_cast<std::uint32_t>(best)});
    left -= moments.mass;
  }
  std::sort(modes.begin(), modes.end(),
            [](const Mode& a, const Mode& b) { return a.mass != b.mass ? a.mass > b.mass : a.best < b.best; });
}

core::PoseGaussian cloud_moments(const Particles& particles) {
  double c = 0.0, s = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double w = std::exp(particles.log_weight[i]);
    c += w * std::cos(particles.heading_rad[i]);
    s += w * std::sin(particles.heading_rad[i]);
  }
  Moments moments{{particles.x_m[0], particles.y_m[0], std::atan2(s, c)}};
  for (std::size_t i = 0; i < particles.size(); ++i) moments.add(particles, i);
  return moments.gaussian();
}

}  // namespace helixnav::pf_relocalize
