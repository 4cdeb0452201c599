// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/relocalize/ask.hpp"
#include "helixnav/relocalize/map_index.hpp"

namespace helixnav::relocalize::test {

using Points = std::vector<Eigen::Vector2d>;

/// Randomly placed landmarks, one per 64 m² on average.
inline Points uniform_world(std::size_t count, core::RandomStream& random) {
  const double side_m = 8.0 * std::sqrt(static_cast<double>(count));
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(random.uniform(0.0, side_m), random.uniform(0.0, side_m));
  return points;
}

/// A square lattice (rows of pitch 5 × 4 m) or a hexagonal one of 5 m, with normal jitter.
inline Points orchard(std::size_t count, bool hexagonal, double jitter_m, core::RandomStream& random,
                      double scale = 1.0) {
  const int side = static_cast<int>(std::sqrt(static_cast<double>(count)));
  Points points;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double x_m = scale * 5.0 * (column + (hexagonal && row % 2 == 1 ? 0.5 : 0.0));
      const double y_m = scale * (hexagonal ? 5.0 * std::sqrt(0.75) : 4.0) * row;
      points.emplace_back(x_m + jitter_m * random.normal(), y_m + jitter_m * random.normal());
    }
  return points;
}

inline Landmark landmark(core::LandmarkId id, const Eigen::Vector2d& point_m, double sigma_m) {
  Landmark result;
  result.id = id;
  result.point.mean_m = point_m;
  result.point.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  return result;
}

/// Pseudo-random kinds 0 … kinds − 1; none for kinds = 0.
inline std::optional<int> kind_of(std::size_t index, int kinds) {
  if (kinds == 0) return std::nullopt;
  return static_cast<int>((index * 2654435761U >> 7U) % static_cast<std::size_t>(kinds));
}

/// Map and query share the noise of a pair evenly.
inline std::vector<Landmark> landmarks(const Points& points, double pair_noise_m, int kinds = 0) {
  std::vector<Landmark> list;
  for (const Eigen::Vector2d& point : points) {
    const std::size_t index = list.size();
    list.push_back(landmark(static_cast<core::LandmarkId>(index), point, std::sqrt(0.5) * pair_noise_m));
    list.back().kind = kind_of(index, kinds);
  }
  return list;
}

inline MapIndex index_of(const Points& points, const IndexOptions& options, int kinds = 0) {
  MapIndex index(options, landmarks(points, options.pair_noise_m, kinds));
  index.look_around_landmarks();
  return index;
}

/// A question whose truth is known: the n landmarks of `world` nearest to one of them, some replaced by spurious ones.
struct Asked {
  Question question;
  core::Pose2 T_map_branch;
  std::vector<int> truth;  ///< [landmark of the question] its index in the world, −1: spurious
  double radius_m = 0.0;
};

struct Asking {
  std::size_t landmarks = 20;
  double change = 0.0;   ///< share replaced; their old selves stay in the map
  double clutter = 0.0;  ///< spurious ones added, as a share of `landmarks`
  double noise_m = 0.1;  ///< of the difference of a pair; all of it is put on the question
  int kinds = 0;         ///< labels of the landmarks, wrong for one in twenty
};

inline Asked ask_somewhere(const Points& world, const Asking& asking, core::RandomStream& random) {
  Asked asked;
  // Drawn one after the other: the order in which arguments are evaluated is the compiler's.
  const double shake_y_m = random.uniform(-2.0, 2.0);
  const double shake_x_m = random.uniform(-2.0, 2.0);
  const Eigen::Vector2d shake(shake_x_m, shake_y_m);
  const Eigen::Vector2d centre_m = world[random.below(world.size())] + shake;
  std::vector<std::pair<double, int>> order;
  for (std::size_t i = 0; i < world.size(); ++i) order.emplace_back((world[i] - centre_m).norm(), static_cast<int>(i));
  const std::size_t n = asking.landmarks;
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n + 1), order.end());
  asked.radius_m = 0.5 * (order[n - 1].first + order[n].first);
  const double heading_rad = random.uniform(-core::pi, core::pi);
  const double off_y_m = random.uniform(-500.0, 500.0);
  const double off_x_m = random.uniform(-500.0, 500.0);
  asked.T_map_branch = core::Pose2(centre_m.x() + off_x_m, centre_m.y() + off_y_m, heading_rad);
  const core::Pose2 T_branch_map = core::inverse(asked.T_map_branch);
  const auto put = [&](const Eigen::Vector2d& point_m, int index) {
    const auto id = static_cast<core::LandmarkId>(asked.truth.size());
    asked.question.landmarks.push_back(
        landmark(id, core::transform(T_branch_map, point_m), std::sqrt(0.5) * asking.noise_m));
    asked.truth.push_back(index);
    if (asking.kinds == 0) return;
    const bool mislabelled = index < 0 || random.bernoulli(0.05);
    asked.question.landmarks.back().kind =
        mislabelled ? static_cast<int>(random.below(static_cast<std::uint64_t>(asking.kinds)))
                    : *kind_of(static_cast<std::size_t>(index), asking.kinds);
  };
  const auto add_spurious = [&] {
    const double r_m = asked.radius_m * std::sqrt(random.uniform());
    const double angle = random.uniform(-core::pi, core::pi);
    put(centre_m + r_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)), -1);
  };
  for (std::size_t k = 0; k < n; ++k) {
    if (random.bernoulli(asking.change)) {
      add_spurious();
      continue;
    }
    const double noise_y_m = random.normal(0.0, asking.noise_m);
    const double noise_x_m = random.normal(0.0, asking.noise_m);
    put(world[static_cast<std::size_t>(order[k].second)] + Eigen::Vector2d(noise_x_m, noise_y_m), order[k].second);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(asking.clutter * static_cast<double>(n)); ++k) add_spurious();
  asked.question.looked.push_back({core::transform(T_branch_map, centre_m), asked.radius_m});
  return asked;
}

/// More than 1 m from the truth at the centre of what was asked, or rotated by more than 0.1 rad.
inline bool wrong(const Asked& asked, const core::Pose2& T_map_branch) {
  const Eigen::Vector2d centre_m = asked.question.looked.front().centre_m;
  const double turned_rad = core::wrap_to_pi(T_map_branch.heading_rad - asked.T_map_branch.heading_rad);
  const Eigen::Vector2d off_m = core::transform(T_map_branch, centre_m) - core::transform(asked.T_map_branch, centre_m);
  return off_m.norm() > 1.0 || std::abs(turned_rad) > 0.1;
}

}  // namespace helixnav::relocalize::test
