// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "landmark_record.hpp"

namespace helixnav::fastslam {

/// All lineages of landmarks with the grid that finds those near a place, shared by all particles. A lineage is in the
/// cell of its anchor, with a reach that covers all that particles hold of it: estimates, and what their own
/// uncertainty may add to a search. 16 bytes per lineage. Reading from several threads is safe while nothing writes.
/// Test: fastslam/lineages_test.cpp (against brute force).
class Lineages {
 public:
  /// Beyond this, and for non-finite values, cells have no numbers and single precision no metres.
  static constexpr double farthest_m = 1e9;

  Lineages() : buckets_(64, none) {}

  /// A new lineage, anchored where it was born as closely as single precision allows.
  LineageId add(const Eigen::Vector2d& place_m);

  /// Ids given so far, dead ones included.
  std::size_t size() const { return lineages_.size(); }
  std::size_t living() const { return living_; }
  bool is_alive(LineageId id) const { return lineages_[id].reach_m >= 0.0F; }

  Eigen::Vector2d anchor_m(LineageId id) const { return {lineages_[id].x_m, lineages_[id].y_m}; }
  double reach_m(LineageId id) const { return lineages_[id].reach_m; }

  /// The reach that covers `distance_m` from the anchor: one of few values, so that lineages seldom grow.
  static float reach_for(double distance_m);

  /// Lets the lineage reach as far as `reach_m`, and never less far than before.
  void grow(LineageId id, float reach_m);

  /// Forgets the lineages for which alive[id] is false.
  void sweep(const std::vector<bool>& alive);

  /// f(id) for every lineage whose reach meets the rectangle [low, high] grown by `margin_m`, in no order.
  template <class Function>
  void visit(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double margin_m, Function&& f) const {
    const double grown_m = margin_m + longest_reach_m_;
    const auto meets = [&](const Lineage& l) {
      const double beside_x = std::max(std::max(low_m.x() - l.x_m, l.x_m - high_m.x()), 0.0);
      const double beside_y = std::max(std::max(low_m.y() - l.y_m, l.y_m - high_m.y()), 0.0);
      const double within_m = margin_m + static_cast<double>(l.reach_m);
      return beside_x * beside_x + beside_y * beside_y <= within_m * within_m;
    };
    const Eigen::Vector2d sides_m = (high_m - low_m).array() + 2.0 * grown_m;
    const bool is_small = sides_m.prod() < cell_m * cell_m * static_cast<double>(lineages_.size() + most_cells);
    if (!is_small || !(std::max(low_m.cwiseAbs().maxCoeff(), high_m.cwiseAbs().maxCoeff()) + grown_m < farthest_m)) {
      for (std::uint32_t id = 0; id < lineages_.size(); ++id) {  // fewer than the cells of the rectangle
        if (lineages_[id].reach_m >= 0.0F && meets(lineages_[id])) f(id);
      }
      return;
    }
    const std::int32_t c0 = cell(low_m.x() - grown_m), c1 = cell(high_m.x() + grown_m);
    const std::int32_t r0 = cell(low_m.y() - grown_m), r1 = cell(high_m.y() + grown_m);
    for (std::int32_t row = r0; row <= r1; ++row) {
      for (std::int32_t column = c0; column <= c1; ++column) {
        for (std::uint32_t id = buckets_[bucket(column, row)]; id != none; id = lineages_[id].next) {
          const Lineage& l = lineages_[id];
          if (cell(l.x_m) != column || cell(l.y_m) != row) continue;  // of another cell with the same bucket
          if (meets(l)) f(id);
        }
      }
    }
  }

  std::size_t bytes() const {
    return lineages_.capacity() * sizeof(Lineage) + buckets_.capacity() * sizeof(std::uint32_t);
  }

 private:
  struct Lineage {
    float x_m, y_m;
    float reach_m;       ///< negative: dead
    std::uint32_t next;  ///< in the same bucket
  };
  static constexpr std::uint32_t none = 0xffffffffU;
  static constexpr double cell_m = 8.0;
  static constexpr std::size_t most_cells = 1024;  ///< looked at, beside as many as there are lineages

  static std::int32_t cell(double x_m) {
    const bool has_number = x_m > -farthest_m && x_m < farthest_m;
    return has_number ? static_cast<std::int32_t>(std::floor(x_m * (1.0 / cell_m))) : 0;
  }
  std::size_t bucket(std::int32_t column, std::int32_t row) const {
    const std::uint64_t mixed = static_cast<std::uint32_t>(column) * 0x9e3779b97f4a7c15ULL ^
                                static_cast<std::uint32_t>(row) * 0xc2b2ae3d27d4eb4fULL;
    return (mixed ^ mixed >> 32) & (buckets_.size() - 1);
  }
  void rebuild(std::size_t buckets);
  void enter(LineageId id);

  std::vector<Lineage> lineages_;
  std::vector<std::uint32_t> buckets_;  ///< first of each, a power of two of them
  std::size_t living_ = 0;
  double longest_reach_m_ = 0.0;
};

}  // namespace helixnav::fastslam
