// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "landmark_record.hpp"

namespace helixnav::fastslam {

/// How much of what a scan says the previous scan has already said: innovations of one landmark in two consecutive scans, as
/// the heaviest hypothesis has them, are white if the noise is, and correlated if it persists for a while (the bark of one
/// side of a tree, a landmark that is two). If the correlation is ρ and decays geometrically, (1 + ρ)/(1 − ρ) scans say what
/// one would. Test: fastslam/repeated_looks_test.cpp.
class RepeatedLooks {
 public:
  /// Share of a scan's evidence that is its own, in (0, 1].
  double own_share() const {
    const double rho = std::clamp(product_ / power_, 0.0, most_);
    return (1.0 - rho) / (1.0 + rho);
  }

  /// One more scan of a robot: innovations by landmark, each row divided by its standard deviation.
  void count(std::vector<std::pair<LineageId, Eigen::Vector2d>>& innovations) {
    for (const auto& [id, now] : innovations) {
      const auto before =
          std::find_if(last_.begin(), last_.end(), [id = id](const auto& one) { return one.first == id; });
      if (before == last_.end()) continue;
      product_ += now.dot(before->second);
      power_ += 0.5 * (now.squaredNorm() + before->second.squaredNorm());
    }
    std::swap(last_, innovations);
  }

 private:
  static constexpr double most_ = 0.95;
  double product_ = 0.0;
  double power_ = 100.0;  ///< as fifty white pairs: nothing is taken for correlated before there is evidence
  std::vector<std::pair<LineageId, Eigen::Vector2d>> last_;
};

}  // namespace helixnav::fastslam
