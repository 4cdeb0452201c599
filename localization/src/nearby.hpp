// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::localization {

/// Where the landmarks of a scan may be: discs around the points that its observations see, with a radius of `sigmas`
/// standard deviations of pose and noise together (their trace, so that nothing inside an exact gate is lost). A scan
/// with an observation that fixes no point (one row) has one disc, its field of view, or the whole map if that is
/// unknown (a greatest range of zero).
class Nearby {
 public:
  Nearby(const core::PoseGaussian& pose, const core::Scan& scan, double sigmas);

  bool holds(const Eigen::Vector2d& point_m) const;

 private:
  struct Disc {
    Eigen::Vector2d centre_m;
    double radius_m;
  };
  std::vector<Disc> discs_;
};

}  // namespace helixnav::localization
