// SPDX-License-Identifier: BSD-3-Clause
#include "slip/keep_weighed.hpp"

#include <algorithm>

#include "slip/slip_places.hpp"

namespace helixnav::supervisor {

void keep_weighed(const cekf::CompressedEkf& filter, const core::Scan& scan, const std::vector<SeenPoint>& seen,
                  const SlipComponent& widest, SlipReach reach, std::vector<core::LandmarkId>& near) {
  if (seen.size() < most_weighed) return;
  std::vector<Eigen::Vector2d> means_m;
  for (const core::LandmarkId id : near) means_m.push_back(filter.landmark_mean(id));
  const Eigen::Vector2d sensor_m = core::transform(filter.pose().mean, scan.T_robot_sensor.position_m());
  const double farthest_m = (seen.back().point_m - scan.T_robot_sensor.position_m()).norm();
  const double range_m = farthest_m + 2.0 * slip_reach_m(widest, seen.back(), spacing_in(reach, means_m));
  near.erase(
      std::remove_if(near.begin(), near.end(),
                     [&](core::LandmarkId id) { return (filter.landmark_mean(id) - sensor_m).norm() > range_m; }),
      near.end());
}

}  // namespace helixnav::supervisor
