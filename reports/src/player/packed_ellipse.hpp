// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "json.hpp"

namespace helixnav::reports {

/// Ellipses of one σ for the player: the longer semi-axis to 3 % (in 24ths of a doubling from 1 mm), by how many 24ths the other is
/// shorter, angle of the longer one in 64ths of half a turn.
class PackedEllipses {
 public:
  void add(const Eigen::Matrix2d& covariance_m2);
  /// {"a": …, "b_less": …, "angle": …}
  Json json() const;

 private:
  std::vector<std::int64_t> major_, less_, angle_;
};

}  // namespace helixnav::reports
