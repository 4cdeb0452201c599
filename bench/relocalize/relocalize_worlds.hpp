// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "worlds.hpp"

namespace helixnav::relocalize::test {

/// Streets of 120 m blocks, one in five missing; `place` fills one street of 120 m, given as (along, across).
template <class Place>
Points streets(std::size_t count, core::RandomStream& random, Place&& place) {
  constexpr double block_m = 120.0;
  const int blocks = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(count) / 31.0)));
  Points points;
  for (int i = 0; i <= blocks; ++i)
    for (int j = 0; j < blocks; ++j)
      for (const bool eastward : {false, true}) {
        if (random.bernoulli(0.2)) continue;
        for (const Eigen::Vector2d& at : place(block_m)) {
          const Eigen::Vector2d along_street(j * block_m + at.x(), i * block_m + at.y());
          points.push_back(eastward ? along_street : Eigen::Vector2d(along_street.y(), along_street.x()));
        }
      }
  return points;
}

/// Posts and trees anywhere along streets, 5 to 12 m from their middle, at least 3 m apart.
inline Points town(std::size_t count, core::RandomStream& random) {
  return streets(count, random, [&](double block_m) {
    Points street;
    for (int k = 0; k < 26; ++k) {
      const double side = random.bernoulli(0.5) ? -1.0 : 1.0;
      const Eigen::Vector2d at(random.uniform(0.0, block_m), side * random.uniform(5.0, 12.0));
      const auto near = [&](const Eigen::Vector2d& other) { return (other - at).norm() < 3.15; };
      if (std::none_of(street.begin(), street.end(), near)) street.push_back(at);
    }
    return street;
  });
}

/// Trees every 9 m on both sides of streets, with jitter; one in twenty is gone.
inline Points avenues(std::size_t count, double jitter_m, core::RandomStream& random) {
  return streets(count, random, [&](double block_m) {
    Points street;
    const double phase_m = random.uniform(0.0, 9.0);
    for (const double side : {-6.0, 6.0})
      for (double along_m = phase_m; along_m < block_m; along_m += 9.0) {
        const Eigen::Vector2d at(along_m + random.normal(0.0, jitter_m), side + random.normal(0.0, jitter_m));
        if (!random.bernoulli(0.05)) street.push_back(at);
      }
    return street;
  });
}

struct WorldKind {
  std::string name;  ///< uniform, town, avenues, rectangular, hexagonal
  std::size_t landmarks = 10000;
  double jitter_m = 0.0;
  double gaps = 0.0;   ///< share of trees taken out of an orchard
  double scale = 1.0;  ///< of an orchard's pitch of 5 × 4 m (rectangular) or 5 m (hexagonal)
};

inline Points world_of(const WorldKind& kind, core::RandomStream& random) {
  if (kind.name == "uniform") return uniform_world(kind.landmarks, random);
  if (kind.name == "town") return town(kind.landmarks, random);
  if (kind.name == "avenues") return avenues(kind.landmarks, kind.jitter_m, random);
  if (kind.name != "rectangular" && kind.name != "hexagonal")
    throw std::runtime_error("no world is called " + kind.name);
  Points kept;
  for (const Eigen::Vector2d& tree :
       orchard(kind.landmarks, kind.name == "hexagonal", kind.jitter_m, random, kind.scale))
    if (!random.bernoulli(kind.gaps)) kept.push_back(tree);
  return kept;
}

}  // namespace helixnav::relocalize::test
