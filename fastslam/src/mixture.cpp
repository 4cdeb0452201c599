// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "impl.hpp"

namespace helixnav::fastslam {
namespace {

/// Sums over the particles that hold a landmark, places from its anchor.
struct Sums {
  double share = 0.0, mature_share = 0.0;
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_m2 = Eigen::Matrix2d::Zero();  ///< about the anchor
};

}  // namespace

std::vector<core::MixedLandmark> FastSlam::Impl::mixture() const {
  std::map<LineageId, Sums> sums_of;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const double weight = std::exp(log_weight[i]);
    maps[i].for_each([&](LineageId id, const LandmarkRecord& landmark) {
      Sums& sums = sums_of[id];
      const Eigen::Vector2d offset_m(landmark.dx_m, landmark.dy_m);
      sums.share += weight;
      sums.mature_share += landmark.mature != 0 ? weight : 0.0;
      sums.place_m += weight * offset_m;
      sums.second_m2 += weight * (landmark.covariance_m2().matrix() + offset_m * offset_m.transpose());
    });
  }
  std::vector<core::MixedLandmark> mixture;
  for (const auto& [id, sums] : sums_of) {
    if (!(sums.share > 0.0)) continue;
    const Eigen::Vector2d mean_m = sums.place_m / sums.share;
    core::MixedLandmark& landmark = mixture.emplace_back();
    landmark.id = static_cast<core::LandmarkId>(id);
    landmark.point.mean_m = lineages.anchor_m(id) + mean_m;
    landmark.point.covariance_m2 = sums.second_m2 / sums.share - mean_m * mean_m.transpose();
    landmark.share = sums.share;
    landmark.mature_share = sums.mature_share;
  }
  return mixture;
}

}  // namespace helixnav::fastslam
