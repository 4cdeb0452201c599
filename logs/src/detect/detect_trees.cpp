// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/detect_trees.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "helixnav/core/angle.hpp"

namespace helixnav::logs {
namespace {

constexpr double field_of_view_rad = core::pi;

/// Angle of a beam from the right. Two of the published limits are whole numbers of beams, so that which side a gap
/// falls on depends on the rounding of exactly this expression; do not rearrange it.
double beam_angle_rad(double beam) { return beam * core::pi / 360.0; }

struct Return {
  int beam;
  double range_m;
  Eigen::Vector2d point_m;
};

/// Successive returns first … last (indices, inclusive) that belong together.
struct Cluster {
  std::size_t first;
  std::size_t last;
  bool rejected = false;
};

std::vector<Return> returns_within(const SickScan& scan, double max_range_m) {
  std::vector<Return> returns;
  for (int beam = 0; beam < SickScan::beams; ++beam) {
    const double range_m = scan.range_cm[static_cast<std::size_t>(beam)] / 100.0;
    if (range_m < max_range_m) {
      const double angle_rad = beam_angle_rad(beam);
      returns.push_back({beam, range_m, range_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad))});
    }
  }
  return returns;
}

std::vector<Cluster> cluster(const std::vector<Return>& returns, const TreeRules& rules) {
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const bool joins =
        i > 0 && std::abs(returns[i].range_m - returns[i - 1].range_m) <= rules.max_range_jump_m &&
        beam_angle_rad(returns[i].beam) - beam_angle_rad(returns[i - 1].beam) <= beam_angle_rad(rules.max_gap_beams);
    if (joins) {
      clusters.back().last = i;
    } else {
      clusters.push_back({i, i});
    }
  }
  return clusters;
}

/// A trunk stands alone: where the end of one cluster and the beginning of a later one are close, both are rejected.
void reject_crowded(const std::vector<Return>& returns, const TreeRules& rules, std::vector<Cluster>& clusters) {
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    for (std::size_t j = i + 1; j < clusters.size() && j <= i + static_cast<std::size_t>(rules.isolation_neighbours);
         ++j) {
      const Eigen::Vector2d apart_m = returns[clusters[j].first].point_m - returns[clusters[i].last].point_m;
      if (apart_m.squaredNorm() < rules.isolation_m * rules.isolation_m) {
        clusters[i].rejected = clusters[j].rejected = true;
      }
    }
  }
}

/// Of two clusters that touch in angle, the farther may continue behind the nearer: its width is unknown.
void reject_occluded(const std::vector<Return>& returns, const TreeRules& rules, std::vector<Cluster>& clusters) {
  for (std::size_t i = 0; i + 1 < clusters.size(); ++i) {
    const Return& right = returns[clusters[i].last];
    const Return& left = returns[clusters[i + 1].first];
    if (beam_angle_rad(left.beam) - beam_angle_rad(right.beam) < beam_angle_rad(rules.occlusion_gap_beams)) {
      clusters[left.range_m > right.range_m ? i + 1 : i].rejected = true;
    }
  }
}

double diameter_m(const Return& first, const Return& last) {
  return beam_angle_rad(last.beam - first.beam + 1) * (first.range_m + last.range_m) / 2.0;
}

bool looks_like_a_trunk(const Return& first, const Return& last, const TreeRules& rules) {
  const bool inside = first.range_m >= rules.min_range_m && last.range_m >= rules.min_range_m &&
                      beam_angle_rad(first.beam) > rules.edge_margin_rad &&
                      beam_angle_rad(last.beam) < field_of_view_rad - rules.edge_margin_rad;
  return inside && (last.point_m - first.point_m).norm() < rules.max_width_m &&
         std::abs(last.range_m - first.range_m) < rules.max_skew * diameter_m(first, last);
}

SickDetection describe(const std::vector<Return>& returns, const Cluster& cluster) {
  const Return& first = returns[cluster.first];
  const Return& last = returns[cluster.last];
  const std::size_t sum = cluster.first + cluster.last;
  const double middle_m = (returns[sum / 2].range_m + returns[(sum + 1) / 2].range_m) / 2.0;
  SickDetection tree;
  tree.diameter_m = diameter_m(first, last);
  tree.range_m = middle_m + tree.diameter_m / 2.0;
  tree.bearing_rad = beam_angle_rad((first.beam + last.beam) / 2.0) - core::pi / 2.0;
  tree.beams_hit = static_cast<int>(cluster.last - cluster.first) + 1;
  return tree;
}

}  // namespace

std::vector<SickDetection> detect_trees(const SickScan& scan, const TreeRules& rules) {
  const std::vector<Return> returns = returns_within(scan, rules.max_range_m);
  std::vector<Cluster> clusters = cluster(returns, rules);
  reject_crowded(returns, rules, clusters);
  reject_occluded(returns, rules, clusters);
  std::vector<SickDetection> trees;
  for (const Cluster& candidate : clusters) {
    if (!candidate.rejected && looks_like_a_trunk(returns[candidate.first], returns[candidate.last], rules)) {
      trees.push_back(describe(returns, candidate));
    }
  }
  return trees;
}

}  // namespace helixnav::logs
